#include "apps/track_picture.h"

#include "body/skinning.h"

#include <algorithm>
#include <cmath>

namespace toile::apps {
namespace {

/// Told apart by people who cannot tell red from green (Okabe and Ito 2008).
const std::array<Vec3f, 6> kColors{Vec3f(0.90f, 0.62f, 0.0f), Vec3f(0.34f, 0.71f, 0.91f),
                                   Vec3f(0.0f, 0.62f, 0.45f), Vec3f(0.94f, 0.89f, 0.26f),
                                   Vec3f(0.84f, 0.37f, 0.0f), Vec3f(0.80f, 0.47f, 0.65f)};
constexpr float kNear = 1.0f, kFar = 5.0f; // metres from white to black
constexpr float kSure = 0.5f;              // confidence of a bone that is drawn thick

Vec3f color_of(std::uint32_t person) {
    return kColors[(person + kColors.size() - 1) % kColors.size()];
}

} // namespace

struct TrackPicture::Posed {
    explicit Posed(const pipeline::PersonShape& shape)
        : skeleton(shape.skeleton), surface(shape.rest, {}, shape.skin.joints, shape.skin.weights),
          positions(shape.rest.size()), normals(shape.rest.size()) {}
    body::Skeleton skeleton;
    body::SkinnedSurface surface;
    std::vector<Vec3f> positions, normals;
};

TrackPicture::TrackPicture(const pipeline::PeopleSource& source) : source_(source) {
    const pipeline::SensorStream& stream = source.stream();
    if (stream.world_from_camera) camera_from_world_ = stream.world_from_camera->inverse();
    image_.width = 2 * stream.depth.width;
    image_.height = stream.depth.height;
    image_.pixels.resize(static_cast<std::size_t>(image_.width) *
                         static_cast<std::size_t>(image_.height) * 4);
}

TrackPicture::~TrackPicture() = default;

std::optional<Vec3f> TrackPicture::pixel_of(const Vec3f& world) const {
    const Vec3d p = camera_from_world_ * world.cast<double>();
    const auto pixel = imaging::project(source_.stream().depth, p);
    if (!pixel || pixel->cwiseAbs().maxCoeff() > 1e5) return std::nullopt;
    return Vec3f(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()),
                 static_cast<float>(-p.z()));
}

void TrackPicture::dot(int x, int y, const Vec3f& color, float share) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
    std::uint8_t* p = image_.pixels.data() + 4 * (static_cast<std::size_t>(y) * image_.width + x);
    for (int k = 0; k < 3; ++k)
        p[k] = static_cast<std::uint8_t>(
            std::clamp((1.0f - share) * p[k] + share * 255.0f * color[k], 0.0f, 255.0f));
}

void TrackPicture::draw_background(const pipeline::SensorFrame& pictures) {
    const int w = image_.width / 2;
    for (int y = 0; y < image_.height; ++y)
        for (int x = 0; x < w; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * w + x;
            const float d = pictures.depth.metres[i];
            const float shade =
                d > 0.0f ? std::clamp((kFar - d) / (kFar - kNear), 0.08f, 1.0f) : 0.0f;
            std::uint8_t* left =
                image_.pixels.data() + 4 * (static_cast<std::size_t>(y) * image_.width + x);
            std::uint8_t* right = left + 4 * static_cast<std::size_t>(w);
            for (int k = 0; k < 3; ++k)
                left[k] = right[k] = static_cast<std::uint8_t>(200.0f * shade);
            if (!pictures.color.empty()) std::copy_n(pictures.color.pixels.data() + 4 * i, 3, left);
            left[3] = right[3] = 255;
        }
}

void TrackPicture::draw_body(const pipeline::BodyFrame& person, std::uint64_t shape) {
    if (shape == 0) return;
    auto& posed = posed_[shape];
    if (!posed) {
        if (posed_.size() > 16) posed_.clear();
        posed_[shape] = std::make_unique<Posed>(source_.shape(shape));
        draw_body(person, shape);
        return;
    }
    const auto world = pipeline::transforms_of(person.joints);
    posed->surface.pose(body::skinning_transforms(posed->skeleton, world),
                        body::SkinningMethod::dual_quaternion,
                        body::VectorRows(std::span(posed->positions)), body::VectorRows());
    const auto& depth = source_.pictures().depth;
    const int w = image_.width / 2;
    for (const Vec3f& p : posed->positions) {
        const auto at = pixel_of(p);
        if (!at) continue;
        const int x = static_cast<int>(std::lround(at->x())),
                  y = static_cast<int>(std::lround(at->y()));
        if (x < 0 || y < 0 || x >= w || y >= image_.height) continue;
        // What lies far behind the reading is the body's other side, or hidden.
        const float real = depth.metres[static_cast<std::size_t>(y) * w + x];
        if (real > 0.0f && at->z() > real + 0.1f) continue;
        for (int k = 0; k < 4; ++k)
            dot(w + x + k % 2, y + k / 2, color_of(person.person_id), 0.45f);
    }
}

void TrackPicture::line(const Vec2f& from, const Vec2f& to, const Vec3f& color, int half) {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from).cwiseAbs().maxCoeff())));
    if (steps > 8192) return;
    for (int s = 0; s <= steps; ++s) {
        const Vec2f at = from + (to - from) * (static_cast<float>(s) / static_cast<float>(steps));
        for (int dy = -half; dy <= half; ++dy)
            for (int dx = -half; dx <= half; ++dx)
                dot(static_cast<int>(std::lround(at.x())) + dx,
                    static_cast<int>(std::lround(at.y())) + dy, color, 0.9f);
    }
}

void TrackPicture::draw_bones(const pipeline::BodyFrame& person) {
    const int w = image_.width / 2;
    for (std::size_t j = 1; j < body::kJointCount; ++j) {
        const auto parent =
            static_cast<std::size_t>(*body::joint_parent(static_cast<body::Joint>(j)));
        const auto place = [&](std::size_t joint) {
            const float* p = person.joints[joint].position;
            return pixel_of(Vec3f(p[0], p[1], p[2]));
        };
        const auto from = place(parent), to = place(j);
        if (!from || !to) continue;
        const int half = person.joints[parent].confidence >= kSure ? 1 : 0;
        for (const int side : {0, w}) {
            const Vec2f shift(static_cast<float>(side), 0.0f);
            line(from->head<2>() + shift, to->head<2>() + shift,
                 side == 0 ? color_of(person.person_id) : Vec3f::Ones(), half);
        }
    }
}

const imaging::Image& TrackPicture::draw(const pipeline::PeopleFrame& frame) {
    draw_background(source_.pictures());
    for (std::size_t i = 0; i < frame.people.size(); ++i) {
        if (frame.people[i].tracking == TOILE_TRACKING_LOST) continue;
        draw_body(frame.people[i], frame.shapes[i]);
        draw_bones(frame.people[i]);
    }
    return image_;
}

} // namespace toile::apps
