// The mirror's cloth against the truth of a simulated camera: silhouette of the same garment truly
// worn, and the share of real lower arms before the trunk that cloth covers by mistake.
// kiosk_picture_evaluation silhouette SCENARIO FRAME=MASK.png...
// kiosk_picture_evaluation arm SCENARIO AVATAR FRAME=MASK.png...
#include "body/body_model.h"
#include "core/error.h"
#include "host/registry.h"
#include "host/views.h"
#include "imaging/image.h"
#include "pipeline/sensor_source.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace toile::test {
namespace {

constexpr int kBand = 2; // pixels at an edge that count for nothing

/// Depths of a set of triangles, as a camera sees them; infinite where there is none.
class DepthMap {
  public:
    DepthMap(const imaging::Intrinsics& camera, const Eigen::Isometry3d& place)
        : camera_(camera), from_world_(place.inverse()),
          depth_(static_cast<std::size_t>(camera.width * camera.height),
                 std::numeric_limits<float>::infinity()) {}

    void draw(const geometry::TriangleMesh& mesh, const std::vector<Triangle>& triangles) {
        std::vector<Vec3f> seen(mesh.positions.size()); // pixel, depth
        for (std::size_t v = 0; v < seen.size(); ++v) {
            const Vec3d p = from_world_ * mesh.positions[v].cast<double>();
            const auto pixel = imaging::project(camera_, p);
            seen[v] = pixel ? Vec3f(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()),
                                    static_cast<float>(-p.z()))
                            : Vec3f::Constant(-1e6f);
        }
        for (const Triangle& t : triangles)
            fill(seen[t[0]], seen[t[1]], seen[t[2]]);
    }
    [[nodiscard]] float at(std::size_t i) const { return depth_[i]; }

  private:
    void fill(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
        const Vec2f low = a.head<2>().cwiseMin(b.head<2>()).cwiseMin(c.head<2>());
        const Vec2f high = a.head<2>().cwiseMax(b.head<2>()).cwiseMax(c.head<2>());
        if (low.x() < -1e5f) return;
        const auto cross = [](const Vec3f& p, const Vec3f& q, float x, float y) {
            return (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x());
        };
        const float area = cross(a, b, c.x(), c.y());
        if (std::abs(area) < 1e-9f) return;
        for (int y = std::max(0, static_cast<int>(std::ceil(low.y())));
             y <= std::min(camera_.height - 1, static_cast<int>(high.y())); ++y)
            for (int x = std::max(0, static_cast<int>(std::ceil(low.x())));
                 x <= std::min(camera_.width - 1, static_cast<int>(high.x())); ++x) {
                const auto px = static_cast<float>(x);
                const auto py = static_cast<float>(y);
                const float u = cross(b, c, px, py) / area;
                const float v = cross(c, a, px, py) / area;
                const float w = 1.0f - u - v;
                if (u < 0.0f || v < 0.0f || w < 0.0f) continue;
                const float z = 1.0f / (u / a.z() + v / b.z() + w / c.z());
                float& stored = depth_[static_cast<std::size_t>(y * camera_.width + x)];
                stored = std::min(stored, z);
            }
    }

    imaging::Intrinsics camera_;
    Eigen::Isometry3d from_world_;
    std::vector<float> depth_;
};

std::vector<bool> covered_by(const std::string& file, const imaging::Intrinsics& camera) {
    const imaging::Image mask = imaging::load_image(file);
    if (mask.width != camera.width || mask.height != camera.height)
        throw Error(file + ": not of the camera's size");
    std::vector<bool> out;
    for (std::size_t i = 0; i < mask.pixels.size(); i += 4)
        out.push_back(mask.pixels[i] > 127);
    return out;
}

