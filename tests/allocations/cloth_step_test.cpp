// A step of the cloth allocates nothing, whatever touches whatever.
#include "allocations/allocation_counter.h"

#include "support/cloth_stage.h"
#include "xpbd_cloth/cloth_world.h"

#include <gtest/gtest.h>

namespace toile::test {
namespace {

using namespace cloth_stage;

TEST(Allocations, AStepOfXpbdClothAllocatesNothing) {
    ClothStage<xpbd_cloth::ClothWorld, xpbd_cloth::Settings> stage(
        sphere({0, 1, 0}, 0.15f), sheet({-0.3f, 1.2f, 0.3f}, {0.6f, 0, 0}, {0, 0, -0.6f}, 40, 40));
    for (int i = 0; i < 40; ++i) { // it hangs in folds that meet each other
        ASSERT_EQ(stage.step(), cloth::StepResult::ok);
    }
    std::vector<Vec3f> body = stage.body_now;
    for (int i = 0; i < 5; ++i) {
        for (Vec3f& p : body) {
            p.x() += 0.01f;
        }
        AllocationCount count;
        const cloth::GarmentFrame frame{stage.handle, stage.targets, stage.positions,
                                        stage.normals};
        const cloth::StepResult result =
            stage.world.step({stage.body_now, body, 1.0 / 30.0, false, std::span(&frame, 1)});
        EXPECT_EQ(count.stop(), 0u) << AllocationCount::first();
        ASSERT_EQ(result, cloth::StepResult::ok);
        stage.body_now = body;
    }
}

} // namespace
} // namespace toile::test
