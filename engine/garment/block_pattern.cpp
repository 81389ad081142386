#include "garment/block_pattern.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace toile::garment::block {

std::size_t Pattern::panel_index(const std::string& name) const {
    for (std::size_t i = 0; i < panels.size(); ++i) {
        if (panels[i].name == name) {
            return i;
        }
    }
    throw Error("the pattern has no panel '" + name + "'");
}

const Curve& Pattern::curve(const std::string& panel, const std::string& name) const {
    for (const Curve& curve : panels[panel_index(panel)].border) {
        if (curve.name == name) {
            return curve;
        }
    }
    throw Error("panel '" + panel + "' of the pattern has no edge '" + name + "'");
}

double length(const std::span<const Vec2d> polyline) {
    double sum = 0.0;
    for (std::size_t i = 1; i < polyline.size(); ++i) {
        sum += (polyline[i] - polyline[i - 1]).norm();
    }
    return sum;
}

std::vector<Vec2d> resample(const std::span<const Vec2d> polyline, const std::size_t count) {
    const double total = length(polyline);
    std::vector<Vec2d> out;
    out.reserve(count + 1);
    std::size_t piece = 1;
    double start = 0.0; // of the piece, along the line
    for (std::size_t i = 0; i < count; ++i) {
        const double wanted = total * static_cast<double>(i) / static_cast<double>(count);
        double along = (polyline[piece] - polyline[piece - 1]).norm();
        while (piece + 1 < polyline.size() && start + along < wanted) {
            start += along;
            ++piece;
            along = (polyline[piece] - polyline[piece - 1]).norm();
        }
        const double t = along > 0.0 ? std::min(1.0, (wanted - start) / along) : 0.0;
        out.push_back(polyline[piece - 1] + t * (polyline[piece] - polyline[piece - 1]));
    }
    out.push_back(polyline.back());
    return out;
}

std::vector<Vec2d> bezier(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
    constexpr int kPieces = 64;
    std::vector<Vec2d> out;
    out.reserve(kPieces + 1);
    for (int i = 0; i <= kPieces; ++i) {
        const double t = static_cast<double>(i) / kPieces;
        const double s = 1.0 - t;
        out.push_back(s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d);
    }
    return out;
}

std::vector<Vec2d> arc(const double apex, const double radius, const double angle) {
    constexpr int kPieces = 48;
    std::vector<Vec2d> out;
    for (int i = 0; i <= kPieces; ++i) {
        const double a = angle * i / kPieces;
        out.emplace_back(radius * std::sin(a), apex - radius * std::cos(a));
    }
    return out;
}

std::vector<Vec2d> reversed(std::vector<Vec2d> line) {
    std::reverse(line.begin(), line.end());
    return line;
}

} // namespace toile::garment::block
