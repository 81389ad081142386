#include "apps/kiosk/picture_scale.h"

#include <algorithm>

namespace toile::apps::kiosk {
namespace {

constexpr float kStep = 0.8f;
constexpr double kRoom = 0.55; // of the budget: a step up costs 1.56 times as many pixels

} // namespace

float PictureScale::add(double frame_s) {
    over_ = frame_s > options_.budget_s ? over_ + 1 : 0;
    under_ = frame_s < kRoom * options_.budget_s ? under_ + 1 : 0;
    if (over_ >= options_.after) {
        now_ = std::max(options_.least, now_ * kStep);
        over_ = 0;
    } else if (under_ >= options_.calm) {
        now_ = std::min(most_, now_ / kStep);
        under_ = 0;
    }
    return now_;
}

} // namespace toile::apps::kiosk
