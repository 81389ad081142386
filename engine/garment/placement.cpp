#include "garment/placement.h"

#include "core/error.h"
#include "geometry/nearest_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace toile::garment {
namespace {

struct UnitName {
    Unit unit;
    std::string_view name;
    std::string_view shorthand;
    double metres;
};
constexpr std::array<UnitName, 5> kUnits = {{{Unit::metres, "metres", "m", 1.0},
                                             {Unit::decimetres, "decimetres", "dm", 0.1},
                                             {Unit::centimetres, "centimetres", "cm", 0.01},
                                             {Unit::millimetres, "millimetres", "mm", 0.001},
                                             {Unit::inches, "inches", "in", 0.0254}}};

const UnitName& entry(Unit unit) {
    const auto* const found = std::find_if(kUnits.begin(), kUnits.end(),
                                           [unit](const UnitName& u) { return u.unit == unit; });
    if (found == kUnits.end()) throw Error("an invalid unit");
    return *found;
}

Eigen::AlignedBox3f bounds(std::span<const Vec3f> positions) {
    Eigen::AlignedBox3f box;
    for (const Vec3f& p : positions)
        box.extend(p);
    return box;
}

std::vector<Vec3f> thinned(std::span<const Vec3f> positions, std::size_t most) {
    const std::size_t step = std::max<std::size_t>(1, positions.size() / most);
    std::vector<Vec3f> out;
    for (std::size_t i = 0; i < positions.size(); i += step)
        out.push_back(positions[i]);
    return out;
}

/// The body, asked how well points sit on it.
class Body {
  public:
    explicit Body(const geometry::TriangleMesh& mesh)
        : nearest_(mesh.positions, mesh.triangles), box_(bounds(mesh.positions)) {}
    [[nodiscard]] const Eigen::AlignedBox3f& box() const { return box_; }

    /// Mean distance with an upper bound per point; being inside costs four times as much. Metres.
    [[nodiscard]] double cost(std::span<const Vec3f> points, const Vec3f& shift) const {
        double sum = 0.0;
        for (const Vec3f& p : points) {
            const double d = signed_distance(p + shift);
            sum += std::min(0.25, d < 0.0 ? -4.0 * d : d);
        }
        return sum / static_cast<double>(points.size());
    }
    [[nodiscard]] double signed_distance(const Vec3f& p) const {
        return static_cast<double>(nearest_.nearest(p).signed_distance);
    }

  private:
    geometry::NearestSurface nearest_;
    Eigen::AlignedBox3f box_;
};

/// Best value of one coordinate of `shift` in steps around it.
double slide(const Body& body, std::span<const Vec3f> points, int axis, float low, float high,
             float step, Vec3f& shift) {
    const float start = shift[axis];
    double best = body.cost(points, shift);
    float at = start;
    for (float s = low; s <= high; s += step) {
        shift[axis] = s;
        const double cost = body.cost(points, shift);
        if (cost < best) {
            best = cost;
            at = s;
        }
    }
    shift[axis] = at;
    return best;
}

/// Slides the points along the body; leaves them when they sit well already.
double seat(const Body& body, std::span<const Vec3f> points, Vec3f& shift) {
    constexpr double kSits = 0.03; // metres
    shift = Vec3f::Zero();
    const double as_is = body.cost(points, shift);
    if (as_is < kSits) return as_is;
    const auto box = bounds(points);
    shift.x() = std::abs(box.center().x()) > 0.15f ? -box.center().x() : 0.0f;
    shift.z() = body.box().center().z() - box.center().z();
    const float low = body.box().min().y() - box.min().y() - 0.05f;
    const float high = body.box().max().y() - box.max().y() + 0.1f;
    slide(body, points, 1, std::min(low, high), std::max(low, high), 0.03f, shift);
    double best = as_is;
    for (const float step : {0.01f, 0.004f}) {
        const Vec3f c = shift;
        slide(body, points, 2, c.z() - 12 * step, c.z() + 12 * step, step, shift);
        best = slide(body, points, 1, c.y() - 6 * step, c.y() + 6 * step, step, shift);
    }
    return best;
}

} // namespace

double metres_per(Unit unit) {
    return entry(unit).metres;
}

std::string_view unit_name(Unit unit) {
    return entry(unit).name;
}

std::optional<Unit> unit_from_text(std::string_view text) {
    for (const UnitName& u : kUnits)
        if (text == u.name || text == u.shorthand) return u.unit;
    return std::nullopt;
}

Eigen::Affine3f Placement::transform() const {
    Eigen::Affine3f out = Eigen::Affine3f::Identity();
    out.translate(shift);
    const float half_turn = std::numbers::pi_v<float>;
    if (faces_back) out.rotate(Eigen::AngleAxisf(half_turn, Vec3f::UnitY()));
    if (z_up) out.rotate(Eigen::AngleAxisf(-0.5f * half_turn, Vec3f::UnitX()));
    out.scale(static_cast<float>(metres_per(unit)));
    return out;
}

Placement place_on_body(std::span<const Vec3f> positions, const geometry::TriangleMesh& body_mesh,
                        std::optional<Unit> unit) {
    const Body body(body_mesh);
    const float person = body.box().sizes().maxCoeff();
    const float extent = bounds(positions).sizes().maxCoeff();
    const std::vector<Vec3f> sample = thinned(positions, 200);
    Placement best;
    double best_cost = 1e30;
    for (const UnitName& u : kUnits) {
        if (unit && u.unit != *unit) continue;
        const float size = extent * static_cast<float>(u.metres);
        if (!unit && (size < 0.1f * person || size > 1.15f * person)) continue;
        for (int turn = 0; turn < 4; ++turn) {
            Placement tried;
            tried.unit = u.unit;
            tried.z_up = (turn & 1) != 0;
            tried.faces_back = (turn & 2) != 0;
            const Eigen::Affine3f move = tried.transform();
            std::vector<Vec3f> points;
            for (const Vec3f& p : sample)
                points.push_back(move * p);
            // Large garments are seldom wrong; turns need to be clearly better.
            const double cost = seat(body, points, tried.shift) / static_cast<double>(size) *
                                (turn == 0 ? 1.0 : 1.5);
            if (cost >= best_cost) continue;
            best_cost = cost;
            best = tried;
        }
    }
    if (best_cost >= 1e30)
        throw Error("the mesh is " + std::to_string(extent) +
                    " units large, which is no garment in any unit known; give --unit");
    const Eigen::Affine3f move = best.transform();
    std::size_t inside = 0;
    for (const Vec3f& p : sample) {
        const double d = body.signed_distance(move * p);
        best.mean_distance += std::abs(d) / static_cast<double>(sample.size());
        inside += d < 0.0 ? 1 : 0;
    }
    best.inside = static_cast<double>(inside) / static_cast<double>(sample.size());
    return best;
}

Placement place_freely(std::span<const Vec3f> positions, std::optional<Unit> unit) {
    constexpr double kTypical = 0.8; // metres
    const double extent = static_cast<double>(bounds(positions).sizes().maxCoeff());
    Placement best;
    if (unit) best.unit = *unit;
    for (const UnitName& u : kUnits)
        if (!unit && std::abs(std::log(extent * u.metres / kTypical)) <
                         std::abs(std::log(extent * metres_per(best.unit) / kTypical)))
            best.unit = u.unit;
    return best;
}

} // namespace toile::garment
