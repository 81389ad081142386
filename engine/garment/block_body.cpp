#include "garment/block_body.h"

#include "core/error.h"
#include "geometry/slice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

namespace toile::garment::block {
namespace {

constexpr double kCell = 0.004;   // depth grid, metres
constexpr int kNeighbourhood = 3; // cells by which depths are widened

double distance_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    const Vec3d d = b - a;
    const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
    return (a + t * d - p).norm();
}

Vec3d centroid(const std::span<const Vec3d> loop) {
    Vec3d sum = Vec3d::Zero();
    for (const Vec3d& p : loop) {
        sum += p;
    }
    return sum / static_cast<double>(loop.size());
}

double closed_length(const std::span<const Vec2d> polygon) {
    double sum = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        sum += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
    }
    return sum;
}

// Of the outlines in a sagittal plane, that over the shoulder: the highest that begins below it.
const std::vector<Vec3d>& over_shoulder(const std::vector<std::vector<Vec3d>>& loops,
                                        const double shoulder_m, const std::string& id) {
    const std::vector<Vec3d>* best = nullptr;
    double top = -1e9;
    for (const auto& loop : loops) {
        const auto [low, high] = std::minmax_element(
            loop.begin(), loop.end(), [](const Vec3d& a, const Vec3d& b) { return a.y() < b.y(); });
        if (low->y() < shoulder_m && high->y() > top) {
            top = high->y();
            best = &loop;
        }
    }
    if (best == nullptr) {
        throw Error("avatar '" + id +
                    "' has no surface at its shoulder joint: its skeleton does "
                    "not fit its surface");
    }
    return *best;
}

} // namespace

