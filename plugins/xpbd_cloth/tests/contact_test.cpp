#include "scenes.h"

#include "support/cloth_contact_cases.h"

namespace toile::xpbd_cloth::test {
namespace {

// The shorter a substep, the more its velocity trembles: where cloth will be must not be told from
// that, or it is led to the wrong side of a limb.
TEST(Contact, ManySubstepsDoNotLeadClothAstray) {
    constexpr float kGap = 0.06f;
    constexpr int kFrames = 20;
    const Armpit scene(kGap);
    Settings settings;
    settings.substep_rate = 5000.0;
    Stage stage(scene.body, scene.cloth, settings, {}, scene.held);
    for (int i = 0; i < 2 * kFrames; ++i) {
        const float closed = (kGap + 0.015f) * std::min(1.0f, float(i) / kFrames);
        ASSERT_EQ(stage.step_to(scene.lowered(closed, stage.targets)), StepResult::ok);
        ASSERT_LT(longest_stretch(stage), 0.4f) << "closed by " << closed;
    }
}

} // namespace
} // namespace toile::xpbd_cloth::test
