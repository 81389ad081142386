#include "scan/voxel_grid.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace toile::scan {

double cell_size(std::span<const Vec3f> points, double scale, double per_cell) {
    Eigen::AlignedBox3d box;
    for (const Vec3f& p : points)
        box.extend(p.cast<double>());
    if (points.size() < 2) return 0.0;
    constexpr double kThinnest_m = 1e-3; // a flat cloud has a volume as well
    const double volume = box.sizes().cwiseMax(kThinnest_m).prod();
    return scale * std::cbrt(per_cell * volume / static_cast<double>(points.size()));
}

std::vector<Vec3f> thinned(std::span<const Vec3f> points, double cell_m) {
    if (!(cell_m > 0.0)) return {points.begin(), points.end()};
    struct Cell {
        std::size_t number = 0;
    };
    std::map<std::array<std::int64_t, 3>, Cell> cells;
    std::vector<Vec3d> sums;
    std::vector<double> counts;
    for (const Vec3f& p : points) {
        std::array<std::int64_t, 3> key{};
        for (int i = 0; i < 3; ++i)
            key[static_cast<std::size_t>(i)] =
                static_cast<std::int64_t>(std::floor(static_cast<double>(p[i]) / cell_m));
        const auto [it, fresh] = cells.try_emplace(key, Cell{sums.size()});
        if (fresh) sums.emplace_back(Vec3d::Zero()), counts.push_back(0.0);
        sums[it->second.number] += p.cast<double>();
        counts[it->second.number] += 1.0;
    }
    std::vector<Vec3f> out;
    for (std::size_t i = 0; i < sums.size(); ++i)
        out.push_back((sums[i] / counts[i]).cast<float>());
    return out;
}

} // namespace toile::scan