std::vector<Vec2d> convex_hull(std::vector<Vec2d> points) {
    const auto turn = [](const Vec2d& a, const Vec2d& b, const Vec2d& c) {
        return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    };
    std::sort(points.begin(), points.end(), [](const Vec2d& a, const Vec2d& b) {
        return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
    });
    std::vector<Vec2d> hull;
    for (int pass = 0; pass < 2; ++pass) { // lower chain, then the upper one
        const std::size_t start = hull.size();
        for (const Vec2d& p : points) {
            while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) {
                hull.pop_back();
            }
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

double Ring::girth() const {
    return closed_length(hull);
}

double Ring::half_width() const {
    double width = 0.0;
    for (const Vec2d& p : hull) {
        width = std::max(width, std::abs(p.x()));
    }
    return width;
}

Vec3d Ring::at(const double fraction, const double ease_m) const {
    std::vector<Vec2d> wide;
    for (const Vec2d& p : hull) {
        for (int k = 0; k < 16; ++k) {
            const double angle = (k + 0.5) * std::numbers::pi / 8.0;
            wide.emplace_back(p + ease_m * Vec2d(std::cos(angle), std::sin(angle)));
        }
    }
    wide = convex_hull(std::move(wide));
    // Clockwise from the centre front, on the side x >= 0.
    std::vector<Vec2d> half;
    for (std::size_t i = 0; i < wide.size(); ++i) {
        const Vec2d& a = wide[i];
        const Vec2d& b = wide[(i + 1) % wide.size()];
        if (a.x() > 0.0) {
            half.push_back(a);
        }
        if ((a.x() > 0.0) != (b.x() > 0.0)) {
            half.push_back(a + (b - a) * (a.x() / (a.x() - b.x())));
            half.back().x() = 0.0;
        }
    }
    // The hull runs back, side, front; cut it where it leaves x <= 0.
    for (std::size_t i = 0; i < half.size(); ++i) {
        if (half[i].x() == 0.0 && half[i].y() < half[(i + half.size() - 1) % half.size()].y()) {
            std::rotate(half.begin(), half.begin() + static_cast<std::ptrdiff_t>(i), half.end());
            break;
        }
    }
    std::reverse(half.begin(), half.end());
    const auto side = std::max_element(
        half.begin(), half.end(), [](const Vec2d& a, const Vec2d& b) { return a.x() < b.x(); });
    const std::vector<Vec2d> front(half.begin(), side + 1);
    const std::vector<Vec2d> back(side, half.end());
    const bool on_front = fraction <= 0.5;
    const std::vector<Vec2d>& arc = on_front ? front : back;
    double wanted = (on_front ? fraction : fraction - 0.5) * 2.0 * length(arc);
    for (std::size_t i = 1; i < arc.size(); ++i) {
        const double piece = (arc[i] - arc[i - 1]).norm();
        if (wanted <= piece || i + 1 == arc.size()) {
            const double t = piece > 0.0 ? std::min(1.0, wanted / piece) : 0.0;
            const Vec2d p = arc[i - 1] + t * (arc[i] - arc[i - 1]);
            return {p.x(), height_m, p.y()};
        }
        wanted -= piece;
    }
    return {arc.back().x(), height_m, arc.back().y()};
}

BodyProbe::BodyProbe(const body::BodyModel& body) : body_(body) {
    armpit_ = find_armpit();
    neck_half_width_ = find_neck();
    build_depth();
}

Vec3d BodyProbe::joint(const body::Joint joint) const {
    return body_.skeleton.rest(joint).cast<double>();
}

std::vector<std::vector<Vec3d>> BodyProbe::slice(const Vec3d& normal, const double offset) const {
    const geometry::Plane plane{normal.cast<float>(), static_cast<float>(offset)};
    std::vector<std::vector<Vec3d>> loops;
    for (const auto& loop : geometry::slice(body_.rest.positions, body_.rest.triangles, plane)) {
        if (loop.points.size() >= 3) {
            auto& out = loops.emplace_back();
            for (const Vec3f& p : loop.points) {
                out.emplace_back(p.cast<double>());
            }
        }
    }
    return loops;
}

Ring BodyProbe::ring(const double height_m) const {
    using body::Joint;
    Ring ring;
    ring.height_m = height_m;
    std::vector<Vec2d> points;
    for (const auto& loop : slice(Vec3d::UnitY(), height_m)) {
        const Vec3d c = centroid(loop);
        double arm = 1e9;
        double trunk = distance_to_segment(c, joint(Joint::hips), joint(Joint::head));
        for (const auto& [a, b, hand] :
             {std::tuple{Joint::left_upper_arm, Joint::left_lower_arm, Joint::left_hand},
              std::tuple{Joint::right_upper_arm, Joint::right_lower_arm, Joint::right_hand}}) {
            const Vec3d tip = joint(hand) + 0.8 * (joint(hand) - joint(b));
            arm = std::min({arm, distance_to_segment(c, joint(a), joint(b)),
                            distance_to_segment(c, joint(b), tip)});
        }
        for (const auto& [a, b, foot] :
             {std::tuple{Joint::left_upper_leg, Joint::left_lower_leg, Joint::left_foot},
              std::tuple{Joint::right_upper_leg, Joint::right_lower_leg, Joint::right_foot}}) {
            trunk = std::min({trunk, distance_to_segment(c, joint(a), joint(b)),
                              distance_to_segment(c, joint(b), joint(foot))});
        }
        if (trunk < arm) {
            for (const Vec3d& p : loop) {
                points.emplace_back(p.x(), p.z());
            }
        }
    }
    if (points.size() < 3) {
        throw Error("avatar '" + body_.id + "' has no trunk at height " + std::to_string(height_m) +
                    " m: its skeleton does not fit its surface");
    }
    ring.hull = convex_hull(std::move(points));
    return ring;
}

double BodyProbe::find_armpit() const {
    const double top = joint(body::Joint::left_upper_arm).y();
    double y = joint(body::Joint::chest).y();
    double width = ring(y).half_width();
    for (; y < top; y += 0.004) {
        const double next = ring(y).half_width();
        if (next > width + 0.03) {
            return y - 0.004;
        }
        width = next;
    }
    throw Error("avatar '" + body_.id +
                "' has no armpit between its chest and shoulders: garment "
                "blocks need a body in A pose");
}

Vec3d BodyProbe::ridge(const double x) const {
    const auto loops = slice(Vec3d::UnitX(), x);
    const auto& loop = over_shoulder(loops, joint(body::Joint::left_upper_arm).y(), body_.id);
    return *std::max_element(loop.begin(), loop.end(),
                             [](const Vec3d& a, const Vec3d& b) { return a.y() < b.y(); });
}

double BodyProbe::find_neck() const {
    double x = joint(body::Joint::left_upper_arm).x();
    double y = ridge(x).y();
    constexpr double kStep = 0.004;
    for (; x > 0.04; x -= kStep) {
        const double next = ridge(x - kStep).y();
        if (next - y > kStep) {
            return x;
        }
        y = next;
    }
    return x;
}

double BodyProbe::drop_length(const double x, const double height_m, const bool front) const {
    const auto loops = slice(Vec3d::UnitX(), x);
    const auto& loop = over_shoulder(loops, joint(body::Joint::left_upper_arm).y(), body_.id);
    std::vector<Vec2d> side;
    for (const Vec3d& p : loop) {
        if (p.y() >= height_m) {
            side.emplace_back(front ? p.z() : -p.z(), p.y());
        }
    }
    const std::vector<Vec2d> hull = convex_hull(std::move(side));
    // Up the outer side: counter-clockwise from the lowest, outermost point to the top.
    std::size_t low = 0;
    std::size_t top = 0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
        if (hull[i].x() - 3.0 * (hull[i].y() - height_m) >
            hull[low].x() - 3.0 * (hull[low].y() - height_m)) {
            low = i;
        }
        top = hull[i].y() > hull[top].y() ? i : top;
    }
    double sum = hull[low].y() - height_m;
    for (std::size_t i = low; i != top; i = (i + 1) % hull.size()) {
        sum += (hull[(i + 1) % hull.size()] - hull[i]).norm();
    }
    return sum;
}

void BodyProbe::build_depth() {
    Vec2d high = body_.rest.positions.front().head<2>().cast<double>();
    grid_low_ = high;
    for (const Vec3f& p : body_.rest.positions) {
        grid_low_ = grid_low_.cwiseMin(p.head<2>().cast<double>());
        high = high.cwiseMax(p.head<2>().cast<double>());
    }
    grid_low_.array() -= 0.05;
    grid_width_ = static_cast<int>((high.x() + 0.05 - grid_low_.x()) / kCell) + 1;
    grid_height_ = static_cast<int>((high.y() + 0.05 - grid_low_.y()) / kCell) + 1;
    const auto cells = static_cast<std::size_t>(grid_width_) * grid_height_;
    constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();
    std::array<std::vector<double>, 2> raw;
    raw.fill(std::vector<double>(cells, kEmpty));
    for (const Triangle& t : body_.rest.triangles) {
        const Vec3d a = body_.rest.positions[t[0]].cast<double>();
        const Vec3d b = body_.rest.positions[t[1]].cast<double>();
        const Vec3d c = body_.rest.positions[t[2]].cast<double>();
        // Sampled more finely than the grid.
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        const int n = static_cast<int>(longest / (0.5 * kCell)) + 1;
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; i + j <= n; ++j) {
                const Vec3d p = a + (b - a) * (static_cast<double>(i) / n) +
                                (c - a) * (static_cast<double>(j) / n);
                const auto cell =
                    static_cast<std::size_t>((p.y() - grid_low_.y()) / kCell) * grid_width_ +
                    static_cast<std::size_t>((p.x() - grid_low_.x()) / kCell);
                raw[0][cell] = std::fmax(raw[0][cell], p.z());
                raw[1][cell] = std::fmin(raw[1][cell], p.z());
            }
        }
    }
    grid_depth_ = raw;
    for (int y = kNeighbourhood; y < grid_height_ - kNeighbourhood; ++y) {
        for (int x = kNeighbourhood; x < grid_width_ - kNeighbourhood; ++x) {
            const auto cell = static_cast<std::size_t>(y) * grid_width_ + x;
            for (int dy = -kNeighbourhood; dy <= kNeighbourhood; ++dy) {
                for (int dx = -kNeighbourhood; dx <= kNeighbourhood; ++dx) {
                    const auto other = static_cast<std::size_t>(y + dy) * grid_width_ + x + dx;
                    grid_depth_[0][cell] = std::fmax(grid_depth_[0][cell], raw[0][other]);
                    grid_depth_[1][cell] = std::fmin(grid_depth_[1][cell], raw[1][other]);
                }
            }
        }
    }
}

