// The stage of tests/support with this plugin's world on it.
#pragma once

#define TOILE_CLOTH_PLUGIN xpbd_cloth

#include "support/cloth_stage.h"
#include "xpbd_cloth/cloth_world.h"

namespace toile::xpbd_cloth::test {

using namespace toile::test::cloth_stage;
using Stage = ClothStage<ClothWorld, Settings>;

inline Settings free_fall() {
    Settings settings;
    settings.air_drag = 0.0;
    settings.leash = 5.0;
    settings.damping_scale = 0.0;
    settings.self_contact = 0.0;
    settings.strain_limit = 0.0;
    return settings;
}

/// Small enough steps for closed forms of what swings.
inline Settings finely(Settings settings) {
    settings.substep_rate = 2400.0;
    return settings;
}

} // namespace toile::xpbd_cloth::test
