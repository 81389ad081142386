// The stage of tests/support with this plugin's world on it.
#pragma once

#define TOILE_CLOTH_PLUGIN bullet_cloth

#include "bullet_cloth/cloth_world.h"
#include "support/cloth_stage.h"

namespace toile::bullet_cloth::test {

using namespace toile::test::cloth_stage;
using Stage = ClothStage<ClothWorld, Settings>;

inline Settings free_fall() {
    Settings settings;
    settings.air_drag = 0.0;
    settings.leash = 5.0;
    settings.damping_scale = 0.0;
    return settings;
}

/// Small enough steps for closed forms of what swings.
inline Settings finely(const Settings& settings) {
    return settings;
}

} // namespace toile::bullet_cloth::test
