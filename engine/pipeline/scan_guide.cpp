#include "pipeline/scan_guide.h"

#include "abi/scan_guide.h"
#include "body/body_file.h"
#include "body/body_space.h"
#include "core/error.h"
#include "geometry/nearest_surface.h"
#include "host/views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace toile::pipeline {
namespace {

constexpr float kBeside_m = 0.04f;     // farther from the body is no skin and no close cloth
constexpr float kHangs_m = 0.35f;      // still farther is nothing of the person's
constexpr float kAboveFloor_m = 0.10f; // of the lowest place of the body
constexpr float kMostDetail_m = 0.01f; // of a body beside the space's own shapes
constexpr double kCarries = 0.02;      // share of the readings that makes another fit worth it
constexpr double kMistaken = 3.0; // times the usual share: that pose is wrong, not the readings
constexpr std::array kLeft_m{0.04f, 0.025f}; // left in fit after fit: the first reaches for the bag

/// Readings beside a body, as a camera has them.
class Beside {
  public:
    /// `detail` (nv) of the fitted surface: where it reaches for what is carried, it is taken off.
    Beside(const geometry::TriangleMesh& body, std::span<const float> detail)
        : surface_(plain(body, detail), body.triangles) {
        for (const Vec3f& p : body.positions)
            box_.extend(p);
    }

    /// The share of the person's readings; every `step`-th column and row counts.
    [[nodiscard]] double share(const SensorStream& stream, const imaging::DepthImage& depth,
                               int step) const {
        std::size_t near = 0, beside = 0;
        each(stream, depth, step, [&](std::size_t, float distance) {
            ++near;
            beside += distance > kBeside_m ? 1 : 0;
        });
        return static_cast<double>(beside) / static_cast<double>(std::max<std::size_t>(1, near));
    }
    /// Leaves out what is farther than that.
    void erase(const SensorStream& stream, float most_m, imaging::DepthImage& depth) const {
        each(stream, depth, 1, [&](std::size_t pixel, float distance) {
            if (distance > most_m) depth.metres[pixel] = 0.0f;
        });
    }

  private:
    static std::vector<Vec3f> plain(const geometry::TriangleMesh& body,
                                    std::span<const float> detail) {
        std::vector<Vec3f> out = body.positions;
        for (std::size_t v = 0; v < std::min(out.size(), detail.size()); ++v)
            out[v] -= (detail[v] - std::clamp(detail[v], -kMostDetail_m, kMostDetail_m)) *
                      body.normals[v];
        return out;
    }
    template <typename Found>
    void each(const SensorStream& stream, const imaging::DepthImage& depth, int step,
              const Found& found) const {
        const Eigen::Isometry3f place =
            stream.world_from_camera.value_or(Eigen::Isometry3d::Identity()).cast<float>();
        for (int y = 0; y < depth.height; y += step)
            for (int x = 0; x < depth.width; x += step) {
                const auto pixel =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.width) +
                    static_cast<std::size_t>(x);
                const float metres = depth.metres[pixel];
                if (!(metres > 0.0f)) continue;
                const auto seen = imaging::unproject(stream.depth, Eigen::Vector2d(x, y),
                                                     static_cast<double>(metres));
                if (!seen) continue;
                const Vec3f p = place * seen->cast<float>();
                if (p.y() < box_.min().y() + kAboveFloor_m ||
                    box_.squaredExteriorDistance(p) > kHangs_m * kHangs_m)
                    continue;
                const float distance = surface_.nearest(p, kHangs_m).distance;
                if (distance < kHangs_m) found(pixel, distance);
            }
    }
    geometry::NearestSurface surface_;
    Eigen::AlignedBox3f box_;
};

std::vector<float> detail_of(const FittedBody& body) {
    const std::filesystem::path folder = body::find_avatar(body.model);
    if (!std::filesystem::exists(folder / "space.json")) return {};
    return body::detail_of(body::BodySpace::load(folder), body.coefficients, body.rest,
                           body.skeleton);
}

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

ScanGuide::ScanGuide(std::span<const SensorStream> streams)
    : streams_(streams.begin(), streams.end()) {}

