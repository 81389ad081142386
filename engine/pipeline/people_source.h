// A sensor and a tracker together: pictures in, people out.
#pragma once

#include "abi/part_labels.h"
#include "body/track_file.h"
#include "pipeline/boundary_views.h"
#include "pipeline/frame_source.h"
#include "pipeline/sensor_source.h"
#include "pipeline/stage_clock.h"

#include <functional>
#include <map>
#include <memory>

namespace toile::pipeline {

/// A tracked person's own shape, kept by the reader.
struct PersonShape {
    std::uint64_t revision = 0;
    std::string model;                ///< id of the avatar in whose space the shape is, or empty
    std::vector<double> coefficients; ///< there
    body::Skeleton skeleton;          ///< at rest
    std::vector<Vec3f> rest;          ///< (nv)
    std::vector<Triangle> triangles;
    body::SkinWeights skin;
};

struct PeopleFrame {
    std::uint32_t sequence = 0;
    std::int64_t timestamp_ns = 0;
    double taken_s = 0.0;          ///< wall_seconds when the sensor gave it, before it was tracked
    std::vector<BodyFrame> people; ///< world, or the camera's frame when it has no place
    std::vector<std::uint64_t> shapes; ///< revision of each, of PeopleSource::shape; 0: none told
};

/// Which body part each pixel of a frame shows.
struct PartPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> parts;  ///< (width * height) body::Part
    std::vector<std::uint8_t> people; ///< (the same) n: the n-th of PeopleFrame::people; 0: nobody
};

/// How a tracker is wished to work.
struct TrackingWish {
    std::uint32_t most_people = 1;
    const BoundaryBody* body = nullptr; ///< people are given its bones; null: their own are found
    bool smoothing = true;
    /// Where the first camera stands, for a sensor that does not know it.
    std::optional<Eigen::Isometry3d> camera;
};

/// Not movable. The first camera's frames are used.
class PeopleSource {
  public:
    /// Among the body sources the tracker is the one that is fed frames and answers after each.
    /// \throw UsageError for a URI without a scheme, Error when it cannot be opened [worker]
    PeopleSource(const std::string& uri, host::Registry& registry, host::Services& services,
                 const toile_limits& limits, const TrackingWish& wish, host::Job& job);
    ~PeopleSource();
    PeopleSource(const PeopleSource&) = delete;
    PeopleSource& operator=(const PeopleSource&) = delete;

    /// True when there was a frame. \throw Error when sensor or tracker fails
    bool next(PeopleFrame& out);
    [[nodiscard]] bool ended() const { return sensor_->ended(0); }

    /// The first camera, where it stands as far as sensor or wish tell.
    [[nodiscard]] const SensorStream& stream() const { return stream_; }
    /// The pictures of the frame that `next` gave last.
    [[nodiscard]] const SensorFrame& pictures() const noexcept { return pictures_; }
    /// The same to keep: swapped for what was in `out`.
    void take_pictures(SensorFrame& out) noexcept { std::swap(out, pictures_); }
    /// Can the tracker tell parts?
    [[nodiscard]] bool tells_parts() const noexcept { return labels_ != nullptr; }
    /// Of the frame that `next` gave last, before its pictures are taken. \throw Error when the
    /// tracker cannot tell or fails
    void read_parts(PartPicture& out);
    /// A recording begins again; its frames are numbered and timed on, for the tracker too.
    /// \throw Error when it cannot be opened again [worker]
    void rewind();
    /// Timestamps are moved by so much from now on, as if the sensor's clock had been set.
    void shift_clock(std::int64_t by_ns) noexcept { shift_ns_ += by_ns; }
    /// \throw std::out_of_range for a revision that no frame told
    [[nodiscard]] const PersonShape& shape(std::uint64_t revision) const {
        return shapes_.at(revision);
    }
    /// CPU time of tracking a frame.
    [[nodiscard]] const DurationHistogram& tracking_time() const noexcept { return time_; }
    [[nodiscard]] const std::string& tracker_id() const noexcept { return tracker_->id(); }

  private:
    void read_people(PeopleFrame& out);
    void keep_shape(const toile_body& body);

    std::function<std::unique_ptr<SensorSource>()> open_;
    std::unique_ptr<SensorSource> sensor_;
    SensorStream stream_;
    std::unique_ptr<host::Instance> tracker_;
    const toile_body_source* table_ = nullptr;
    const toile_part_labels* labels_ = nullptr; ///< null: the tracker does not offer them
    SensorFrame pictures_;
    std::map<std::uint64_t, PersonShape> shapes_;
    std::vector<JointArray> joints_;
    std::vector<toile_person> people_;
    DurationHistogram time_;
    std::int64_t last_ns_ = 0;
    std::uint32_t last_sequence_ = 0;
    std::int64_t shift_ns_ = 0;
    std::uint32_t sequence_shift_ = 0;
};

} // namespace toile::pipeline
