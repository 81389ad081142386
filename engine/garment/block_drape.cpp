#include "garment/block_drape.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace toile::garment::block {
namespace {

constexpr double kStep = 1.0 / 240.0; // seconds
constexpr double kMediumStep = 1.0 / 600.0;
constexpr double kShortStep = 1.0 / 1200.0;
constexpr double kGravity = 9.81;

// Opposite corners of two triangles that share an edge, at their distance when laid flat.
std::vector<RestEdge> hinges(const std::span<const Triangle> triangles,
                             const std::span<const Vec2f> coords) {
    struct Wing {
        std::uint32_t tip = 0;
        double along = 0.0, height = 0.0, edge = 0.0;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, Wing> open;
    std::vector<RestEdge> out;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t ka = k;
            std::size_t kb = (k + 1) % 3;
            if (triangles[t][ka] > triangles[t][kb]) {
                std::swap(ka, kb);
            }
            const Vec2d a = coords[3 * t + ka].cast<double>();
            const Vec2d b = coords[3 * t + kb].cast<double>();
            const Vec2d c = coords[3 * t + (k + 2) % 3].cast<double>();
            const Vec2d u = (b - a).normalized();
            Wing wing;
            wing.tip = triangles[t][(k + 2) % 3];
            wing.along = u.dot(c - a);
            wing.height = std::abs(u.x() * (c - a).y() - u.y() * (c - a).x());
            wing.edge = (b - a).norm();
            const auto key = std::pair{triangles[t][ka], triangles[t][kb]};
            const auto [it, inserted] = open.try_emplace(key, wing);
            if (!inserted) {
                const Wing& other = it->second;
                // Seam edges may differ in length: compare places along as shares.
                const double edge = 0.5 * (wing.edge + other.edge);
                const double along = (wing.along / wing.edge - other.along / other.edge) * edge;
                out.push_back({other.tip, wing.tip, std::hypot(along, wing.height + other.height)});
            }
        }
    }
    return out;
}

class Drape {
  public:
    Drape(const Assembly& assembly, SizedBlock& block, const DistanceField& body,
          const std::span<const std::uint8_t> held, const DrapeOptions& options)
        : assembly_(assembly), x_(block.positions), body_(body), options_(options),
          edges_(rest_edges(assembly.triangles, block.material_coords)),
          hinges_(hinges(assembly.triangles, block.material_coords)),
          velocity_(x_.size(), Vec3d::Zero()), before_(x_), marked_(x_),
          inverse_mass_(x_.size(), 0.0), lambda_(edges_.size(), 0.0) {
        std::vector<double> mass(x_.size(), 0.0);
        for (std::size_t t = 0; t < assembly.triangles.size(); ++t) {
            const Vec2f u = block.material_coords[3 * t + 1] - block.material_coords[3 * t];
            const Vec2f v = block.material_coords[3 * t + 2] - block.material_coords[3 * t];
            const double area = 0.5 * std::abs(u.x() * v.y() - u.y() * v.x());
            for (const std::uint32_t i : assembly.triangles[t]) {
                mass[i] += options.density_kg_m2 * area / 3.0;
            }
        }
        for (std::size_t i = 0; i < x_.size(); ++i) {
            inverse_mass_[i] = held[i] != 0 ? 0.0 : 1.0 / mass[i];
        }
    }

    void step(const double seconds, const double gravity, const double kept_velocity,
              const bool symmetric) {
        seconds_ = seconds;
        for (std::size_t i = 0; i < x_.size(); ++i) {
            before_[i] = x_[i];
            if (inverse_mass_[i] > 0.0) {
                velocity_[i].y() -= gravity * seconds_;
                x_[i] += velocity_[i] * seconds_;
            }
        }
        std::fill(lambda_.begin(), lambda_.end(), 0.0);
        for (int i = 0; i < options_.iterations; ++i) {
            bend();
            stretch(i % 2 == 1);
        }
        collide();
        if (symmetric) {
            symmetrise();
        }
        for (std::size_t i = 0; i < x_.size(); ++i) {
            velocity_[i] = (x_[i] - before_[i]) * (kept_velocity / seconds_);
        }
    }

    [[nodiscard]] double mean_height() const {
        double sum = 0.0;
        for (const Vec3d& p : x_) {
            sum += p.y() / static_cast<double>(x_.size());
        }
        return sum;
    }

    void mark() { marked_ = x_; }

    // RMS over the vertices, metres; `farthest` gets the vertex that went farthest.
    [[nodiscard]] double way_since_mark(std::uint32_t& farthest) const {
        double sum = 0.0;
        double most = 0.0;
        for (std::size_t i = 0; i < x_.size(); ++i) {
            const double way = (x_[i] - marked_[i]).squaredNorm();
            sum += way / static_cast<double>(x_.size());
            if (way > most) {
                most = way;
                farthest = static_cast<std::uint32_t>(i);
            }
        }
        return std::sqrt(sum);
    }

    [[nodiscard]] double worst_strain(std::uint32_t& vertex) const {
        double worst = 0.0;
        for (const auto& [a, b, rest] : edges_) {
            const double strain = (x_[b] - x_[a]).norm() / rest - 1.0;
            if (strain > worst) {
                worst = strain;
                vertex = a;
            }
        }
        return worst;
    }

