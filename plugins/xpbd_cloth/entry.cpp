// Kind toile.cloth/1 over xpbd_cloth/cloth_world.h.
#include "xpbd_cloth/cloth_world.h"

#include "boundary/cloth_entry.h"
#include "sdk/parameters.h"
#include "sdk/plugin.h"

namespace {

namespace sdk = toile::sdk;
using toile::xpbd_cloth::ClothWorld;
using toile::xpbd_cloth::Settings;

class XpbdCloth : public toile::boundary::ClothEntry<ClothWorld> {
  public:
    static constexpr sdk::Info info{.id = "toile.xpbd_cloth",
                                    .name = "Cloth in small steps (XPBD)",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Cloth>;
    using Extensions = sdk::Kinds<sdk::Parameters>;
    static constexpr Settings defaults{};
    static constexpr std::array parameters{
        sdk::Parameter{"substep_rate", TOILE_PARAMETER_REAL, "1/s",
                       "substeps a second; more: less stretch, more time; 0: from the mesh", 0,
                       10000, defaults.substep_rate},
        sdk::Parameter{"wave_speed", TOILE_PARAMETER_REAL, "m/s",
                       "chooses the substeps: mesh edges that a pull travels in a second", 1, 200,
                       defaults.wave_speed},
        sdk::Parameter{"contact_rate", TOILE_PARAMETER_REAL, "1/s",
                       "how often contacts are found anew", 30, 2000, defaults.contact_rate},
        sdk::Parameter{"margin", TOILE_PARAMETER_REAL, "m", "kept free between skin and cloth", 0,
                       0.02, defaults.margin},
        sdk::Parameter{"strain_limit", TOILE_PARAMETER_REAL, "1",
                       "longest that cloth gets over its material; 0: none", 0, 1,
                       defaults.strain_limit},
        sdk::Parameter{"limit_edges", TOILE_PARAMETER_REAL, "1",
                       "reach of the longer limits in mesh edges; 0: none", 0, 40,
                       defaults.limit_edges},
        sdk::Parameter{"border_passes", TOILE_PARAMETER_INTEGER, "1",
                       "passes over the edges of openings in each substep", 0, 50,
                       defaults.border_passes},
        sdk::Parameter{"leash", TOILE_PARAMETER_REAL, "m",
                       "farthest that free cloth may be from where plain skinning has it", 0.01, 5,
                       defaults.leash},
        sdk::Parameter{"pull_rate", TOILE_PARAMETER_REAL, "rad/s",
                       "pull on a vertex with attachment 0.5 to its target", 0, 1000,
                       defaults.pull_rate},
        sdk::Parameter{"air_drag", TOILE_PARAMETER_REAL, "1/s", "velocity lost to the air", 0, 100,
                       defaults.air_drag},
        sdk::Parameter{"damping_scale", TOILE_PARAMETER_REAL, "1", "on the fabric's damping", 0,
                       100, defaults.damping_scale},
        sdk::Parameter{"friction_scale", TOILE_PARAMETER_REAL, "1", "on the fabric's friction", 0,
                       10, defaults.friction_scale},
        sdk::Parameter{"clean_passes", TOILE_PARAMETER_INTEGER, "1",
                       "passes against the full body at the end of a frame", 0, 20,
                       defaults.clean_passes},
        sdk::Parameter{"self_contact", TOILE_PARAMETER_INTEGER, "1",
                       "1: cloth meets cloth, within and between garments", 0, 1,
                       defaults.self_contact},
        sdk::Parameter{"gravity", TOILE_PARAMETER_REAL, "m/s^2", "along -Y", -100, 100,
                       defaults.gravity},
    };

    explicit XpbdCloth(sdk::Host host) : ClothEntry(host) {}

    double& parameter(std::size_t index) {
        const std::array<double*, parameters.size()> all{
            &settings_.substep_rate,  &settings_.wave_speed,    &settings_.contact_rate,
            &settings_.margin,        &settings_.strain_limit,  &settings_.limit_edges,
            &settings_.border_passes, &settings_.leash,         &settings_.pull_rate,
            &settings_.air_drag,      &settings_.damping_scale, &settings_.friction_scale,
            &settings_.clean_passes,  &settings_.self_contact,  &settings_.gravity};
        return *all[index];
    }
    void activate(const toile_limits&) { world_.set_settings(settings_); }

  private:
    Settings settings_;
};

} // namespace

TOILE_PLUGIN(xpbd_cloth, XpbdCloth)
