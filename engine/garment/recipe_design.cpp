#include "garment/recipe_design.h"

#include "garment/fabric_table.h"
#include "garment/recipe_pattern.h"

namespace toile::garment::block {

Design design_of(const Recipe& recipe, CutPieces cut) {
    Design d;
    d.id = recipe.id;
    d.name = recipe.name;
    d.kind = recipe.kind;
    d.edge_m = recipe.edge_m;
    const auto kept = std::make_shared<const Recipe>(recipe);
    d.draft = [kept, cut = std::move(cut)](const BodyProbe& body, std::optional<double>) {
        Pattern pattern = pattern_of(*kept, cut(body), body);
        // The panels' places read the recipe.
        for (HalfPanel& panel : pattern.panels) {
            panel.place = [kept, place = std::move(panel.place)](const Vec2d& p) {
                return place(p);
            };
        }
        return pattern;
    };
    d.fabric = find_fabric(recipe.fabric).fabric;
    d.ease_m = recipe.ease_m;
    d.layer = recipe.layer;
    d.drape.clearance_m = recipe.clearance_m;
    d.drape.density_kg_m2 = d.fabric.density_kg_m2;
    // Stiffer cloth hangs no differently, but shivers in contact at these steps.
    d.drape.stretch_n_m =
        std::min(2000.0, std::max(d.fabric.stretch_warp_n_m, d.fabric.stretch_weft_n_m));
    d.drape.bending = d.fabric.bending_warp_nm > 8e-6 ? 0.2 : 0.1;
    for (const RecipePart& part : recipe.parts) {
        d.parts.push_back({part.name, part.weave, part.panels, part.turn_in_m});
    }
    for (const auto& [name, colour] : recipe.colourways) {
        d.colours.push_back({name, colour});
    }
    d.held_prefix = recipe.held_prefix;
    d.held_strengths.assign(recipe.held_strengths.begin(), recipe.held_strengths.end());
    d.ease_class = recipe.ease_class;
    d.chart = recipe.chart;
    d.body_mask = recipe.body_mask;
    return d;
}

} // namespace toile::garment::block