bool BodyProbe::depth(const double x, const double y, const bool front, double& z) const {
    const int column = static_cast<int>((x - grid_low_.x()) / kCell);
    const int row = static_cast<int>((y - grid_low_.y()) / kCell);
    if (column < 0 || row < 0 || column >= grid_width_ || row >= grid_height_) {
        return false;
    }
    z = grid_depth_[front ? 0 : 1][static_cast<std::size_t>(row) * grid_width_ + column];
    return !std::isnan(z);
}

double BodyProbe::arm_girth(const double share, Vec3d& centre) const {
    const Vec3d a = joint(body::Joint::left_upper_arm);
    const Vec3d b = joint(body::Joint::left_lower_arm);
    const Vec3d axis = (b - a).normalized();
    const Vec3d p = a + share * (b - a);
    const Vec3d across = axis.unitOrthogonal();
    const Vec3d other = axis.cross(across);
    double girth = 0.0;
    double nearest = 1e9;
    for (const auto& loop : slice(axis, axis.dot(p))) {
        const Vec3d c = centroid(loop);
        if ((c - p).norm() < nearest) {
            nearest = (c - p).norm();
            centre = c;
            std::vector<Vec2d> flat;
            for (const Vec3d& q : loop) {
                flat.emplace_back(across.dot(q - p), other.dot(q - p));
            }
            girth = closed_length(convex_hull(std::move(flat)));
        }
    }
    return girth;
}

} // namespace toile::garment::block
