#include "pipeline/dressed_person.h"

#include "core/error.h"
#include "garment/hidden.h"

#include <algorithm>
#include <cmath>

namespace toile::pipeline {

DressedPerson::DressedPerson(host::Registry& registry, host::Services& services,
                             std::shared_ptr<const BoundaryBody> body,
                             std::vector<std::shared_ptr<const BoundaryGarment>> garments,
                             const DressingOptions& options, host::Job& job)
    : body_(std::move(body)), options_(options),
      skinner_(registry.find(TOILE_SKINNING), services, *body_, options_.limits, job),
      before_(std::make_unique<PosedBody>(*body_)), after_(std::make_unique<PosedBody>(*body_)) {
    if (garments.size() > kMostGarments)
        throw Error("at most " + std::to_string(kMostGarments) +
                    " garments are worn together, not " + std::to_string(garments.size()) +
                    "; leave out " + garments[kMostGarments]->package().manifest.id);
    for (auto& garment : garments)
        garments_.emplace_back(registry.find(TOILE_GARMENT), services, *body_, std::move(garment),
                               options_.limits, job);
    skinner_.pose(*before_);
    skinner_.pose(*after_);
    if (!garments_.empty()) make_cloth_world(registry, services, job);
    order_layers();
    hide_covered();
}

DressedPerson::~DressedPerson() = default;

void DressedPerson::make_cloth_world(host::Registry& registry, host::Services& services,
                                     host::Job& job) {
    cloth_ = std::make_unique<host::Instance>(registry.find(TOILE_CLOTH), services);
    cloth_table_ = &cloth_->table<toile_cloth>();
    cloth_->activate(options_.limits);
    cloth_guard_ = std::make_unique<FrameGuard>(*cloth_, options_.limits);
    cloth_->call("set_body", [&](toile_instance* instance) {
        return cloth_table_->set_body(instance, &body_->abi(), job.handle());
    });
    for (WornGarment& garment : garments_) {
        const toile_cloth_garment description = garment.cloth_description();
        cloth_->call("add_garment", [&](toile_instance* instance) {
            return cloth_table_->add_garment(instance, &description, job.handle(), &garment.handle);
        });
        toile_garment_target target{};
        target.garment = garment.handle;
        target.positions = host::view_of(garment.targets);
        targets_.push_back(target);
        auto state = host::sized<toile_garment_state>();
        state.garment = garment.handle;
        state.positions = host::view_mut(garment.positions);
        state.normals = host::view_mut(garment.normals);
        states_.push_back(state);
    }
}

void DressedPerson::step_cloth(double dt_s) noexcept {
    auto step = host::sized<toile_cloth_step>();
    step.flags = reset_ ? TOILE_STEP_RESET : TOILE_STEP_NONE;
    step.body_before = reset_ ? &after_->state() : &before_->state();
    step.body_after = &after_->state();
    step.dt_s = dt_s;
    step.targets = targets_.data();
    step.states = states_.data();
    step.garment_count = static_cast<std::uint32_t>(states_.size());
    reset_ = false;
    const bool done = cloth_guard_->run(
        [&](toile_instance* instance) { return cloth_table_->step(instance, &step); },
        [&] {
            return std::all_of(states_.begin(), states_.end(), [](const toile_garment_state& s) {
                return host::view_finite(s.positions) && host::view_finite(s.normals);
            });
        });
    if (done) return;
    reset_ = true; // what the world holds may be as broken as what it gave
    for (WornGarment& garment : garments_) {
        std::copy(garment.targets.begin(), garment.targets.end(), garment.positions.begin());
        geometry::vertex_normals(garment.positions, garment.triangles(), garment.normals);
    }
}

void DressedPerson::advance(const JointArray& joints, double dt_s, StageClock& clock) noexcept {
    std::swap(before_, after_);
    after_->joints = joints;
    clock.begin(Stage::skinning);
    skinner_.pose(*after_);
    clock.end(Stage::skinning);
    if (garments_.empty()) return;

    clock.begin(Stage::targets);
    const auto skinning = body::skinning_transforms(body_->model().skeleton, transforms_of(joints));
    for (WornGarment& garment : garments_)
        garment.update_targets(after_->state(), skinning);
    clock.end(Stage::targets);

    clock.begin(Stage::cloth);
    step_cloth(dt_s);
    clock.end(Stage::cloth);
}

void DressedPerson::start(const BodyFrame& first, StageClock& clock) noexcept {
    const body::Skeleton& skeleton = body_->model().skeleton;
    const body::Pose goal = local_pose(transforms_of(first.joints));
    // The body turns and walks to its place before the motion starts: only the limbs move.
    body::Pose from = body::rest_pose(skeleton);
    from.hips_position.x() = goal.hips_position.x();
    from.hips_position.z() = goal.hips_position.z();
    const Vec3f facing = goal.rotations[0] * Vec3f::UnitZ();
    from.rotations[0] =
        Quatf(Eigen::AngleAxisf(std::atan2(facing.x(), facing.z()), Vec3f::UnitY()));

    constexpr double kStep = 1.0 / 30.0;
    const auto moving = static_cast<int>(std::ceil(options_.start_motion_s / kStep));
    const auto settling = static_cast<int>(std::ceil(options_.start_settle_s / kStep));
    reset_ = true;
    const auto pose_at = [&](float share) {
        return joints_of(body::forward_kinematics(skeleton, interpolate(from, goal, share)), 1.0f);
    };
    advance(pose_at(0.0f), kStep, clock);
    for (int i = 1; i <= moving; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(moving);
        advance(pose_at(t * t * (3.0f - 2.0f * t)), kStep, clock);
    }
    for (int i = 0; i < settling; ++i) {
        before_->set_frame(first);
        advance(first.joints, kStep, clock);
    }
    show();
}

void DressedPerson::order_layers() {
    for (std::size_t outer = 1; outer < garments_.size(); ++outer)
        for (std::size_t inner = 0; inner < outer; ++inner)
            overlaps_.push_back(
                {inner, outer,
                 garment::LayerOffset({garments_[inner].bound, garments_[inner].triangles()},
                                      {garments_[outer].bound, garments_[outer].triangles()})});
}

void DressedPerson::hide_covered() {
    if (garments_.size() < 2) return;
    show();
    std::vector<Vec3f> normals;
    for (std::size_t i = 0; i + 1 < garments_.size(); ++i) {
        std::vector<garment::ClothSurface> over;
        for (std::size_t j = i + 1; j < garments_.size(); ++j)
            if (!garments_[j].see_through())
                over.push_back({garments_[j].shown, garments_[j].triangles()});
        WornGarment& inner = garments_[i];
        normals.assign(inner.shown.size(), Vec3f::UnitY());
        geometry::vertex_normals(inner.shown, inner.triangles(), normals);
        inner.hidden =
            garment::hidden_triangles({inner.shown, inner.triangles()}, normals, over,
                                      {after_->positions, body_->model().rest.triangles});
    }
}

void DressedPerson::show() noexcept {
    constexpr float kGap_m = 0.005f;
    for (WornGarment& garment : garments_)
        garment.begin_showing();
    for (Overlap& overlap : overlaps_) {
        const WornGarment& inner = garments_[overlap.inner];
        overlap.offset.apply(inner.shown, inner.normals, kGap_m, garments_[overlap.outer].shown);
    }
    for (WornGarment& garment : garments_)
        garment.update_surfaces();
}

void DressedPerson::step(const BodyFrame& frame, double dt_s, StageClock& clock) noexcept {
    const auto wanted = static_cast<std::uint32_t>(std::ceil(dt_s / options_.longest_step_s));
    const std::uint32_t steps = std::clamp(wanted, 1u, options_.most_steps);
    const double step_s = std::min(dt_s / steps, options_.longest_step_s);
    if (steps > 1) {
        const body::Pose from = local_pose(transforms_of(after_->joints));
        const body::Pose to = local_pose(transforms_of(frame.joints));
        for (std::uint32_t i = 1; i < steps; ++i) {
            const float share = static_cast<float>(i) / static_cast<float>(steps);
            const auto world =
                body::forward_kinematics(body_->model().skeleton, interpolate(from, to, share));
            advance(joints_of(world, 1.0f), step_s, clock);
        }
    }
    before_->set_frame(frame); // becomes `after_`
    advance(frame.joints, step_s, clock);
    clock.begin(Stage::surfaces);
    show();
    clock.end(Stage::surfaces);
}

std::vector<std::string> DressedPerson::faults() {
    std::vector<std::string> out;
    const auto add = [&](std::string fault) {
        if (!fault.empty()) out.push_back(std::move(fault));
    };
    add(skinner_.fault());
    for (WornGarment& garment : garments_)
        add(garment.fault());
    if (cloth_guard_) add(cloth_guard_->fault());
    return out;
}

} // namespace toile::pipeline
