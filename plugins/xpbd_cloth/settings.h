// The numbers that a user may turn (offered as toile.parameters/1) and their defaults.
#pragma once

namespace toile::xpbd_cloth {

struct Settings {
    double substep_rate = 0.0;   ///< 1/s; 0: from the mesh, `wave_speed` over its mean edge
    double wave_speed = 17.0;    ///< m/s, mesh edges that a pull travels in a second
    double contact_rate = 60.0;  ///< 1/s, refreshes of the contact planes
    double margin = 0.003;       ///< m, kept free between skin and cloth
    double strain_limit = 0.03;  ///< longest that cloth gets over its material; 0: none
    double limit_edges = 4.0;    ///< reach of the longer limits, mesh edges; 0: none
    double border_passes = 16.0; ///< over the edges of openings, each substep
    double leash = 0.25;         ///< m, farthest a free vertex may be from its target
    double pull_rate = 60.0;     ///< rad/s, of a vertex with attachment 0.5 about its target
    double air_drag = 1.0;       ///< 1/s
    double damping_scale = 1.0;  ///< on the fabric's own damping
    double friction_scale = 1.0; ///< on the fabric's own friction
    double clean_passes = 4.0;   ///< against the full-resolution body, at the end of a frame
    double self_contact = 1.0;   ///< 0: cloth does not meet cloth
    double gravity = 9.81;       ///< m/s^2, along -Y
};

} // namespace toile::xpbd_cloth
