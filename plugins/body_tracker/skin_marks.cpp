#include "body_tracker/skin_marks.h"

#include "body/rotations.h"

#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

using body::Joint;
using body::kJointCount;

constexpr int kReach = 4;                                   // pixels to each side that are searched
constexpr float kSpacing = 0.006f;                          // metres between samples
constexpr float kFacingToTake = 0.6f, kFacingToSeek = 0.4f; // cosine to the line of sight
constexpr float kSameDepth = 0.04f;                         // metres
constexpr float kLeastContrast = 0.04f; // deviation over mean of a look worth keeping
constexpr float kThickest = 0.12f, kThinnest = 0.025f; // metres, of limbs
constexpr float kSharp = 0.03f;     // likeness lost a squared pixel beside a well-marked place
constexpr float kSkinLags = 0.25f;  // share of a bone whose skin stays behind when it rolls
constexpr float kLengthwise = 0.3f; // weight along a bone of what has all across it
constexpr int kMissedTooOften = 10;
constexpr int kSettle = 3; // rows and columns of the coarse search are so far apart at most

struct Limb {
    Joint joint, child;
    bool upper;
    Joint end; ///< of an upper limb: where the lower one ends
};
/// Arms. Legs turn little about their bones, and depth has that right to 7 degrees: marks there
/// only kept its first error (docs/tracking.md).
constexpr std::array<Limb, 4> kLimbs{
    {{Joint::left_upper_arm, Joint::left_lower_arm, true, Joint::left_hand},
     {Joint::right_upper_arm, Joint::right_lower_arm, true, Joint::right_hand},
     {Joint::left_lower_arm, Joint::left_hand, false, Joint::left_hand},
     {Joint::right_lower_arm, Joint::right_hand, false, Joint::right_hand}}};
constexpr float kLeastBend = 0.02f;

std::size_t leader_of(const body::FitLevel& level, std::size_t vertex) {
    std::array<float, kJointCount> weight{};
    for (std::size_t k = 0; k < 4; ++k)
        weight[level.skin.joints[vertex][k]] += level.skin.weights[vertex][k];
    return static_cast<std::size_t>(std::max_element(weight.begin(), weight.end()) -
                                    weight.begin());
}

/// How well depth tells the roll of a limb: by the plane of a bent elbow or knee; 0 to 1.
float bend_of(const body::JointTransforms& joints, const Limb& limb) noexcept {
    // Of an upper limb the bone after it, of a lower one that before.
    const Joint first = limb.upper ? limb.joint : *body::joint_parent(limb.joint);
    const Joint middle = limb.upper ? limb.child : limb.joint;
    const auto place = [&](Joint joint) -> const Vec3f& {
        return joints[static_cast<std::size_t>(joint)].translation;
    };
    const Vec3f one = (place(middle) - place(first)).normalized();
    const Vec3f other = (place(limb.upper ? limb.end : limb.child) - place(middle)).normalized();
    return std::max(kLeastBend, one.cross(other).squaredNorm());
}

std::optional<Vec2f> pixel_of(const imaging::Intrinsics& camera, const Vec3f& point) noexcept {
    const auto pixel = imaging::project(camera, point.cast<double>());
    if (!pixel) return std::nullopt;
    return Vec2f(pixel->cast<float>());
}

} // namespace

SkinMarks::SkinMarks(const TrackedBody& body, const MarkOptions& options)
    : body_(body), options_(options), posed_(body.blank()) {
    const auto& rest = body.skeleton().rest_positions;
    for (std::uint32_t v = 0; v < posed_.positions.size(); ++v) {
        const std::size_t leader = leader_of(body.level(), v);
        for (const Limb& limb : kLimbs) {
            if (static_cast<std::size_t>(limb.joint) != leader) continue;
            const Vec3f& from = rest[static_cast<std::size_t>(limb.joint)];
            const Vec3f bone = rest[static_cast<std::size_t>(limb.child)] - from;
            const float along = (body.level().mean[v] - from).dot(bone) / bone.squaredNorm();
            if (along < kSkinLags) continue;
            Mark& mark = marks_.emplace_back();
            mark.vertex = v;
            mark.joint = static_cast<std::uint8_t>(limb.joint);
            mark.child = static_cast<std::uint8_t>(limb.child);
        }
    }
    pulls_.reserve(marks_.size());
    pulled_.reserve(marks_.size());
}

