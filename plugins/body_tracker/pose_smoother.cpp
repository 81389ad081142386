#include "body_tracker/pose_smoother.h"

namespace toile::body_tracker {

const body::Pose& PoseSmoother::update(const body::Pose& pose, float dt) noexcept {
    if (!started_ || !options_.on || dt <= 0.0f) {
        last_ = smooth_ = pose;
        speed_.setZero();
        turning_.fill(Vec3f::Zero());
        started_ = true;
        return smooth_;
    }
    const float speed_share = body::approach(dt, 1.0f / (2.0f * body::kPi * options_.speed_hz));
    const auto share_at = [&](float cutoff) {
        return body::approach(dt, 1.0f / (2.0f * body::kPi * cutoff));
    };
    speed_ += speed_share * ((pose.hips_position - last_.hips_position) / dt - speed_);
    smooth_.hips_position += share_at(options_.minimum_hz + options_.slope_hz * speed_.norm()) *
                             (pose.hips_position - smooth_.hips_position);
    for (std::size_t j = 0; j < body::kJointCount; ++j) {
        const Quatf& now = pose.rotations[j];
        const Vec3f turned = body::rotation_vector(now * last_.rotations[j].conjugate()) / dt;
        turning_[j] += speed_share * (turned - turning_[j]);
        const float cutoff = options_.minimum_hz + options_.turn_slope_hz * turning_[j].norm();
        smooth_.rotations[j] = smooth_.rotations[j].slerp(share_at(cutoff), now).normalized();
    }
    last_ = pose;
    return smooth_;
}

} // namespace toile::body_tracker
