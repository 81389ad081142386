#include "scenes.h"

#include "support/cloth_world_cases.h"

namespace toile::bullet_cloth::test {
namespace {

TEST(World, AGarmentDoesNotFeelAnother) {
    Stage alone = draped();
    Stage both = draped();
    const Mesh other = sheet({-0.1f, 1.3f, 0.1f}, {0.2f, 0, 0}, {0, 0, -0.2f}, 8, 8);
    GarmentInput input;
    input.mesh = {other.positions, other.triangles, other.corner_coords, {}};
    input.joints = other.joints;
    input.weights = other.weights;
    const std::uint32_t second = both.world.add_garment(input);
    EXPECT_NE(second, both.handle);
    std::vector<Vec3f> out(other.positions.size());
    std::vector<Vec3f> normals(other.positions.size());
    for (int i = 0; i < 10; ++i) {
        alone.step();
        const std::array<GarmentFrame, 2> frames{
            GarmentFrame{second, other.positions, out, normals},
            GarmentFrame{both.handle, both.targets, both.positions, both.normals}};
        ASSERT_EQ(both.world.step({both.body_now, both.body_now, 1.0 / 30.0, i == 0, frames}),
                  StepResult::ok);
        ASSERT_TRUE(same_bytes(alone.positions, both.positions));
    }
    both.world.remove_garment(second);
    both.begun = true;
    for (int i = 0; i < 5; ++i) {
        alone.step();
        ASSERT_EQ(both.step(), StepResult::ok);
        ASSERT_TRUE(same_bytes(alone.positions, both.positions));
    }
    EXPECT_THROW(both.world.remove_garment(second), Error);
    EXPECT_NE(both.world.add_garment(input), second); // handles are not used twice
}

} // namespace
} // namespace toile::bullet_cloth::test