void SkinMarks::reset() noexcept {
    for (Mark& mark : marks_)
        mark.known = mark.found = false;
    pulls_.clear();
    pulled_.clear();
}

/// False where the mark is not to be seen. A limb is round about its bone.
bool SkinMarks::frame_of(const SeenPerson& seen, const Mark& mark, Frame& out) const noexcept {
    const Vec3f& corner = posed_.positions[mark.vertex];
    out.at = corner + posed_.rotations[mark.vertex] * mark.offset;
    out.normal = posed_.normals[mark.vertex];
    out.facing = -out.normal.dot(out.at) / out.at.norm();
    if (out.facing < kFacingToSeek || -out.at.z() < 0.3f) return false;
    const Vec2f cell = seen.grid.camera.cell(out.at);
    const auto x = static_cast<int>(std::lround(cell.x()));
    const auto y = static_cast<int>(std::lround(cell.y()));
    if (x < 0 || y < 0 || x >= seen.grid.camera.width || y >= seen.grid.camera.height) return false;
    const auto i = static_cast<std::size_t>(y * seen.grid.camera.width + x);
    if (seen.mask.cells[i] == 0 || std::abs(seen.grid.depth[i] + out.at.z()) > kSameDepth)
        return false;
    const Vec3f& from = posed_.joints[mark.joint].translation;
    const Vec3f bone = (posed_.joints[mark.child].translation - from).normalized();
    Vec3f along = bone - bone.dot(out.normal) * out.normal;
    if (along.squaredNorm() < 0.1f) return false;
    along.normalize();
    const Vec3f across = out.normal.cross(along);
    const Vec3f off = out.at - from;
    const float radius = std::clamp((off - off.dot(bone) * bone).norm(), kThinnest, kThickest);
    const imaging::Intrinsics& camera = seen.picture->camera();
    constexpr float kHalf = 4.0f * kSpacing;
    const Vec3f down = kHalf * kHalf / (2.0f * radius) * out.normal;
    const auto middle = pixel_of(camera, out.at);
    const auto up = pixel_of(camera, out.at + kHalf * along);
    const auto left = pixel_of(camera, out.at + kHalf * across - down);
    const auto right = pixel_of(camera, out.at - kHalf * across - down);
    if (!middle || !up || !left || !right) return false;
    out.middle = *middle;
    out.a = (*up - *middle) / 4.0f;
    out.b = (*left - *right) / 8.0f;
    out.c = (*left + *right - 2.0f * *middle) / 32.0f;
    return true;
}

/// False when a sample, or one `margin` pixels beside, lies outside of what is known.
bool SkinMarks::place_samples(const GreyPicture& picture, const Frame& frame, int margin) noexcept {
    const std::array<int, 2>& low = picture.low();
    const std::array<int, 2>& high = picture.high();
    std::size_t n = 0;
    for (int u = -kSide / 2; u <= kSide / 2; ++u)
        for (int v = -kSide / 2; v <= kSide / 2; ++v, ++n) {
            const auto fu = static_cast<float>(u), fv = static_cast<float>(v);
            const Vec2f p = frame.middle + fu * frame.a + fv * frame.b + fv * fv * frame.c;
            const auto x = static_cast<int>(std::floor(p.x()));
            const auto y = static_cast<int>(std::floor(p.y()));
            if (x - margin < low[0] || y - margin < low[1] || x + 1 + margin > high[0] ||
                y + 1 + margin > high[1])
                return false;
            const float fx = p.x() - static_cast<float>(x), fy = p.y() - static_cast<float>(y);
            base_[n] = y * picture.width() + x;
            corner_[n] = {(1.0f - fx) * (1.0f - fy), fx * (1.0f - fy), (1.0f - fx) * fy, fx * fy};
        }
    return true;
}

/// Brightness of the samples; the sum.
float SkinMarks::sample(const GreyPicture& picture, int dx, int dy,
                        std::array<float, kSamples>& out) const noexcept {
    const std::uint16_t* values = picture.values() + dy * picture.width() + dx;
    const int w = picture.width();
    float sum = 0.0f;
    for (std::size_t n = 0; n < out.size(); ++n) {
        const std::uint16_t* p = values + base_[n];
        const std::array<float, 4>& k = corner_[n];
        out[n] = k[0] * p[0] + k[1] * p[1] + k[2] * p[w] + k[3] * p[w + 1];
        sum += out[n];
    }
    return sum;
}

