#include "silhouettes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::evaluation {
namespace {

struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> covered;
};

Picture silhouette(const geometry::TriangleMesh& mesh, float turn, const Eigen::AlignedBox2f& box,
                   float pixel) {
    Picture out;
    out.width = static_cast<int>(box.sizes().x() / pixel) + 2;
    out.height = static_cast<int>(box.sizes().y() / pixel) + 2;
    out.covered.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height),
                       0);
    std::vector<Vec2f> seen;
    seen.reserve(mesh.positions.size());
    for (const Vec3f& p : mesh.positions)
        seen.emplace_back(
            (Vec2f(std::cos(turn) * p.x() + std::sin(turn) * p.z(), p.y()) - box.min()) / pixel);
    for (const Triangle& t : mesh.triangles) {
        const Vec2f &a = seen[t[0]], &b = seen[t[1]], &c = seen[t[2]];
        const Vec2f low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
        const auto edge = [](const Vec2f& p, const Vec2f& q, const Vec2f& x) {
            return (q - p).x() * (x - p).y() - (q - p).y() * (x - p).x();
        };
        const float side = edge(a, b, c) < 0.0f ? -1.0f : 1.0f;
        for (int y = std::max(0, static_cast<int>(low.y()));
             y <= std::min(out.height - 1, static_cast<int>(high.y())); ++y)
            for (int x = std::max(0, static_cast<int>(low.x()));
                 x <= std::min(out.width - 1, static_cast<int>(high.x())); ++x) {
                const Vec2f q(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                if (side * edge(a, b, q) >= 0.0f && side * edge(b, c, q) >= 0.0f &&
                    side * edge(c, a, q) >= 0.0f)
                    out.covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                                static_cast<std::size_t>(x)] = 1;
            }
    }
    return out;
}

} // namespace

double silhouette_overlap(const geometry::TriangleMesh& a, const geometry::TriangleMesh& b,
                          int views, float pixel) {
    double sum = 0.0;
    for (int view = 0; view < views; ++view) {
        const float turn =
            2.0f * std::numbers::pi_v<float> * static_cast<float>(view) / static_cast<float>(views);
        Eigen::AlignedBox2f box;
        for (const auto* mesh : {&a, &b})
            for (const Vec3f& p : mesh->positions)
                box.extend(Vec2f(std::cos(turn) * p.x() + std::sin(turn) * p.z(), p.y()));
        const Picture x = silhouette(a, turn, box, pixel), y = silhouette(b, turn, box, pixel);
        double both = 0.0, either = 0.0;
        for (std::size_t i = 0; i < x.covered.size(); ++i) {
            both += x.covered[i] & y.covered[i];
            either += x.covered[i] | y.covered[i];
        }
        sum += both / std::max(either, 1.0);
    }
    return sum / views;
}

} // namespace toile::evaluation
