#include "garment/fabric_keys.h"
#include "garment/manifest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace toile::garment {
namespace {

using Json = nlohmann::ordered_json;

int srgb_from_linear(float linear) {
    const double l = std::clamp(static_cast<double>(linear), 0.0, 1.0);
    const double c = l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1.0 / 2.4) - 0.055;
    return static_cast<int>(std::lround(255.0 * c));
}

// Rounds away what the unit conversion adds in the last digits.
double rounded(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.9g", value);
    return std::strtod(text.data(), nullptr);
}

Json size_json(const SizeEntry& size) {
    Json entry = {{"name", size.name}, {"mesh", size.mesh}};
    if (!size.render.empty()) entry["render"] = size.render;
    if (!size.made_on.empty()) entry["made_on"] = size.made_on;
    entry["chart"] = Json::object();
    for (const auto& [name, range] : size.chart) {
        if (range.minimum == range.maximum)
            entry["chart"][name] = {{"body", rounded(range.minimum)}};
        else
            entry["chart"][name] = {{"min", rounded(range.minimum)},
                                    {"max", rounded(range.maximum)}};
    }
    return entry;
}

Json pins_json(const PinGroup& group) {
    Json entry = {{"name", group.name}};
    if (group.mask.empty()) {
        entry["strength"] = rounded(group.strength);
        entry["vertices"] = group.vertices;
    } else {
        for (const float value : group.mask)
            entry["mask"].push_back(rounded(value));
    }
    return entry;
}

Json variant_json(const Variant& variant) {
    Json entry = {{"name", variant.name}};
    if (!variant.material_variant.empty()) entry["material_variant"] = variant.material_variant;
    if (variant.base_color) {
        std::array<char, 8> text{};
        const Vec3f& c = *variant.base_color;
        std::snprintf(text.data(), text.size(), "#%02x%02x%02x",
                      static_cast<unsigned>(srgb_from_linear(c.x()) & 255),
                      static_cast<unsigned>(srgb_from_linear(c.y()) & 255),
                      static_cast<unsigned>(srgb_from_linear(c.z()) & 255));
        entry["base_color"] = text.data();
    }
    return entry;
}

} // namespace

std::string write_manifest(const Manifest& m) {
    Json j = {{"schema", kSchema}, {"id", m.id},       {"version", m.version},
              {"name", m.name},    {"maker", m.maker}, {"licence", m.licence},
              {"kind", m.kind},    {"layer", m.layer}};
    if (!m.made_on.empty()) j["made_on"] = m.made_on;
    if (!m.thumbnail.empty()) j["thumbnail"] = m.thumbnail;
    j["ease"] = rounded(m.ease_m);
    if (m.ease_class.all != EaseClass::invalid) j["ease_class"] = name_of(m.ease_class.all);
    for (const auto& [region, ease_class] : m.ease_class.regions)
        j["ease_class"][std::string(name_of(region))] = name_of(ease_class);
    j["fabric"]["name"] = m.fabric.name;
    for (const auto& [quantity, field] : kFabricKeys)
        j["fabric"][quantity.key] = rounded(m.fabric.*field / quantity.si_per_unit);
    j["sizes"] = Json::array();
    for (const SizeEntry& size : m.sizes)
        j["sizes"].push_back(size_json(size));
    for (const PinGroup& group : m.pins)
        j["pins"].push_back(pins_json(group));
    for (const Variant& variant : m.variants)
        j["variants"].push_back(variant_json(variant));
    for (const body::Part part : m.body_mask)
        j["body_mask"].push_back(part_name(part));
    return j.dump(2) + "\n";
}

} // namespace toile::garment
