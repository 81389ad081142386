#include "garment/recipe.h"

#include "core/json.h"
#include "garment/manifest_reader.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace toile::garment::block {
namespace {

template <class T>
struct Word {
    const char* name;
    T value;
};

constexpr std::array kWraps = {
    Word<WrapOn>{"torso_front", WrapOn::torso_front},
    Word<WrapOn>{"torso_back", WrapOn::torso_back},
    Word<WrapOn>{"torso_half", WrapOn::torso_half},
    Word<WrapOn>{"leg_front", WrapOn::leg_front},
    Word<WrapOn>{"leg_back", WrapOn::leg_back},
    Word<WrapOn>{"arm", WrapOn::arm},
};
constexpr std::array kWays = {Word<StripRecipe::Way>{"on", StripRecipe::Way::on},
                              Word<StripRecipe::Way>{"neck", StripRecipe::Way::neck},
                              Word<StripRecipe::Way>{"waist", StripRecipe::Way::waist}};

template <class Words>
auto read_word(JsonObject& object, const std::string& key, const Words& words) {
    const std::string text = object.text(key);
    std::string known;
    for (const auto& word : words) {
        if (text == word.name) {
            return word.value;
        }
        known += (known.empty() ? "" : ", ") + std::string(word.name);
    }
    throw object.error(key, "'" + text + "' is none of " + known);
}

Weave read_weave(JsonObject& object) {
    const std::string text = object.text("weave");
    if (const auto weave = weave_from_name(text)) {
        return *weave;
    }
    throw object.error("weave", "'" + text + "' is none of " + weave_names());
}

Vec3f read_colour(JsonObject& object) {
    const std::string text = object.text("color");
    if (text.size() != 7 || text[0] != '#' ||
        text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos) {
        throw object.error("color", "is not of the form #rrggbb");
    }
    const auto rgb = static_cast<int>(std::stoul(text.substr(1), nullptr, 16));
    return Vec3f(static_cast<float>(rgb >> 16 & 255), static_cast<float>(rgb >> 8 & 255),
                 static_cast<float>(rgb & 255)) /
           255.0f;
}

PanelWrap read_wrap(JsonObject object) {
    PanelWrap wrap;
    wrap.on = read_word(object, "on", kWraps);
    if (object.has("levels")) {
        JsonObject levels = object.object("levels");
        for (const std::string& point : levels.keys()) {
            wrap.levels[point] = levels.text(point);
        }
        levels.finish();
    }
    wrap.neck = object.text_or("neck", "");
    wrap.shoulder = object.text_or("shoulder", "");
    wrap.seam_of = object.text_or("seam_of", "");
    if (object.has("inner")) wrap.inner = object.texts("inner");
    if (object.has("outer")) wrap.outer = object.texts("outer");
    wrap.front = object.text_or("front", "");
    wrap.polar = object.text_or("polar", "");
    object.finish();
    if (wrap.polar.empty() && (wrap.inner.empty() || wrap.outer.empty())) {
        throw object.error("", "names no inner and outer edges");
    }
    if (wrap.neck.empty() != wrap.shoulder.empty()) {
        throw object.error("", "neck and shoulder come together");
    }
    return wrap;
}

PanelRecipe read_panel(JsonObject object) {
    PanelRecipe panel;
    panel.name = object.text("name");
    panel.piece = object.text("piece");
    for (const auto& corner : object.any("border")) {
        const bool sound = corner.is_array() && (corner.size() == 2 || corner.size() == 3) &&
                           corner[0].is_string() && corner[1].is_string();
        if (!sound || (corner.size() == 3 && corner[2] != "straight")) {
            throw object.error("border", "each corner is [point, edge] or [point, edge, "
                                         "\"straight\"]");
        }
        panel.border.push_back({corner[0], corner[1], corner.size() == 3});
    }
    if (panel.border.size() < 2) {
        throw object.error("border", "needs at least two corners");
    }
    panel.wrap = read_wrap(object.object("wrap"));
    object.finish();
    return panel;
}

StripRecipe read_strip(JsonObject object) {
    StripRecipe strip;
    strip.name = object.text("name");
    strip.along = object.texts("along");
    strip.height_m = object.number("height", 0.004, 0.5);
    strip.ratio = object.number_or("ratio", 0.3, 3.0, 1.0);
    if (object.has("way")) {
        strip.way = read_word(object, "way", kWays);
    }
    object.finish();
    if (strip.along.empty()) {
        throw object.error("along", "names no edge");
    }
    return strip;
}

std::vector<EdgeUse> read_row(const std::string& text) {
    std::vector<EdgeUse> row;
    std::size_t start = 0;
    while (start <= text.size()) {
        const std::size_t end = std::min(text.find('+', start), text.size());
        std::string item = text.substr(start, end - start);
        EdgeUse& use = row.emplace_back();
        use.reversed = !item.empty() && item[0] == '-';
        std::tie(use.panel, use.edge) = split_edge(use.reversed ? item.substr(1) : item);
        start = end + 1;
    }
    return row;
}

RecipeSeam read_seam(const nlohmann::json& value, const JsonObject& root) {
    if (!value.is_array() || value.size() != 2 || !value[0].is_string() || !value[1].is_string()) {
        throw root.error("seams", "each is [edges, edges]");
    }
    RecipeSeam seam;
    try {
        seam = {read_row(value[0]), read_row(value[1])};
    } catch (const Error& error) {
        throw root.error("seams", error.what());
    }
    if (seam.a.size() != seam.b.size() && seam.a.size() != 1 && seam.b.size() != 1) {
        throw root.error("seams", "a row is sewn to one edge, or to a row of as many edges");
    }
    return seam;
}

void read_look(JsonObject& root, Recipe& recipe) {
    for (JsonObject& entry : root.objects("parts")) {
        RecipePart& part = recipe.parts.emplace_back();
        part.name = entry.text("name");
        part.panels = entry.texts("panels");
        part.weave = read_weave(entry);
        part.turn_in_m = entry.number_or("turn_in", 0.0, 0.05, 0.012);
        entry.finish();
    }
    for (JsonObject& entry : root.objects("colourways")) {
        const std::string name = entry.text("name");
        recipe.colourways.emplace_back(name, read_colour(entry));
        entry.finish();
    }
    if (root.has("body_mask")) {
        for (const std::string& name : root.texts("body_mask")) {
            const auto part = body::part_from_label(name);
            if (!part) {
                throw root.error("body_mask", "'" + name + "' is no part of the body");
            }
            recipe.body_mask.push_back(*part);
        }
    }
}

void read_source(JsonObject& root, const std::filesystem::path& file, Recipe& recipe) {
    if (root.has("freesewing")) {
        for (JsonObject& source : root.objects("freesewing")) {
            DesignUse& use = recipe.designs.emplace_back();
            use.name = source.text("design");
            use.options = source.has("options") ? source.any("options") : nlohmann::json::object();
            if (source.has("allowances")) {
                JsonObject allowances = source.object("allowances");
                for (const std::string& name : allowances.keys()) {
                    use.allowances[name] = allowances.number(name, -0.5, 0.5);
                }
                allowances.finish();
            }
            source.finish();
        }
    } else {
        recipe.pieces_file = file.parent_path() / root.file_name("dxf");
    }
}

} // namespace

