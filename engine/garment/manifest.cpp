#include "garment/manifest.h"

#include "garment/fabric_keys.h"
#include "garment/manifest_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

namespace toile::garment {
namespace {

constexpr std::array<std::string_view, 13> kPartNames = {"invalid",
                                                         "head",
                                                         "torso",
                                                         "left_upper_arm",
                                                         "left_lower_arm",
                                                         "right_upper_arm",
                                                         "right_lower_arm",
                                                         "left_upper_leg",
                                                         "left_lower_leg",
                                                         "right_upper_leg",
                                                         "right_lower_leg",
                                                         "pelvis",
                                                         "neck"};

constexpr Quantity kEase = {"ease", "m", 0.0, 0.05, 1.0, "the unit is m, so 4 mm is written 0.004"};

double read_quantity(JsonObject& object, const Quantity& q) {
    const double value = object.number(q.key, -1e300, 1e300);
    if (value >= q.minimum && value <= q.maximum) return value * q.si_per_unit;
    std::ostringstream what;
    what << "is " << value << ", must lie between " << q.minimum << " and " << q.maximum;
    if (*q.unit != '\0') what << ' ' << q.unit;
    if (*q.hint != '\0') what << " (" << q.hint << ')';
    throw PackageError({FaultCode::value, object.error(q.key, what.str()).what()});
}

[[noreturn]] void refuse(FaultCode code, const JsonObject& object, const std::string& key,
                         const std::string& what) {
    throw PackageError({code, object.error(key, what).what()});
}

std::string read_identifier(JsonObject& object, const std::string& key) {
    std::string text = object.text(key);
    if (!is_identifier(text))
        refuse(FaultCode::value, object, key,
               "must be 1 to 64 of a-z, 0-9, - and _, starting with a letter");
    return text;
}

std::string read_words(JsonObject& object, const std::string& key) {
    std::string text = object.text(key);
    const bool control = std::any_of(text.begin(), text.end(),
                                     [](char c) { return static_cast<unsigned char>(c) < 32; });
    if (text.empty() || text.size() > 200 || control)
        refuse(FaultCode::value, object, key, "must be one line of 1 to 200 bytes");
    return text;
}

std::string read_path(JsonObject& object, const std::string& key) {
    std::string path = object.text(key);
    if (const std::string reason = unsafe_path_reason(path); !reason.empty())
        refuse(FaultCode::unsafe_path, object, key, "the path '" + path + "' " + reason);
    return path;
}

float linear_from_srgb(int byte) {
    const double c = byte / 255.0;
    return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

Vec3f read_color(JsonObject& object, const std::string& key) {
    const std::string text = object.text(key);
    std::uint32_t value = 0;
    const char* end = text.data() + text.size();
    const bool shaped = text.size() == 7 && text[0] == '#';
    if (!shaped || std::from_chars(text.data() + 1, end, value, 16).ptr != end)
        refuse(FaultCode::value, object, key, "must be a colour like \"#1f3a5f\"");
    return {linear_from_srgb(static_cast<int>(value >> 16)),
            linear_from_srgb(static_cast<int>((value >> 8) & 255)),
            linear_from_srgb(static_cast<int>(value & 255))};
}

ChartRange read_chart_range(JsonObject& range) {
    const auto metres = [&range](const std::string& key) {
        return read_quantity(
            range, {key.c_str(), "m", 0.03, 3.0, 1.0, "the unit is m, so 88 cm is written 0.88"});
    };
    ChartRange out;
    if (range.has("body")) {
        out.minimum = out.maximum = metres("body");
    } else {
        out.minimum = metres("min");
        out.maximum = metres("max");
        if (out.minimum > out.maximum) refuse(FaultCode::value, range, "min", "is larger than max");
    }
    range.finish();
    return out;
}

SizeEntry read_size(JsonObject& object, Faults& faults) {
    SizeEntry size;
    attempt(faults, FaultCode::json, [&] { size.name = read_words(object, "name"); });
    attempt(faults, FaultCode::json, [&] { size.mesh = read_path(object, "mesh"); });
    if (object.has("render"))
        attempt(faults, FaultCode::json, [&] { size.render = read_path(object, "render"); });
    if (object.has("made_on"))
        attempt(faults, FaultCode::json,
                [&] { size.made_on = read_identifier(object, "made_on"); });
    attempt(faults, FaultCode::json, [&] {
        JsonObject chart = object.object("chart");
        for (const std::string& key : chart.keys())
            attempt(faults, FaultCode::json, [&] {
                if (!is_identifier(key))
                    refuse(FaultCode::value, chart, key,
                           "must be an ISO 8559-1 name in snake_case");
                JsonObject range = chart.object(key);
                size.chart[key] = read_chart_range(range);
            });
    });
    attempt(faults, FaultCode::json, [&] { object.finish(); });
    return size;
}

void read_pin_vertices(JsonObject& object, PinGroup& group) {
    const nlohmann::json& list = object.any("vertices");
    if (!list.is_array() || list.empty())
        refuse(FaultCode::pins, object, "vertices", "must be an array of vertex indices");
    for (const auto& element : list) {
        if (!element.is_number_unsigned() || element.get<std::uint64_t>() > 0xffffffffu)
            refuse(FaultCode::pins, object, "vertices",
                   "must hold vertex indices only, not " + element.dump());
        group.vertices.push_back(element.get<std::uint32_t>());
    }
}

void read_pin_mask(JsonObject& object, PinGroup& group) {
    const nlohmann::json& list = object.any("mask");
    if (!list.is_array() || list.empty())
        refuse(FaultCode::pins, object, "mask", "must be an array of one number per vertex");
    for (const auto& element : list) {
        const double value = element.is_number() ? element.get<double>() : -1.0;
        if (!(value >= 0.0 && value <= 1.0))
            refuse(FaultCode::pins, object, "mask",
                   "must hold numbers from 0 to 1 only, not " + element.dump());
        group.mask.push_back(static_cast<float>(value));
    }
}

PinGroup read_pins(JsonObject& object, Faults& faults) {
    PinGroup group;
    attempt(faults, FaultCode::json, [&] { group.name = read_words(object, "name"); });
    attempt(faults, FaultCode::pins, [&] {
        if (object.has("mask") == object.has("vertices"))
            refuse(FaultCode::pins, object, "", "needs either 'vertices' or 'mask'");
        if (object.has("mask")) return read_pin_mask(object, group);
        read_pin_vertices(object, group);
        group.strength = static_cast<float>(object.number_or("strength", 0.0, 1.0, 1.0));
    });
    attempt(faults, FaultCode::json, [&] { object.finish(); });
    return group;
}

Variant read_variant(JsonObject& object, Faults& faults) {
    Variant variant;
    attempt(faults, FaultCode::json, [&] {
        variant.name = read_words(object, "name");
        if (object.has("material_variant"))
            variant.material_variant = read_words(object, "material_variant");
        if (object.has("base_color")) variant.base_color = read_color(object, "base_color");
        if (variant.material_variant.empty() && !variant.base_color)
            refuse(FaultCode::variant, object, "",
                   "needs 'material_variant', 'base_color' or both");
    });
    attempt(faults, FaultCode::json, [&] { object.finish(); });
    return variant;
}

Fabric read_fabric(JsonObject& object, Faults& faults) {
    Fabric fabric;
    if (object.has("name"))
        attempt(faults, FaultCode::json, [&] { fabric.name = read_words(object, "name"); });
    for (const auto& [quantity, field] : kFabricKeys)
        attempt(faults, FaultCode::json, [&] { fabric.*field = read_quantity(object, quantity); });
    attempt(faults, FaultCode::json, [&] { object.finish(); });
    return fabric;
}

body::Part read_part(const JsonObject& object, const std::string& name) {
    const auto* const found = std::find(kPartNames.begin() + 1, kPartNames.end(), name);
    if (found == kPartNames.end())
        refuse(FaultCode::value, object, "body_mask",
               "'" + name + "' is not a body part; known: head, torso, left_upper_arm, ...");
    return static_cast<body::Part>(found - kPartNames.begin());
}

template <typename Item>
void refuse_equal_names(const std::vector<Item>& items, const JsonObject& root,
                        const std::string& key, Faults& faults) {
    std::set<std::string> seen;
    for (const Item& item : items)
        if (!item.name.empty() && !seen.insert(item.name).second)
            faults.push_back({FaultCode::duplicate,
                              root.error(key, "the name '" + item.name + "' stands twice").what()});
}

void read_lists(JsonObject& root, Manifest& m, Faults& faults) {
    attempt(faults, FaultCode::json, [&] {
        auto sizes = root.objects("sizes");
        if (sizes.empty()) refuse(FaultCode::value, root, "sizes", "needs at least one size");
        for (JsonObject& size : sizes)
            m.sizes.push_back(read_size(size, faults));
    });
    if (root.has("pins"))
        attempt(faults, FaultCode::json, [&] {
            for (JsonObject& group : root.objects("pins"))
                m.pins.push_back(read_pins(group, faults));
        });
    if (root.has("variants"))
        attempt(faults, FaultCode::json, [&] {
            for (JsonObject& variant : root.objects("variants"))
                m.variants.push_back(read_variant(variant, faults));
        });
    if (root.has("body_mask"))
        attempt(faults, FaultCode::json, [&] {
            for (const std::string& name : root.texts("body_mask"))
                m.body_mask.push_back(read_part(root, name));
        });
    refuse_equal_names(m.sizes, root, "sizes", faults);
    refuse_equal_names(m.pins, root, "pins", faults);
    refuse_equal_names(m.variants, root, "variants", faults);
}

EaseClass read_ease_class(const std::string& name, const JsonObject& object,
                          const std::string& key) {
    const auto known = ease_class_from_name(name);
    if (!known)
        refuse(FaultCode::value, object, key,
               "'" + name +
                   "' is no ease class; there are stretch, fitted, semi_fitted, loose, very_loose");
    return *known;
}

void read_identity(JsonObject& root, Manifest& m, Faults& faults) {
    const auto with = [&](auto&& read) { attempt(faults, FaultCode::json, read); };
    with([&] { m.id = read_identifier(root, "id"); });
    with([&] {
        m.version = root.text("version");
        if (!is_version(m.version))
            refuse(FaultCode::value, root, "version", "must look like 1.0.0");
    });
    with([&] { m.name = read_words(root, "name"); });
    with([&] { m.maker = read_words(root, "maker"); });
    with([&] { m.licence = read_words(root, "licence"); });
    with([&] { m.kind = read_identifier(root, "kind"); });
    with([&] { m.layer = static_cast<std::uint32_t>(root.integer("layer", 0, 15)); });
    if (root.has("made_on")) with([&] { m.made_on = read_identifier(root, "made_on"); });
    if (root.has("thumbnail")) with([&] { m.thumbnail = read_path(root, "thumbnail"); });
    if (root.has("ease")) with([&] { m.ease_m = read_quantity(root, kEase); });
    if (root.has("ease_class")) with([&] { m.ease_class = read_ease_intent(root); });
}

} // namespace

EaseIntent read_ease_intent(JsonObject& root) {
    EaseIntent out;
    if (root.any("ease_class").is_string()) {
        out.all = read_ease_class(root.text("ease_class"), root, "ease_class");
        return out;
    }
    JsonObject regions = root.object("ease_class");
    if (regions.keys().empty())
        refuse(FaultCode::value, root, "ease_class", "names no region; leave it out instead");
    for (const std::string& key : regions.keys()) {
        const auto region = fit_region_from_name(key);
        if (!region)
            refuse(FaultCode::value, regions, key,
                   "is no region; there are chest, waist, hip, upper_arm, forearm, thigh, knee, "
                   "calf");
        out.regions[*region] = read_ease_class(regions.text(key), regions, key);
    }
    regions.finish();
    return out;
}

std::string_view part_name(body::Part part) {
    return kPartNames.at(static_cast<std::size_t>(part));
}

Manifest read_manifest(std::string_view text, const std::string& file, Faults& faults) {
    Manifest m;
    attempt(faults, FaultCode::json, [&] {
        const nlohmann::json json = parse_json(text, file);
        JsonObject root(json, file);
        const std::int64_t schema = root.integer("schema", 1, 1'000'000);
        if (schema > kSchema)
            refuse(FaultCode::schema, root, "schema",
                   "is " + std::to_string(schema) + ", but this Toile reads schemas up to " +
                       std::to_string(kSchema) + "; update Toile");
        read_identity(root, m, faults);
        attempt(faults, FaultCode::json, [&] {
            JsonObject fabric = root.object("fabric");
            m.fabric = read_fabric(fabric, faults);
        });
        read_lists(root, m, faults);
        root.finish();
    });
    return m;
}

} // namespace toile::garment