/// Every second pixel first, then all around the best; between pixels by a parabola.
SkinMarks::Peak SkinMarks::search(const GreyPicture& picture, const Mark& mark) noexcept {
    constexpr int kWidth = 2 * kReach + 3; // and a border that stays unknown
    constexpr float kUnknown = -2.0f;
    std::array<float, static_cast<std::size_t>(kWidth * kWidth)> map{};
    map.fill(kUnknown);
    const auto at = [&](int dx, int dy) -> float& {
        return map[static_cast<std::size_t>((dy + kReach + 1) * kWidth + dx + kReach + 1)];
    };
    const auto rate = [&](int dx, int dy) {
        float& known = at(dx, dy);
        if (known != kUnknown) return known;
        std::array<float, kSamples> seen;
        const float mean = sample(picture, dx, dy, seen) / static_cast<float>(kSamples);
        float with = 0.0f, squares = 0.0f;
        for (std::size_t n = 0; n < seen.size(); ++n) {
            const float off = seen[n] - mean;
            with += mark.look[n] * off;
            squares += off * off;
        }
        return known = with / std::sqrt(std::max(squares, 1e-6f));
    };
    int x = 0, y = 0;
    for (int dy = -kReach; dy <= kReach; dy += 2)
        for (int dx = -kReach; dx <= kReach; dx += 2)
            if (rate(dx, dy) > at(x, y)) x = dx, y = dy;
    for (int round = 0; round < kSettle; ++round) {
        const int bx = x, by = y;
        for (int dy = std::max(-kReach, by - 1); dy <= std::min(kReach, by + 1); ++dy)
            for (int dx = std::max(-kReach, bx - 1); dx <= std::min(kReach, bx + 1); ++dx)
                if (rate(dx, dy) > at(x, y)) x = dx, y = dy;
        if (x == bx && y == by) break;
    }
    Peak out;
    // A peak at the rim is none.
    if (std::abs(x) >= kReach || std::abs(y) >= kReach) return out;
    const float best = rate(x, y);
    const float xx = 2.0f * best - rate(x - 1, y) - rate(x + 1, y);
    const float yy = 2.0f * best - rate(x, y - 1) - rate(x, y + 1);
    const float xy =
        0.25f * (rate(x + 1, y - 1) + rate(x - 1, y + 1) - rate(x + 1, y + 1) - rate(x - 1, y - 1));
    out.sharpness << xx, xy, xy, yy;
    const Vec2f slope(0.5f * (rate(x + 1, y) - rate(x - 1, y)),
                      0.5f * (rate(x, y + 1) - rate(x, y - 1)));
    out.shift = Vec2f(static_cast<float>(x), static_cast<float>(y));
    const float determinant = xx * yy - xy * xy;
    if (determinant > 0.05f * kSharp * kSharp) {
        const Vec2f more =
            Vec2f(yy * slope.x() - xy * slope.y(), xx * slope.y() - xy * slope.x()) / determinant;
        if (more.cwiseAbs().maxCoeff() < 1.0f) out.shift += more;
    }
    out.likeness = best;
    return out;
}

/// A place must come to lie on the line of sight where its look was found: two directions across
/// it, each counted as far as the look tells it (a stripe tells one only).
void SkinMarks::pull(const GreyPicture& picture, const Mark& mark, const Frame& frame,
                     const Peak& peak) noexcept {
    const float xx = peak.sharpness(0, 0), yy = peak.sharpness(1, 1), xy = peak.sharpness(0, 1);
    const float angle = 0.5f * std::atan2(2.0f * xy, xx - yy);
    const std::array<Vec2f, 2> ways{Vec2f(std::cos(angle), std::sin(angle)),
                                    Vec2f(-std::sin(angle), std::cos(angle))};
    const Vec2f pixel = frame.middle + peak.shift;
    const auto ray = imaging::unproject(picture.camera(), pixel.cast<double>(), 1.0);
    if (!ray) return;
    SkinPull out{mark.vertex, mark.offset, {}, {}, options_.robust_m};
    const float sure = std::min(1.0f, (peak.likeness - options_.least_likeness) / 0.2f);
    const float information = options_.weight * options_.information * sure /
                              (options_.deviation_m * options_.deviation_m);
    const Vec3f sight = ray->cast<float>();
    for (std::size_t k = 0; k < 2; ++k) {
        const Vec3f way(ways[k].x(), -ways[k].y(), 0.0f); // rows go down
        const Vec3f across = way - way.dot(sight) / sight.squaredNorm() * sight;
        out.along[k] = across.normalized();
        const float sharp = ways[k].dot(peak.sharpness * ways[k]);
        out.weight[k] = information * std::clamp(sharp / kSharp, 0.0f, 1.0f);
        // Depth tells better how a limb lies along its bone.
        const float lengthwise = ways[k].dot(frame.a.normalized());
        out.weight[k] *= 1.0f + lengthwise * lengthwise * (kLengthwise - 1.0f);
    }
    pulls_.push_back(out);
}

