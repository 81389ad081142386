#include "scan/moving_subject.h"

#include "core/error.h"

#include <algorithm>

namespace toile::scan {

MovingSubject::MovingSubject(IntakeCamera camera, const MovingSubjectOptions& options, RowLoop rows)
    : options_(options),
      intake_(std::move(camera), options.filter, options.choose_radius, std::move(rows)) {}

void MovingSubject::add(std::span<const float> depth, std::span<const Rgba8> color) {
    const auto number = static_cast<std::uint32_t>(intake_.fed());
    if (number % stride_ != 0) return intake_.pass();
    auto view = intake_.view(depth, color);
    if (!view) return;
    views_.push_back({number, std::move(*view)});
    if (views_.size() > options_.most_views) thin();
}

/// Every other one goes; the first stays.
void MovingSubject::thin() {
    stride_ *= 2;
    const std::uint32_t first = views_.front().number;
    std::erase_if(views_, [&](const NumberedView& v) {
        return v.number != first && v.number % stride_ != 0;
    });
}

void MovingSubject::guide(std::uint32_t instant, geometry::TriangleMesh body,
                          std::span<const std::uint8_t> labels) {
    if (guided() && body.triangles != shape_.triangles)
        throw Error("the body of frame " + std::to_string(instant) +
                    " has other triangles than that of the first");
    if (!labels.empty() && labels.size() != body.positions.size())
        throw Error("the body has " + std::to_string(body.positions.size()) + " vertices and " +
                    std::to_string(labels.size()) + " labels");
    if (intake_.camera().world_from_camera)
        move(intake_.camera().world_from_camera->inverse(), body);
    std::vector<Vec3f> places = body.positions;
    if (!guided() || instant < poses_.begin()->first) shape_ = std::move(body);
    labels_.assign(labels.begin(), labels.end());
    poses_[instant] = std::move(places);
}

void MovingSubject::check() const {
    if (intake_.fed() == 0) throw Error("no frame was fed");
    if (views_.empty())
        throw Error("nobody is in view in any of " + std::to_string(intake_.fed()) + " frames" +
                    (intake_.trouble().empty() ? "" : ": " + intake_.trouble()));
}

std::vector<NumberedView> MovingSubject::take_views() {
    // What was seen before the body was known has no place.
    if (guided())
        std::erase_if(views_,
                      [&](const NumberedView& v) { return v.number < poses_.begin()->first; });
    return std::move(views_);
}

} // namespace toile::scan
