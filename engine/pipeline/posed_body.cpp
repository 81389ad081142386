#include "pipeline/posed_body.h"

namespace toile::pipeline {

PosedBody::PosedBody(const BoundaryBody& body) {
    const std::size_t count = body.model().rest.positions.size();
    joints = rest_joints(body.model().skeleton);
    positions = body.model().rest.positions;
    normals.assign(count, Vec3f::UnitY());
    state_.size = sizeof(state_);
    state_.person_id = 1;
    state_.tracking = TOILE_TRACKING_TRACKED;
    state_.body_revision = body.abi().revision;
    state_.joints = host::view_of(joints);
    state_.positions = host::view_of(positions);
    state_.normals = host::view_of(normals);
}

void PosedBody::set_frame(const BodyFrame& frame) noexcept {
    joints = frame.joints;
    state_.person_id = frame.person_id;
    state_.tracking = frame.tracking;
    state_.sequence = frame.sequence;
    state_.timestamp_ns = frame.timestamp_ns;
}

BodySkinner::BodySkinner(std::shared_ptr<const host::Plugin> plugin, host::Services& services,
                         const BoundaryBody& body, const toile_limits& limits, host::Job& job)
    : body_(body), instance_(std::move(plugin), services),
      table_(instance_.table<toile_skinning>()), guard_(instance_, limits),
      fallback_(body.model().rest.positions, body.model().rest.normals, body.model().skin.joints,
                body.model().skin.weights) {
    instance_.activate(limits);
    instance_.call("bind", [&](toile_instance* instance) {
        return table_.bind(instance, &body_.abi(), job.handle());
    });
}

void BodySkinner::pose(PosedBody& body) noexcept {
    const toile_view_mut positions = host::view_mut(body.positions);
    const toile_view_mut normals = host::view_mut(body.normals);
    const bool done = guard_.run(
        [&](toile_instance* instance) {
            return table_.pose(instance, &body.state(), positions, normals);
        },
        [&] { return host::view_finite(positions) && host::view_finite(normals); });
    if (done) return;
    const auto skinning =
        body::skinning_transforms(body_.model().skeleton, transforms_of(body.joints));
    fallback_.pose(skinning, body::SkinningMethod::linear_blend,
                   body::VectorRows(std::span(body.positions)),
                   body::VectorRows(std::span(body.normals)));
}

} // namespace toile::pipeline