void SkinMarks::find(const SeenPerson& seen, const body::Pose& pose) noexcept {
    pulls_.clear();
    pulled_.clear();
    counts_ = {};
    for (Mark& mark : marks_)
        mark.found = false;
    if (seen.picture == nullptr || seen.picture->empty() || options_.weight <= 0.0f) return;
    body_.pose(pose, posed_);
    const auto known = static_cast<std::size_t>(
        std::count_if(marks_.begin(), marks_.end(), [](const Mark& m) { return m.known; }));
    // About half of those known are seen at a time.
    const std::size_t every = 1 + known / (2 * options_.most_sought);
    ++turn_;
    for (std::size_t n = 0; n < marks_.size(); ++n) {
        Mark& mark = marks_[n];
        if (mark.known) ++counts_.known[mark.joint];
        if (!mark.known || (n + turn_) % every != 0) continue;
        Frame frame;
        if (!frame_of(seen, mark, frame) || !place_samples(*seen.picture, frame, kReach + 1))
            continue;
        ++counts_.sought[mark.joint];
        const Peak peak = search(*seen.picture, mark);
        mark.found = peak.likeness > options_.least_likeness;
        mark.missed = mark.found ? 0 : mark.missed + 1;
        if (!mark.found) continue;
        ++counts_.found[mark.joint];
        pull(*seen.picture, mark, frame, peak);
        pulled_.resize(pulls_.size(), n);
    }
}

void SkinMarks::learn(const SeenPerson& seen, const body::Pose& pose, float dt) noexcept {
    if (seen.picture == nullptr || seen.picture->empty() || options_.weight <= 0.0f) return;
    body_.pose(pose, posed_);
    std::array<float, kJointCount> gives{};
    for (const Limb& limb : kLimbs)
        gives[static_cast<std::size_t>(limb.joint)] =
            body::approach(dt * bend_of(posed_.joints, limb), options_.forget_s);
    for (std::size_t i = 0; i < pulls_.size(); ++i) {
        Mark& mark = marks_[pulled_[i]];
        const float give = gives[mark.joint];
        const Quatf& skin = posed_.rotations[mark.vertex];
        const Vec3f at = posed_.positions[mark.vertex] + skin * mark.offset;
        for (const Vec3f& along : pulls_[i].along)
            mark.offset -= give * along.dot(at) * (skin.conjugate() * along);
        if (mark.offset.norm() > 0.04f) mark.known = false;
    }
    for (Mark& mark : marks_) {
        if (mark.known && mark.missed >= kMissedTooOften) mark.known = false;
        if (mark.known) continue;
        mark.offset.setZero();
        Frame frame;
        if (!frame_of(seen, mark, frame) || frame.facing < kFacingToTake ||
            !place_samples(*seen.picture, frame, 1))
            continue;
        std::array<float, kSamples> look;
        const float mean = sample(*seen.picture, 0, 0, look) / static_cast<float>(kSamples);
        float squares = 0.0f;
        for (float& value : look) {
            value -= mean;
            squares += value * value;
        }
        const float deviation = std::sqrt(squares / static_cast<float>(kSamples));
        if (deviation < kLeastContrast * mean || deviation < 16.0f) continue;
        for (std::size_t n = 0; n < look.size(); ++n)
            mark.look[n] = look[n] / std::sqrt(squares);
        mark.known = true;
        mark.missed = 0;
    }
}

} // namespace toile::body_tracker