/// True where all pixels within the band are.
std::vector<bool> eroded(const std::vector<bool>& mask, int width, int height) {
    std::vector<bool> out(mask.size());
    for (int y = kBand; y < height - kBand; ++y)
        for (int x = kBand; x < width - kBand; ++x) {
            bool all = true;
            for (int dy = -kBand; dy <= kBand && all; ++dy)
                for (int dx = -kBand; dx <= kBand && all; ++dx)
                    all = mask[static_cast<std::size_t>((y + dy) * width + x + dx)];
            out[static_cast<std::size_t>(y * width + x)] = all;
        }
    return out;
}

std::vector<Triangle> triangles_of(const body::BodyModel& model,
                                   std::initializer_list<body::Part> parts) {
    std::vector<Triangle> out;
    for (const Triangle& t : model.rest.triangles)
        if (std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
                return std::find(parts.begin(), parts.end(), model.parts[v]) != parts.end();
            }))
            out.push_back(t);
    return out;
}

void evaluate(const std::vector<std::string>& words) {
    const bool arm = words.at(0) == "arm";
    host::Services services;
    host::Registry registry(services);
    host::Job job;
    auto limits = host::sized<toile_limits>();
    limits.max_people = 4;
    limits.max_vertices = 1'000'000;
    limits.max_triangles = 2'000'000;
    limits.thread_count = services.thread_count();
    limits.random_seed = 1;
    pipeline::SensorSource source("simulated:" + words.at(1), registry, services, limits, job);
    const imaging::Intrinsics camera = source.streams().front().depth;
    const pipeline::TrueCamera place = source.true_camera(0);
    std::optional<body::BodyModel> model;
    if (arm) model = body::load_body_model(body::find_avatar(words.at(2)));
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = arm ? 3 : 2; i < words.size(); ++i) {
        const std::size_t equals = words[i].find('=');
        const auto frame = static_cast<std::uint32_t>(std::stoul(words[i].substr(0, equals)));
        const std::vector<bool> cloth = covered_by(words[i].substr(equals + 1), camera);
        DepthMap front(camera, place.world_from_camera);
        DepthMap behind(camera, place.world_from_camera);
        for (const pipeline::TrueSurface& surface : source.true_surfaces(frame)) {
            if (arm && surface.role == body::SurfaceRole::body) {
                using body::Part;
                front.draw(surface.mesh,
                           triangles_of(*model, {Part::left_lower_arm, Part::right_lower_arm}));
                behind.draw(surface.mesh, triangles_of(*model, {Part::torso, Part::pelvis}));
            } else if (!arm) {
                (surface.role == body::SurfaceRole::garment ? front : behind)
                    .draw(surface.mesh, surface.mesh.triangles);
            }
        }
        std::vector<bool> truth(cloth.size());
        for (std::size_t p = 0; p < truth.size(); ++p)
            truth[p] = std::isfinite(front.at(p)) && front.at(p) < behind.at(p) &&
                       (!arm || std::isfinite(behind.at(p)));
        if (arm) truth = eroded(truth, camera.width, camera.height);
        std::size_t both = 0;
        std::size_t either = 0;
        for (std::size_t p = 0; p < truth.size(); ++p) {
            both += truth[p] && cloth[p] ? 1 : 0;
            either += arm ? (truth[p] ? 1 : 0) : (truth[p] || cloth[p] ? 1 : 0);
        }
        if (either == 0) continue;
        const double share = static_cast<double>(both) / static_cast<double>(either);
        std::printf("frame %u: %s %.4f (%zu pixels)\n", frame,
                    arm ? "arm wrongly covered" : "intersection over union", share, either);
        sum += share;
        ++count;
    }
    if (count == 0) throw Error("no frame had anything to measure");
    std::printf("mean of %zu frames: %.4f\n", count, sum / static_cast<double>(count));
}

} // namespace
} // namespace toile::test

int main(int argc, char** argv) {
    try {
        if (argc < 4) throw toile::Error("usage: see the head of the source");
        toile::test::evaluate({argv + 1, argv + argc});
    } catch (const std::exception& e) {
        std::fprintf(stderr, "kiosk_picture_evaluation: %s\n", e.what());
        return 1;
    }
    return 0;
}
