#include "garment/block_design.h"

#include "core/error.h"

namespace toile::garment::block {
namespace {

// Fabrics are in the middle of what is measured on such cloth with the Kawabata instruments
// (Kawabata 1980): 1 gf cm2/cm of bending is 9.8e-5 N m, 1 gf/(cm degree) of shear 56 N/m.
Fabric jersey() {
    Fabric f;
    f.name = "single jersey, cotton";
    f.density_kg_m2 = 0.160;
    f.thickness_m = 0.0006;
    f.stretch_warp_n_m = 320.0;
    f.stretch_weft_n_m = 220.0;
    f.shear_n_m = 45.0;
    f.bending_warp_nm = 3.0e-6;
    f.bending_weft_nm = 2.5e-6;
    f.friction = 0.40;
    f.damping = 1.0;
    return f;
}

Fabric twill() {
    Fabric f;
    f.name = "2/1 twill, cotton and wool";
    f.density_kg_m2 = 0.210;
    f.thickness_m = 0.0005;
    f.stretch_warp_n_m = 2600.0;
    f.stretch_weft_n_m = 1800.0;
    f.shear_n_m = 70.0;
    f.bending_warp_nm = 1.2e-5;
    f.bending_weft_nm = 0.9e-5;
    f.friction = 0.35;
    f.damping = 1.0;
    return f;
}

Vec3f hex(const int rgb) {
    return Vec3f(static_cast<float>(rgb >> 16 & 255), static_cast<float>(rgb >> 8 & 255),
                 static_cast<float>(rgb & 255)) /
           255.0f;
}

Design t_shirt() {
    Design d;
    d.id = d.kind = "t-shirt";
    d.name = "T-shirt, crew neck";
    d.edge_m = 0.0158;
    d.draft = [](const BodyProbe& body, std::optional<double> girth_ease) {
        TShirtOptions options;
        if (girth_ease) {
            options.hem_ease_m += *girth_ease - options.chest_ease_m;
            options.chest_ease_m = *girth_ease;
        }
        return draft_t_shirt(body, options);
    };
    d.fabric = jersey();
    d.layer = 1;
    d.drape.density_kg_m2 = d.fabric.density_kg_m2;
    d.drape.stretch_n_m = d.fabric.stretch_warp_n_m;
    d.parts = {{"collar", Weave::rib, {"collar"}, 0.010}, {"body", Weave::jersey, {""}, 0.014}};
    d.colours = {{"off-white", hex(0xefebe2)}, {"deep-teal", hex(0x1d5a63)}};
    d.chart = {"bust_girth", "waist_girth", "hip_girth"};
    return d;
}

Design skirt() {
    Design d;
    d.id = d.kind = "skirt";
    d.name = "A-line skirt, knee-length";
    d.edge_m = 0.0168;
    d.draft = [](const BodyProbe& body, std::optional<double> girth_ease) {
        SkirtOptions options;
        options.hip_ease_m = girth_ease.value_or(options.hip_ease_m);
        return draft_skirt(body, options);
    };
    d.fabric = twill();
    d.layer = 0;
    d.drape.density_kg_m2 = d.fabric.density_kg_m2;
    d.drape.stretch_n_m = d.fabric.stretch_weft_n_m;
    d.drape.bending = 0.2;
    d.parts = {{"cloth", Weave::twill, {""}, 0.016}};
    d.colours = {{"charcoal", hex(0x43454b)}, {"rust", hex(0xa4502c)}};
    d.held_prefix = "band_";
    d.held_strengths = {1.0f, 0.35f, 0.1f};
    d.chart = {"waist_girth", "hip_girth"};
    return d;
}

const std::vector<Design>& designs() {
    static const std::vector<Design> all = {skirt(), t_shirt()};
    return all;
}

} // namespace

const Design& find_design(const std::string& id) {
    std::string known;
    for (const Design& design : designs()) {
        if (design.id == id) {
            return design;
        }
        known += (known.empty() ? "" : ", ") + design.id;
    }
    throw UsageError("there is no block '" + id + "'; there are " + known);
}

} // namespace toile::garment::block
