#include "simulated_sensor/breath.h"

#include <cmath>
#include <numbers>

namespace toile::simulated_sensor {

Breath::Breath(double most_m, const geometry::TriangleMesh& rest, std::span<const body::Part> parts,
               const body::Skeleton& skeleton)
    : most_m_(static_cast<float>(most_m)) {
    if (most_m <= 0.0) return;
    const float low = skeleton.rest(body::Joint::hips).y(),
                high = skeleton.rest(body::Joint::neck).y();
    const float middle = low + 0.68f * (high - low), spread = 0.28f * (high - low);
    weights_.resize(rest.positions.size());
    for (std::size_t v = 0; v < weights_.size(); ++v) {
        const float off = (rest.positions[v].y() - middle) / spread;
        if (parts[v] == body::Part::torso) weights_[v] = std::exp(-off * off);
    }
    normals_.resize(weights_.size());
    soften(rest);
}

/// No step where the trunk ends.
void Breath::soften(const geometry::TriangleMesh& rest) {
    constexpr int kRounds = 12;
    const auto around = geometry::vertex_adjacency(weights_.size(), rest.triangles);
    for (int round = 0; round < kRounds; ++round) {
        const std::vector<float> before = weights_;
        for (std::size_t v = 0; v < weights_.size(); ++v) {
            float sum = before[v];
            for (std::uint32_t k = around.first[v]; k < around.first[v + 1]; ++k)
                sum += before[around.neighbours[k]];
            weights_[v] = sum / static_cast<float>(around.first[v + 1] - around.first[v] + 1);
        }
    }
}

void Breath::move(double time_s, std::span<const Triangle> triangles, std::span<Vec3f> positions) {
    if (weights_.empty()) return;
    constexpr double kPeriod_s = 4.0;
    const auto amount =
        most_m_ *
        static_cast<float>(0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * time_s / kPeriod_s));
    geometry::vertex_normals(positions, triangles, normals_);
    for (std::size_t v = 0; v < positions.size(); ++v)
        positions[v] += amount * weights_[v] * normals_[v];
}

} // namespace toile::simulated_sensor
