// Skinning in a hundred lines: linear blend, with an optional swell that breathes along the body.
#include "sdk/parameters.h"
#include "sdk/plugin.h"
#include "sdk/skinning.h"
#include "sdk/thread_pool.h"
#include "sdk/views.h"

#include <cmath>
#include <vector>

namespace {

namespace sdk = toile::sdk;
using sdk::Float3;

Float3 operator+(const Float3& a, const Float3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Float3 operator-(const Float3& a, const Float3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Float3 operator*(float s, const Float3& a) {
    return {s * a[0], s * a[1], s * a[2]};
}
Float3 cross(const Float3& a, const Float3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
float dot(const Float3& a, const Float3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Float3 rotate(const float* q, const Float3& v) { // q: x y z w
    const Float3 u{q[0], q[1], q[2]};
    const Float3 t = 2.0f * cross(u, v);
    return v + q[3] * t + cross(u, t);
}

class WaveSkinning {
  public:
    static constexpr sdk::Info info{.id = "example.wave_skinning",
                                    .name = "Wave skinning",
                                    .version = "1.0.0",
                                    .vendor = "Example"};
    using Kinds = sdk::Kinds<sdk::Skinning>;
    using Extensions = sdk::Kinds<sdk::Parameters>;
    static constexpr std::array parameters{sdk::Parameter{
        "swell", TOILE_PARAMETER_REAL, "m", "How far the surface swells", 0, 0.02, 0}};

    explicit WaveSkinning(sdk::Host host) : pool_(host) {}

    double& parameter(std::size_t) { return swell_m_; }

    // [worker] Everything that pose needs is copied: views are borrowed for the call.
    void bind(const toile_body& body, sdk::Job job) {
        const auto positions = sdk::span_of<Float3>(body.rest.positions, "rest.positions");
        const std::size_t count = positions.size();
        if (count == 0) throw sdk::bad_argument("rest.positions: a body without a surface");
        const auto normals = sdk::span_of<Float3>(body.rest.normals, "rest.normals", count);
        const auto joints =
            sdk::span_of<Float3>(body.rest_joints, "rest_joints", TOILE_JOINT_COUNT);
        const auto indices = sdk::span_of<sdk::Index4>(body.joint_indices, "joint_indices", count);
        const auto weights = sdk::span_of<sdk::Float4>(body.joint_weights, "joint_weights", count);
        for (const sdk::Index4& row : indices)
            for (const std::uint16_t joint : row)
                if (joint >= TOILE_JOINT_COUNT) throw sdk::bad_argument("joint_indices: above 21");
        positions_.assign(positions.begin(), positions.end());
        normals_.assign(normals.begin(), normals.end());
        joints_.assign(joints.begin(), joints.end());
        indices_.assign(indices.begin(), indices.end());
        weights_.assign(weights.begin(), weights.end());
        job.progress(1.0);
    }

    // [frame] No allocation, no lock, no file.
    void pose(const toile_body_state& state, toile_view_mut positions, toile_view_mut normals) {
        if (positions_.empty()) throw sdk::bad_argument("pose: called before bind");
        const auto joints =
            sdk::span_of<toile_joint>(state.joints, "state.joints", TOILE_JOINT_COUNT);
        for (const toile_joint& joint : joints)
            for (const float value : joint.rotation)
                if (!std::isfinite(value))
                    throw sdk::Failure(TOILE_E_NUMERIC, "state.joints: not finite");
        const auto out = sdk::span_of<Float3>(positions, "positions", positions_.size());
        const auto out_normals = sdk::span_of<Float3>(normals, "normals", positions_.size());
        const double time_s = static_cast<double>(state.timestamp_ns) * 1e-9;
        pool_.parallel_for(static_cast<std::uint32_t>(out.size()), 2048,
                           [&](std::uint32_t begin, std::uint32_t end) {
                               for (std::uint32_t i = begin; i < end; ++i)
                                   pose_vertex(i, joints, time_s, out[i], out_normals[i]);
                           });
    }

  private:
    void pose_vertex(std::size_t i, std::span<const toile_joint> joints, double time_s,
                     Float3& position, Float3& normal) const {
        Float3 p{};
        Float3 n{};
        for (std::size_t k = 0; k < 4; ++k) {
            const float weight = weights_[i][k];
            if (weight == 0.0f) continue;
            const std::size_t j = indices_[i][k];
            const toile_joint& joint = joints[j];
            const Float3 at{joint.position[0], joint.position[1], joint.position[2]};
            p = p + weight * (rotate(joint.rotation, positions_[i] - joints_[j]) + at);
            n = n + weight * rotate(joint.rotation, normals_[i]);
        }
        const float length = std::sqrt(dot(n, n));
        normal = length > 0.0f ? 1.0f / length * n : normals_[i];
        const double wave = 0.5 - 0.5 * std::cos(8.0 * double{positions_[i][1]} - 2.0 * time_s);
        position = p + static_cast<float>(swell_m_ * wave) * normal;
    }

    sdk::ThreadPool pool_;
    double swell_m_ = 0.0;
    std::vector<Float3> positions_, normals_, joints_;
    std::vector<sdk::Index4> indices_;
    std::vector<sdk::Float4> weights_;
};

} // namespace

TOILE_PLUGIN(wave_skinning, WaveSkinning)
