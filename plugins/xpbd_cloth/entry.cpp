// Kind toile.cloth/1 over xpbd_cloth/cloth_world.h.
#include "abi/body.h"
#include "sdk/cloth.h"
#include "sdk/host.h"
#include "sdk/parameters.h"
#include "sdk/plugin.h"
#include "sdk/views.h"
#include "xpbd_cloth/cloth_world.h"

namespace {

namespace sdk = toile::sdk;
using toile::Vec2f;
using toile::Vec3f;
using namespace toile::xpbd_cloth;
using toile::cloth::Fabric;

static_assert(toile::cloth::kBodyJoints == TOILE_JOINT_COUNT);
static_assert(sizeof(Vec3f) == sizeof(sdk::Float3) && alignof(Vec3f) == alignof(sdk::Float3));
static_assert(sizeof(Vec2f) == sizeof(sdk::Float2) && alignof(Vec2f) <= 8);

std::span<const Vec3f> vectors(std::span<const sdk::Float3> rows) noexcept {
    return {reinterpret_cast<const Vec3f*>(rows.data()), rows.size()};
}
std::span<Vec3f> vectors(std::span<sdk::Float3> rows) noexcept {
    return {reinterpret_cast<Vec3f*>(rows.data()), rows.size()};
}

Fabric fabric_from(const toile_fabric& in) {
    return {.density = in.density_kg_m2,
            .thickness = in.thickness_m,
            .stretch_warp = in.stretch_warp_n_m,
            .stretch_weft = in.stretch_weft_n_m,
            .shear = in.shear_n_m,
            .bend_warp = in.bend_warp_nm,
            .bend_weft = in.bend_weft_nm,
            .friction = in.friction,
            .damping = in.damping};
}

toile_status status_of(StepResult result) noexcept {
    switch (result) {
    case StepResult::ok:
    case StepResult::recovered:
        return TOILE_OK;
    case StepResult::body_values:
    case StepResult::target_values:
        return TOILE_E_NUMERIC;
    default:
        return TOILE_E_ARGUMENT;
    }
}

class XpbdCloth {
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

    explicit XpbdCloth(sdk::Host host) : host_(host) {}

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
    void reset() { begin_anew_ = true; }

    void set_body(const toile_body& body, sdk::Job job) {
        world_.set_body({vectors(sdk::span_of<sdk::Float3>(body.rest.positions, "rest.positions")),
                         sdk::span_of<sdk::Triangle>(body.rest.triangles, "rest.triangles"),
                         sdk::span_of<sdk::Index4>(body.joint_indices, "joint_indices"),
                         sdk::span_of<sdk::Float4>(body.joint_weights, "joint_weights")});
        job.progress(1.0);
    }

    std::uint32_t add_garment(const toile_cloth_garment& garment, sdk::Job job) {
        job.progress(0.0);
        const auto coords =
            sdk::span_of<sdk::Float2>(garment.rest.corner_coords, "rest.corner_coords");
        const auto seams = sdk::span_of<toile_seam>(garment.seams, "seams");
        seams_.clear();
        for (const toile_seam& seam : seams)
            seams_.push_back({seam.a, seam.b});
        material_.resize(coords.size());
        for (std::size_t i = 0; i < coords.size(); ++i)
            material_[i] = Vec2f(coords[i][0], coords[i][1]);
        GarmentInput input;
        input.mesh.positions =
            vectors(sdk::span_of<sdk::Float3>(garment.rest.positions, "rest.positions"));
        input.mesh.triangles =
            sdk::span_of<sdk::Triangle>(garment.rest.triangles, "rest.triangles");
        input.mesh.corner_coords = material_;
        input.mesh.seams = seams_;
        input.fabric = fabric_from(garment.fabric);
        input.joints = sdk::span_of<sdk::Index4>(garment.joint_indices, "joint_indices");
        input.weights = sdk::span_of<sdk::Float4>(garment.joint_weights, "joint_weights");
        input.attachment = sdk::span_of<float>(garment.attachment, "attachment");
        input.layer = garment.layer;
        const std::uint32_t handle = world_.add_garment(input);
        frames_.resize(world_.garment_count());
        job.progress(1.0);
        return handle;
    }

    void remove_garment(std::uint32_t garment) {
        world_.remove_garment(garment);
        frames_.resize(world_.garment_count());
    }

    void step(const toile_cloth_step& step) {
        const auto targets = sdk::targets_of(step);
        const auto states = sdk::states_of(step);
        if (targets.size() != frames_.size())
            throw sdk::bad_argument(step_result_text(StepResult::garment_count));
        for (std::uint32_t i = 0; i < frames_.size(); ++i) {
            if (states[i].garment != targets[i].garment)
                throw sdk::bad_argument("step: states and targets name different garments");
            frames_[i] = {
                targets[i].garment,
                vectors(sdk::span_of<sdk::Float3>(targets[i].positions, "targets.positions")),
                vectors(sdk::span_of<sdk::Float3>(states[i].positions, "states.positions")),
                vectors(sdk::span_of<sdk::Float3>(states[i].normals, "states.normals"))};
        }
        const toile_body_state before = sdk::read_struct(step.body_before, "body_before");
        const toile_body_state after = sdk::read_struct(step.body_after, "body_after");
        StepInput input;
        input.body_before =
            vectors(sdk::span_of<sdk::Float3>(before.positions, "body_before.positions"));
        input.body_after =
            vectors(sdk::span_of<sdk::Float3>(after.positions, "body_after.positions"));
        input.dt_s = step.dt_s;
        input.reset = begin_anew_ || (step.flags & TOILE_STEP_RESET) != 0;
        input.garments = frames_;
        const StepResult result = world_.step(input);
        if (result == StepResult::recovered) {
            host_.warning(step_result_text(result));
        } else if (result != StepResult::ok) {
            throw sdk::Failure(status_of(result), step_result_text(result));
        }
        begin_anew_ = false;
    }

  private:
    sdk::Host host_;
    Settings settings_;
    ClothWorld world_;
    std::vector<GarmentFrame> frames_; ///< (garments) of the step at hand
    std::vector<Vec2f> material_;
    std::vector<std::array<std::uint32_t, 2>> seams_;
    bool begin_anew_ = false;
};

} // namespace

TOILE_PLUGIN(xpbd_cloth, XpbdCloth)
