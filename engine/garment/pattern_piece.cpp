#include "garment/pattern_piece.h"

#include "core/error.h"
#include "core/json.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace toile::garment::block {
namespace {

constexpr double kLeastStep = 5e-5; // metres between neighbouring points of an outline
constexpr double kFarthest = 20.0;  // metres: no piece of a garment is larger
constexpr std::size_t kMostPoints = 20000;

double cross(const Vec2d& a, const Vec2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

Vec2d read_point(const nlohmann::json& value, const std::string& place) {
    if (!value.is_array() || value.size() != 2 || !value[0].is_number() || !value[1].is_number()) {
        throw Error(place + ": is not a pair of numbers");
    }
    return {0.001 * value[0].get<double>(), -0.001 * value[1].get<double>()};
}

bool crosses(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
    const auto side = [](const Vec2d& p, const Vec2d& q, const Vec2d& r) {
        return cross(q - p, r - p);
    };
    return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
}

// Crossing edges, by a sweep over their x ranges.
void refuse_crossings(const PatternPiece& piece) {
    const std::vector<Vec2d>& points = piece.outline;
    const std::size_t n = points.size();
    struct Edge {
        double low = 0.0, high = 0.0;
        std::size_t start = 0;
    };
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < n; ++i) {
        const auto [low, high] = std::minmax(points[i].x(), points[(i + 1) % n].x());
        edges.push_back({low, high, i});
    }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.low < b.low; });
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n && edges[j].low <= edges[i].high; ++j) {
            const std::size_t a = edges[i].start;
            const std::size_t b = edges[j].start;
            if (crosses(points[a], points[(a + 1) % n], points[b], points[(b + 1) % n])) {
                char where[64];
                std::snprintf(where, sizeof where, "%.0f, %.0f mm", 1e3 * points[a].x(),
                              1e3 * points[a].y());
                throw Error("piece '" + piece.name + "': its outline crosses itself near " + where);
            }
        }
    }
}

} // namespace

double signed_area(const std::span<const Vec2d> outline) {
    double sum = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        sum += 0.5 * cross(outline[i], outline[(i + 1) % outline.size()]);
    }
    return sum;
}

void check_piece(PatternPiece& piece) {
    const std::string name = "piece '" + piece.name + "'";
    std::vector<Vec2d> kept;
    for (const Vec2d& p : piece.outline) {
        if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kFarthest) {
            throw Error(name + ": a point is not finite or farther than 20 m from the origin");
        }
        if (kept.empty() || (p - kept.back()).norm() > kLeastStep) {
            kept.push_back(p);
        }
    }
    while (kept.size() > 1 && (kept.front() - kept.back()).norm() <= kLeastStep) {
        kept.pop_back();
    }
    if (kept.size() > kMostPoints) {
        throw Error(name + ": its outline has more than 20,000 points");
    }
    if (kept.size() < 3 || std::abs(signed_area(kept)) < 1e-5) {
        throw Error(name + ": its outline has no area (less than 0.1 cm2)");
    }
    if (signed_area(kept) < 0.0) {
        std::reverse(kept.begin(), kept.end());
    }
    piece.outline = std::move(kept);
    refuse_crossings(piece);
}

std::vector<PatternPiece> read_drafted_pieces(const std::string_view json,
                                              const std::string& name) {
    const nlohmann::json root = parse_json(json, name);
    JsonObject object(root, name);
    std::vector<PatternPiece> pieces;
    for (JsonObject& entry : object.objects("pieces")) {
        PatternPiece& piece = pieces.emplace_back();
        piece.name = entry.text("name");
        const std::string place = name + ": piece '" + piece.name + "'";
        for (const auto& point : entry.any("outline")) {
            piece.outline.push_back(read_point(point, place + ", outline"));
        }
        for (const auto& [id, point] : entry.any("points").items()) {
            piece.points.emplace(id, read_point(point, place + ", point '" + id + "'"));
        }
        entry.finish();
        check_piece(piece);
    }
    object.finish();
    return pieces;
}

OutlineWalk::OutlineWalk(const std::span<const Vec2d> outline)
    : points_(outline.begin(), outline.end()), sums_{0.0} {
    points_.push_back(points_.front());
    for (std::size_t i = 1; i < points_.size(); ++i) {
        sums_.push_back(sums_.back() + (points_[i] - points_[i - 1]).norm());
    }
}

double OutlineWalk::project(const Vec2d& point, double& distance_m) const {
    double best = 0.0;
    distance_m = 1e9;
    for (std::size_t i = 1; i < points_.size(); ++i) {
        const Vec2d along = points_[i] - points_[i - 1];
        const double t =
            std::clamp((point - points_[i - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        const double d = (points_[i - 1] + t * along - point).norm();
        if (d < distance_m - 1e-9) {
            distance_m = d;
            best = sums_[i - 1] + t * along.norm();
        }
    }
    return best >= length() - 1e-9 ? 0.0 : best;
}

Vec2d OutlineWalk::at(const double place) const {
    const double s = std::clamp(place, 0.0, length());
    const auto next = std::upper_bound(sums_.begin(), sums_.end() - 1, s);
    const auto i = static_cast<std::size_t>(next - sums_.begin());
    const double piece = sums_[i] - sums_[i - 1];
    const double t = piece > 0.0 ? (s - sums_[i - 1]) / piece : 0.0;
    return points_[i - 1] + t * (points_[i] - points_[i - 1]);
}

std::vector<Vec2d> OutlineWalk::between(const double from, const double to) const {
    std::vector<Vec2d> out{at(from)};
    const double end = to > from + 1e-9 ? to : to + length();
    for (int lap = 0; lap < 2; ++lap) {
        for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
            const double s = sums_[i] + lap * length();
            if (s > from + kLeastStep && s < end - kLeastStep) {
                out.push_back(points_[i]);
            }
        }
    }
    out.push_back(at(end > length() ? end - length() : end));
    return out;
}

} // namespace toile::garment::block
