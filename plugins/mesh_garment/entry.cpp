// Kind toile.garment/1 over binder.h.
#include "mesh_garment/binder.h"
#include "sdk/garment.h"
#include "sdk/plugin.h"
#include "sdk/views.h"

#include <cstdio>
#include <memory>

namespace {

namespace sdk = toile::sdk;
using toile::Vec3f;

std::vector<Vec3f> vectors(const toile_view& view, const char* name) {
    const auto rows = sdk::span_of<sdk::Float3>(view, name);
    std::vector<Vec3f> out(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        out[i] = Vec3f(rows[i][0], rows[i][1], rows[i][2]);
    return out;
}

/// A body's arrays copied from the boundary, with its surface.
struct Body {
    std::vector<Vec3f> positions;
    std::vector<toile::Triangle> triangles;
    std::vector<std::array<std::uint16_t, 4>> indices;
    std::vector<std::array<float, 4>> weights;
    std::array<Vec3f, toile::body::kJointCount> joints;
    std::unique_ptr<toile::mesh_garment::BodySurface> surface;

    explicit Body(const toile_body& body) : positions(vectors(body.rest.positions, "body.rest")) {
        const std::size_t nv = positions.size();
        const auto t = sdk::span_of<sdk::Triangle>(body.rest.triangles, "body.rest.triangles");
        triangles.assign(t.begin(), t.end());
        const auto i = sdk::span_of<sdk::Index4>(body.joint_indices, "body.joint_indices", nv);
        indices.assign(i.begin(), i.end());
        const auto w = sdk::span_of<sdk::Float4>(body.joint_weights, "body.joint_weights", nv);
        weights.assign(w.begin(), w.end());
        const auto j =
            sdk::span_of<sdk::Float3>(body.rest_joints, "body.rest_joints", TOILE_JOINT_COUNT);
        for (std::size_t k = 0; k < j.size(); ++k)
            joints[k] = Vec3f(j[k][0], j[k][1], j[k][2]);
        check();
        surface = std::make_unique<toile::mesh_garment::BodySurface>(
            toile::mesh_garment::BodyView{positions, triangles, indices, weights, joints});
    }

  private:
    void check() const {
        const auto report = toile::geometry::check_topology(positions, triangles);
        if (triangles.empty() || !report.usable())
            throw sdk::bad_argument("body.rest: " +
                                    (triangles.empty() ? "no triangles" : report.text()));
        for (const auto& row : indices)
            for (const std::uint16_t joint : row)
                if (joint >= TOILE_JOINT_COUNT)
                    throw sdk::bad_argument("body.joint_indices: no joint " +
                                            std::to_string(joint));
    }
};

class MeshGarment {
  public:
    static constexpr sdk::Info info{.id = "toile.mesh_garment",
                                    .name = "Garment meshes bound to bodies",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Garment>;

    explicit MeshGarment(sdk::Host host) : host_(host) {}

    void bind(const toile_body& body, const toile_garment_package& package, sdk::Job job,
              const toile_garment_binding& out) {
        const Body target(body);
        std::unique_ptr<const Body> source;
        if (package.made_on != nullptr && package.made_on->revision != body.revision)
            source = std::make_unique<Body>(sdk::read_struct(package.made_on, "package.made_on"));
        const auto positions = vectors(package.simulation.positions, "package.simulation");
        const std::size_t nv = positions.size();
        const auto triangles =
            sdk::span_of<sdk::Triangle>(package.simulation.triangles, "package.triangles");
        toile::mesh_garment::GarmentView garment;
        garment.positions = positions;
        garment.triangles = triangles;
        if (package.joint_indices.count != 0) {
            garment.joint_indices =
                sdk::span_of<sdk::Index4>(package.joint_indices, "package.joint_indices", nv);
            garment.joint_weights =
                sdk::span_of<sdk::Float4>(package.joint_weights, "package.joint_weights", nv);
        }
        garment.pins = sdk::span_of<float>(package.pins, "package.pins");
        garment.ease_m = package.ease_m;
        auto binding = toile::mesh_garment::bind(
            *target.surface, source ? source->surface.get() : nullptr, garment,
            [&job](double fraction, const char* stage) { job.progress(fraction, stage); });
        report(package, binding.clearance);
        write(binding, out);
        targets_ = std::make_unique<toile::mesh_garment::Targets>(binding, target.joints);
        revision_ = body.revision;
    }

    void targets(const toile_body_state& state, toile_view_mut positions) {
        if (!targets_) throw sdk::bad_argument("targets: called before bind");
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
        const auto rows =
            sdk::span_of<sdk::Float3>(positions, "positions", targets_->vertex_count());
        targets_->evaluate(world, {rows.front().data(), sizeof(sdk::Float3)});
    }

  private:
    void report(const toile_garment_package& package,
                const toile::mesh_garment::ClearanceReport& clearance) const {
        if (clearance.short_of_ease == 0) return;
        std::array<char, 160> text{};
        std::snprintf(text.data(), text.size(),
                      ": %zu vertices and triangle centres keep less than the ease of %.1f mm, the "
                      "nearest %.1f mm",
                      clearance.short_of_ease, 1000.0 * static_cast<double>(package.ease_m),
                      1000.0 * static_cast<double>(clearance.least_m));
        host_.warning("garment '" + std::string(package.id) + "'" + text.data());
    }

    static void write(const toile::mesh_garment::Binding& binding,
                      const toile_garment_binding& out) {
        const std::size_t nv = binding.positions.size();
        const auto positions = sdk::span_of<sdk::Float3>(out.positions, "out.positions", nv);
        const auto indices = sdk::span_of<sdk::Index4>(out.joint_indices, "out.joint_indices", nv);
        const auto weights = sdk::span_of<sdk::Float4>(out.joint_weights, "out.joint_weights", nv);
        const auto attachment = sdk::span_of<float>(out.attachment, "out.attachment", nv);
        for (std::size_t v = 0; v < nv; ++v) {
            const Vec3f& p = binding.positions[v];
            positions[v] = {p.x(), p.y(), p.z()};
            indices[v] = binding.skin.joints[v];
            weights[v] = binding.skin.weights[v];
            attachment[v] = binding.attachment[v];
        }
    }

    sdk::Host host_;
    std::unique_ptr<toile::mesh_garment::Targets> targets_;
    std::uint64_t revision_ = 0;
};

} // namespace

TOILE_PLUGIN(mesh_garment, MeshGarment)
