// The shipped avatars, and garments that artists made for another body.
#include "body/body_model.h"
#include "garment/import.h"
#include "mesh_garment/binder.h"
#include "support/shared_data.h"

#include <gtest/gtest.h>

namespace toile::mesh_garment {
namespace {

body::BodyModel avatar(const std::string& id) {
    return body::load_body_model(std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" / id);
}

BodyView view_of(const body::BodyModel& b) {
    return {b.rest.positions, b.rest.triangles, b.skin.joints, b.skin.weights,
            b.skeleton.rest_positions};
}

TEST(Avatars, ArtistsGarmentsBindToAllThree) {
    TOILE_SHARED_DATA_OR_SKIP(clothes, "makehuman_clothes_cc0");
    const body::BodyModel woman = avatar("woman");
    const BodySurface made_on(view_of(woman));
    for (const char* const name : {"female_casualsuit02", "female_elegantsuit01"}) {
        garment::ImportOptions options;
        options.id = name;
        options.made_on = "woman";
        const auto file = clothes / "base" / "clothes" / name / (std::string(name) + ".obj");
        const auto import = garment::import_garment(file, options, &woman);
        const auto& mesh = import.package.sizes[0].simulation;
        GarmentView garment;
        garment.positions = mesh.positions;
        garment.triangles = mesh.triangles;
        for (const char* const id : {"woman", "man", "mannequin"}) {
            const body::BodyModel wearer = avatar(id);
            const BodySurface body(view_of(wearer));
            const Binding bound = bind(body, &made_on, garment);
            const float stretch = worst_stretch(bound.positions, mesh.triangles, bound.skin,
                                                test_poses(wearer.skeleton.rest_positions));
            std::printf("%s on %s: %zu short of ease, nearest %.2f mm, %d rounds, stretch %.2f\n",
                        name, id, bound.clearance.short_of_ease,
                        1000.0 * static_cast<double>(bound.clearance.least_m),
                        bound.clearance.rounds, static_cast<double>(stretch));
            EXPECT_EQ(bound.clearance.short_of_ease, 0u);
            EXPECT_LT(stretch, 4.0f);
            EXPECT_GE(bound.clearance.least_m, garment.ease_m);
        }
    }
}

} // namespace
} // namespace toile::mesh_garment
