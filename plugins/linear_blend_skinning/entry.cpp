// Kind toile.skinning/1 over body/skinning.h.
#include "body/skinning.h"
#include "geometry/mesh.h"
#include "sdk/parameters.h"
#include "sdk/plugin.h"
#include "sdk/skinning.h"
#include "sdk/views.h"

#include <memory>

namespace {

namespace sdk = toile::sdk;
using toile::Vec3f;

std::vector<Vec3f> vectors(std::span<const sdk::Float3> rows) {
    std::vector<Vec3f> out(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        out[i] = Vec3f(rows[i][0], rows[i][1], rows[i][2]);
    return out;
}

class LinearBlendSkinning {
  public:
    static constexpr sdk::Info info{.id = "toile.linear_blend_skinning",
                                    .name = "Linear blend and dual quaternion skinning",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Skinning>;
    using Extensions = sdk::Kinds<sdk::Parameters>;
    static constexpr std::array parameters{
        sdk::Parameter{"dual_quaternion", TOILE_PARAMETER_SWITCH, "1",
                       "1: blend rigid motions, keeps the girth of twisted limbs", 0, 1, 0}};

    explicit LinearBlendSkinning(sdk::Host) {}

    double& parameter(std::size_t) { return dual_quaternion_; }

    void activate(const toile_limits&) {
        method_ = dual_quaternion_ != 0.0 ? toile::body::SkinningMethod::dual_quaternion
                                          : toile::body::SkinningMethod::linear_blend;
    }

    void bind(const toile_body& body, sdk::Job job) {
        const auto positions =
            vectors(sdk::span_of<sdk::Float3>(body.rest.positions, "rest.positions"));
        const std::size_t count = positions.size();
        if (count == 0) throw sdk::bad_argument("rest.positions: a body without a surface");
        std::vector<Vec3f> normals;
        if (body.rest.normals.count != 0) {
            normals = vectors(sdk::span_of<sdk::Float3>(body.rest.normals, "rest.normals", count));
        } else {
            const auto triangles =
                sdk::span_of<sdk::Triangle>(body.rest.triangles, "rest.triangles");
            normals.resize(count);
            toile::geometry::vertex_normals(positions, triangles, normals);
        }
        const auto joints =
            sdk::span_of<sdk::Float3>(body.rest_joints, "rest_joints", TOILE_JOINT_COUNT);
        for (std::size_t i = 0; i < joints.size(); ++i)
            skeleton_.rest_positions[i] = Vec3f(joints[i][0], joints[i][1], joints[i][2]);
        const auto indices = sdk::span_of<sdk::Index4>(body.joint_indices, "joint_indices", count);
        const auto weights = sdk::span_of<sdk::Float4>(body.joint_weights, "joint_weights", count);
        surface_ =
            std::make_unique<toile::body::SkinnedSurface>(positions, normals, indices, weights);
        revision_ = body.revision;
        job.progress(1.0);
    }

    void pose(const toile_body_state& state, toile_view_mut positions, toile_view_mut normals) {
        if (!surface_) throw sdk::bad_argument("pose: called before bind");
        if (state.body_revision != revision_)
            throw sdk::bad_argument("state: poses another body than the one bound");
        const auto joints =
            sdk::span_of<toile_joint>(state.joints, "state.joints", TOILE_JOINT_COUNT);
        toile::body::JointTransforms world;
        for (std::size_t i = 0; i < joints.size(); ++i) {
            const toile_joint& joint = joints[i];
            world[i].translation = Vec3f(joint.position[0], joint.position[1], joint.position[2]);
            world[i].rotation = toile::Quatf(joint.rotation[3], joint.rotation[0],
                                             joint.rotation[1], joint.rotation[2]);
            const float norm = world[i].rotation.norm();
            if (!world[i].translation.allFinite() || !(norm > 0.9f && norm < 1.1f))
                throw sdk::Failure(TOILE_E_NUMERIC,
                                   "state.joints: not finite, or not a unit quaternion");
            world[i].rotation.coeffs() /= norm;
        }
        surface_->pose(toile::body::skinning_transforms(skeleton_, world), method_,
                       rows(positions, "positions"), rows(normals, "normals"));
    }

  private:
    [[nodiscard]] toile::body::VectorRows rows(const toile_view_mut& view, const char* name) const {
        if (view.count == 0) return {};
        const auto out = sdk::span_of<sdk::Float3>(view, name, surface_->vertex_count());
        return {out.front().data(), sizeof(sdk::Float3)};
    }

    double dual_quaternion_ = 0.0;
    toile::body::SkinningMethod method_ = toile::body::SkinningMethod::linear_blend;
    toile::body::Skeleton skeleton_;
    std::unique_ptr<toile::body::SkinnedSurface> surface_;
    std::uint64_t revision_ = 0;
};

} // namespace

TOILE_PLUGIN(linear_blend_skinning, LinearBlendSkinning)