std::pair<std::string, std::string> split_edge(const std::string& text) {
    const std::size_t dot = text.find('.');
    if (dot == 0 || dot == std::string::npos || dot + 1 == text.size()) {
        throw Error("'" + text + "' is not of the form panel.edge");
    }
    return {text.substr(0, dot), text.substr(dot + 1)};
}

Recipe load_recipe(const std::filesystem::path& file) {
    const nlohmann::json json = parse_json_file(file);
    JsonObject root(json, file.string());
    Recipe recipe;
    (void)root.integer("schema", 1, 1);
    recipe.id = root.text("id");
    recipe.name = root.text("name");
    recipe.kind = root.text("kind");
    recipe.layer = static_cast<std::uint32_t>(root.integer("layer", 0, 15));
    read_source(root, file, recipe);
    recipe.sizes_on = root.text("sizes_on");
    recipe.fabric = root.text("fabric");
    if (root.has("ease_class")) recipe.ease_class = read_ease_intent(root);
    recipe.ease_m = root.number_or("ease", 0.0, 0.05, recipe.ease_m);
    recipe.edge_m = root.number_or("edge", 0.004, 0.05, recipe.edge_m);
    recipe.clearance_m = root.number_or("clearance", 0.001, 0.05, recipe.clearance_m);
    for (JsonObject& panel : root.objects("panels")) {
        recipe.panels.push_back(read_panel(std::move(panel)));
    }
    if (root.has("strips")) {
        for (JsonObject& strip : root.objects("strips")) {
            recipe.strips.push_back(read_strip(std::move(strip)));
        }
    }
    for (const auto& seam : root.any("seams")) {
        recipe.seams.push_back(read_seam(seam, root));
    }
    recipe.centres = root.texts("centres");
    read_look(root, recipe);
    recipe.chart = root.texts("chart");
    if (root.has("held")) {
        JsonObject held = root.object("held");
        recipe.held_prefix = held.text("panels");
        for (const auto& strength : held.any("strengths")) {
            recipe.held_strengths.push_back(strength.is_number() ? strength.get<double>() : -1.0);
        }
        held.finish();
        if (recipe.held_strengths.empty()) {
            throw held.error("strengths", "names none");
        }
        for (const double strength : recipe.held_strengths) {
            if (!(strength >= 0.0 && strength <= 1.0)) {
                throw held.error("strengths", "each is a number from 0 to 1");
            }
        }
    }
    root.finish();
    if (recipe.panels.empty() || recipe.parts.empty() || recipe.colourways.empty() ||
        recipe.chart.empty()) {
        throw root.error("", "panels, parts, colourways and chart need at least one entry each");
    }
    return recipe;
}

} // namespace toile::garment::block
