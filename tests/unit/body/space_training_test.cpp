// The whole training of a body space, from body data and survey to files that load: a tiny one, of
// a coarse template, few people and few poses. What the shipped one is worth stands in its
// training.json.
#include "body/space_training.h"

#include "body/body_space.h"
#include "body/landmarks.h"
#include "body/measurement.h"
#include "body/pose_tables.h"
#include "support/makehuman.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

namespace toile::body {
namespace {

SpaceOptions tiny() {
    SpaceOptions out;
    out.id = "tiny";
    out.components = 4;
    out.people_per_sex = 6;
    out.heavy_per_sex = 2;
    out.unseen_per_sex = 4;
    out.poses.training_poses = 6;
    out.poses.test_poses = 2;
    out.poses.baked_poses = 20;
    out.coarseness = 1.5f; // at 1.8 fingers grow together
    return out;
}

TEST(SpaceTraining, ATinySpaceIsTrainedFromEndToEnd) {
    TOILE_SHARED_DATA_OR_SKIP(survey, "ansur2");
    TOILE_SHARED_DATA_OR_SKIP(data, "makehuman_cc0");
    const test::TemporaryFolder folder;
    SpaceOptions options = tiny();
    options.data = test::makehuman_release();
    options.survey = survey;
    options.out = folder.path();
    const auto report = train_body_space(options);
    EXPECT_EQ(report.at("population").at("people").get<std::size_t>() +
                  report.at("population").at("heavy_people").get<std::size_t>() +
                  report.at("shape").at("unseen_people").at("people").get<std::size_t>() +
                  report.at("population").at("dropped_people").get<std::size_t>(),
              24u);
    EXPECT_LT(report.at("shape").at("unseen_people").at("surface_mean_mm"), 15.0);

    const auto space = BodySpace::load(folder / "tiny");
    const BodyModel& model = space.model();
    EXPECT_EQ(space.component_count(), 4);
    EXPECT_EQ(space.levels().size(), 2u);
    EXPECT_TRUE(geometry::check_topology(model.rest.positions, model.rest.triangles).closed());
    EXPECT_EQ(model.landmarks.size(), kLandmarkCount);
    EXPECT_EQ(model.measurements.size(), measurement_definitions().size());
    EXPECT_NEAR(model.measurements.at("stature"), 1.7, 0.15);
    const PoseTables tables = load_pose_tables(model);
    EXPECT_EQ(tables.deformation.weights.size(), model.rest.triangles.size());
    for (const char* name : {"training.json", "PROVENANCE.md"})
        EXPECT_TRUE(std::filesystem::exists(model.folder / name)) << name;
}

} // namespace
} // namespace toile::body