void ScanGuide::keep(std::span<const SensorFrame> frames) {
    const std::uint32_t number = fed_++;
    if (number % stride_ != 0) return;
    kept_.push_back({number, {frames.begin(), frames.end()}});
    if (kept_.size() <= 2 * kMostInstants) return;
    stride_ *= 2;
    std::erase_if(kept_, [&](const Kept& k) { return k.number % stride_ != 0; });
}

/// The first, the last, and others evenly between.
std::vector<const ScanGuide::Kept*> ScanGuide::chosen() const {
    const std::size_t count = std::min(kept_.size(), kMostInstants);
    std::vector<const Kept*> out;
    for (std::size_t k = 0; k < count; ++k)
        out.push_back(&kept_[count == 1 ? 0 : k * (kept_.size() - 1) / (count - 1)]);
    return out;
}

/// Usual share of the person's readings that lie beside the body.
double ScanGuide::beside_share(const FittedBody& body) const {
    constexpr int kStep = 3;
    const std::vector<float> detail = detail_of(body);
    std::vector<double> shares;
    const auto instants = chosen();
    for (std::size_t k = 0; k < instants.size(); ++k) {
        const Beside beside(body.surfaces[k], detail);
        for (std::size_t camera = 0; camera < streams_.size(); ++camera)
            shares.push_back(
                beside.share(streams_[camera], instants[k]->frames[camera].depth, kStep));
    }
    return median(shares);
}

/// One body for all that was kept; what lies farther than `most_m` beside
/// `known` is carried and left out.
FittedBody ScanGuide::fitted(host::Registry& registry, host::Services& services,
                             const toile_limits& limits, const FittedBody* known, float most_m,
                             host::Job& job) const {
    constexpr int kStep = 3;
    const double usual = known == nullptr ? 0.0 : beside_share(*known);
    const std::vector<float> detail = known == nullptr ? std::vector<float>{} : detail_of(*known);
    const auto instants = chosen();
    BodyFit fit(registry, services, limits);
    fit.begin_cameras(streams_, job);
    for (std::size_t k = 0; k < instants.size(); ++k) {
        std::vector<SensorFrame> frames = instants[k]->frames;
        if (known != nullptr) {
            const Beside beside(known->surfaces[k], detail);
            for (std::size_t camera = 0; camera < streams_.size(); ++camera)
                if (beside.share(streams_[camera], frames[camera].depth, kStep) < kMistaken * usual)
                    beside.erase(streams_[camera], most_m, frames[camera].depth);
        }
        fit.feed_frames(frames);
    }
    return fit.fit({}, job);
}

nlohmann::ordered_json ScanGuide::give(host::Registry& registry, host::Services& services,
                                       const toile_limits& limits, host::Instance& scanner,
                                       host::Job& job) {
    const auto instants = chosen();
    FittedBody body;
    double carried = 0.0;
    try {
        body = fitted(registry, services, limits, nullptr, 0.0f, job);
        carried = beside_share(body);
        if (carried > kCarries)
            for (const float left : kLeft_m)
                body = fitted(registry, services, limits, &body, left, job);
    } catch (const host::Cancelled&) {
        throw;
    } catch (const Error& e) {
        if (body.surfaces.empty()) return {{"instants", 0}, {"reason", e.what()}};
    }
    const auto& table = scanner.table<toile_scan_guide>();
    for (std::size_t k = 0; k < instants.size(); ++k) {
        auto rough = host::sized<toile_scan_template>();
        rough.instant = instants[k]->number;
        rough.surface = host::sized<toile_mesh>();
        rough.surface.positions = host::view_of(body.surfaces[k].positions);
        rough.surface.normals = host::view_of(body.surfaces[k].normals);
        rough.surface.triangles = host::view_of(body.surfaces[k].triangles);
        rough.surface.topology_id = 1;
        rough.part_labels = host::view_of(body.part_labels);
        scanner.call("guide", [&](toile_instance* i) { return table.guide(i, &rough); });
    }
    nlohmann::ordered_json out = {{"instants", instants.size()}};
    for (const char* key : {"rms_m", "sex", "paired_share"})
        if (body.report.contains(key)) out[key] = body.report[key];
    out["beside_share"] = carried > kCarries ? beside_share(body) : carried;
    return out;
}

} // namespace toile::pipeline
