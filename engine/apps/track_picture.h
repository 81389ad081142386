// What tracking saw, for people to look at: the sensor's picture with bodies and bones over it.
#pragma once

#include "imaging/image.h"
#include "pipeline/people_source.h"

#include <map>
#include <memory>

namespace toile::body {
class SkinnedSurface;
}

namespace toile::apps {

/// Left the colour picture (or depth, when there is no colour), right depth with the tracked bodies
/// in one colour a person; bones on both, thin where confidence is low.
class TrackPicture {
  public:
    explicit TrackPicture(const pipeline::PeopleSource& source);
    ~TrackPicture();
    TrackPicture(const TrackPicture&) = delete;
    TrackPicture& operator=(const TrackPicture&) = delete;

    [[nodiscard]] const imaging::Image& draw(const pipeline::PeopleFrame& frame);

  private:
    struct Posed;
    void draw_background(const pipeline::SensorFrame& pictures);
    void draw_body(const pipeline::BodyFrame& person, std::uint64_t shape);
    void draw_bones(const pipeline::BodyFrame& person);
    void dot(int x, int y, const Vec3f& color, float share);
    void line(const Vec2f& from, const Vec2f& to, const Vec3f& color, int half);
    [[nodiscard]] std::optional<Vec3f> pixel_of(const Vec3f& world) const;

    const pipeline::PeopleSource& source_;
    Eigen::Isometry3d camera_from_world_ = Eigen::Isometry3d::Identity();
    std::map<std::uint64_t, std::unique_ptr<Posed>> posed_;
    imaging::Image image_;
};

} // namespace toile::apps