  private:
    void stretch(const bool backwards) {
        const double spring = 0.5 * std::sqrt(3.0) * options_.stretch_n_m;
        const double compliance = 1.0 / (spring * seconds_ * seconds_);
        for (std::size_t n = 0; n < edges_.size(); ++n) {
            const std::size_t e = backwards ? edges_.size() - 1 - n : n;
            const auto& [a, b, rest] = edges_[e];
            const double w = inverse_mass_[a] + inverse_mass_[b];
            const Vec3d d = x_[b] - x_[a];
            const double size = d.norm();
            if (w == 0.0 || size < 1e-9) {
                continue;
            }
            const double change = -(size - rest + compliance * lambda_[e]) / (w + compliance);
            lambda_[e] += change;
            const Vec3d move = d * (change / size);
            x_[a] -= inverse_mass_[a] * move;
            x_[b] += inverse_mass_[b] * move;
        }
    }

    void bend() {
        for (const auto& [a, b, rest] : hinges_) {
            const double w = inverse_mass_[a] + inverse_mass_[b];
            const Vec3d d = x_[b] - x_[a];
            const double size = d.norm();
            if (w == 0.0 || size < 1e-9 || size > rest) {
                continue;
            }
            const Vec3d move = d * (options_.bending * (rest - size) / (size * w));
            x_[a] -= inverse_mass_[a] * move;
            x_[b] += inverse_mass_[b] * move;
        }
    }

    void collide() {
        Vec3d out;
        for (std::size_t i = 0; i < x_.size(); ++i) {
            if (inverse_mass_[i] == 0.0) {
                continue;
            }
            const double depth = options_.clearance_m - body_.at(x_[i], out);
            if (depth > 0.0) {
                x_[i] += depth * out;
                // Coulomb: what slides within this step is held back by the contact's depth.
                const Vec3d slide = x_[i] - before_[i];
                const Vec3d along = slide - slide.dot(out) * out;
                const double size = along.norm();
                if (size > 1e-12) {
                    x_[i] -= along * std::min(1.0, options_.friction * depth / size);
                }
            }
        }
        for (const Triangle& t : assembly_.triangles) {
            const Vec3d centre = (x_[t[0]] + x_[t[1]] + x_[t[2]]) / 3.0;
            const double depth = 0.85 * options_.clearance_m - body_.at(centre, out);
            if (depth > 0.0) {
                for (const std::uint32_t i : t) {
                    x_[i] += inverse_mass_[i] > 0.0 ? Vec3d(depth * out) : Vec3d::Zero();
                }
            }
        }
    }

    void symmetrise() {
        for (std::size_t i = 0; i < x_.size(); ++i) {
            const std::size_t j = assembly_.mirror[i];
            if (j >= i) {
                const Vec3d m(-x_[j].x(), x_[j].y(), x_[j].z());
                x_[i] = 0.5 * (x_[i] + m);
                x_[j] = Vec3d(-x_[i].x(), x_[i].y(), x_[i].z());
            }
        }
    }

    const Assembly& assembly_;
    std::vector<Vec3d>& x_;
    const DistanceField& body_;
    const DrapeOptions& options_;
    std::vector<RestEdge> edges_, hinges_;
    std::vector<Vec3d> velocity_, before_, marked_;
    std::vector<double> inverse_mass_, lambda_;
    double seconds_ = kStep;
};

} // namespace

std::vector<RestEdge> rest_edges(const std::span<const Triangle> triangles,
                                 const std::span<const Vec2f> material_coords) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<double, int>> sums;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t n = (k + 1) % 3;
            auto& [sum, count] = sums[std::minmax(triangles[t][k], triangles[t][n])];
            sum += (material_coords[3 * t + k] - material_coords[3 * t + n]).cast<double>().norm();
            ++count;
        }
    }
    std::vector<RestEdge> out;
    for (const auto& [edge, value] : sums) {
        out.push_back({edge.first, edge.second, value.first / value.second});
    }
    return out;
}

DrapeReport drape(const Assembly& assembly, SizedBlock& block, const DistanceField& body,
                  const std::span<const std::uint8_t> held, const DrapeOptions& options) {
    Drape cloth(assembly, block, body, held, options);
    const bool mirrored = assembly.sides == 2;
    for (int i = 0; i < options.shrink_steps; ++i) {
        cloth.step(kStep, 0.0, 0.8, mirrored);
    }
    const double height = cloth.mean_height();
    for (int i = 0; i < options.settle_steps; ++i) {
        cloth.step(kStep, kGravity, 0.99, mirrored);
    }
    DrapeReport report;
    const int last = std::min(options.finish_steps, static_cast<int>(0.1 / kShortStep));
    // Heavy cloth that still swings gets more time, at most three times as much, in thicker air.
    constexpr double kAtRest = 0.03;
    for (int round = 0; round < 3; ++round) {
        for (int i = 0; i < options.finish_steps; ++i) {
            const bool symmetric = mirrored && i + 100 < options.finish_steps;
            if (i + last == options.finish_steps) {
                cloth.mark();
            }
            cloth.step(round == 0 && i < options.finish_steps / 2 ? kMediumStep : kShortStep,
                       kGravity, round == 0 ? 0.985 : 0.93, symmetric);
        }
        report.rms_speed = cloth.way_since_mark(report.fastest) / (std::max(last, 1) * kShortStep);
        if (report.rms_speed < kAtRest) {
            break;
        }
    }
    report.dropped_m = height - cloth.mean_height();
    report.worst_strain = cloth.worst_strain(report.worst_edge);
    return report;
}

} // namespace toile::garment::block
