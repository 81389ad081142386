#include "core/json.h"
#include "garment/pattern_piece.h"
#include "garment/placed_pattern.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::garment::block {
namespace {

using nlohmann::json;

constexpr std::size_t kMostPanels = 200;
constexpr std::size_t kMostEdges = 200; // of one panel
constexpr int kPieces = 32;             // straight pieces of a curved edge

// The file with the name of what is being read, for errors.
struct Place {
    std::string file;
    double unit = 0.01; // metres

    [[nodiscard]] Error error(const std::string& what) const { return Error(file + ": " + what); }
};

double number(const json& value, const Place& place, const std::string& what) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
        throw place.error(what + " is not a number");
    }
    return value.get<double>();
}

std::vector<double> numbers(const json& value, const std::size_t count, const Place& place,
                            const std::string& what) {
    if (!value.is_array() || value.size() != count) {
        throw place.error(what + " is not a list of " + std::to_string(count) + " numbers");
    }
    std::vector<double> out;
    for (const json& item : value) {
        out.push_back(number(item, place, what));
    }
    return out;
}

// Relative coordinates: x along the edge, y to its left, in lengths of the edge.
Vec2d absolute(const Vec2d& start, const Vec2d& end, const json& relative, const Place& place,
               const std::string& what) {
    const auto r = numbers(relative, 2, place, what);
    const Vec2d along = end - start;
    return start + r[0] * along + r[1] * Vec2d(-along.y(), along.x());
}

std::vector<Vec2d> circle(const Vec2d& start, const Vec2d& end, const double radius,
                          const bool large, const bool turns_left, const Place& place,
                          const std::string& what) {
    const double chord = (end - start).norm();
    if (!(radius >= 0.5 * chord * (1.0 - 1e-6))) {
        throw place.error(what + ": its circle is smaller than its chord");
    }
    const Vec2d middle = 0.5 * (start + end);
    const Vec2d left = Vec2d(-(end - start).y(), (end - start).x()) / chord;
    const double height = std::sqrt(std::max(0.0, radius * radius - 0.25 * chord * chord));
    const Vec2d centre = middle + (large == turns_left ? -height : height) * left;
    const Vec2d from = start - centre;
    const Vec2d to = end - centre;
    double angle = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
    if (turns_left && angle < 0.0) {
        angle += 2.0 * std::numbers::pi;
    }
    if (!turns_left && angle > 0.0) {
        angle -= 2.0 * std::numbers::pi;
    }
    std::vector<Vec2d> out;
    for (int i = 0; i <= kPieces; ++i) {
        const double a = angle * i / kPieces;
        out.push_back(centre + Vec2d(std::cos(a) * from.x() - std::sin(a) * from.y(),
                                     std::sin(a) * from.x() + std::cos(a) * from.y()));
    }
    return out;
}

std::vector<Vec2d> curve_of(const json& edge, const Vec2d& start, const Vec2d& end,
                            const Place& place, const std::string& what) {
    if (!edge.contains("curvature")) {
        return {start, end};
    }
    const json& curvature = edge["curvature"];
    if (curvature.is_array()) { // the older form: one control point
        const Vec2d c = absolute(start, end, curvature, place, what);
        return bezier(start, start + 2.0 / 3.0 * (c - start), end + 2.0 / 3.0 * (c - end), end);
    }
    const std::string type = curvature.value("type", "");
    const json& params = curvature.contains("params") ? curvature["params"] : json();
    if (type == "quadratic" && params.is_array() && params.size() == 1) {
        const Vec2d c = absolute(start, end, params[0], place, what);
        return bezier(start, start + 2.0 / 3.0 * (c - start), end + 2.0 / 3.0 * (c - end), end);
    }
    if (type == "cubic" && params.is_array() && params.size() == 2) {
        return bezier(start, absolute(start, end, params[0], place, what),
                      absolute(start, end, params[1], place, what), end);
    }
    if (type == "circle" && params.is_array() && params.size() == 3) {
        const auto p = numbers(params, 3, place, what);
        return circle(start, end, p[0] * place.unit, p[1] != 0.0, p[2] != 0.0, place, what);
    }
    throw place.error(what + ": its curvature is none of quadratic, cubic and circle");
}

std::size_t index(const json& value, const std::size_t count, const Place& place,
                  const std::string& what) {
    if (!value.is_number_integer() || value.get<std::int64_t>() < 0 ||
        value.get<std::uint64_t>() >= count) {
        throw place.error(what + " names nothing that exists");
    }
    return value.get<std::size_t>();
}

void read_border(const json& value, const Place& place, SpatialPanel& panel) {
    const std::string what = "panel '" + panel.name + "'";
    std::vector<Vec2d> vertices;
    for (const json& vertex : value.value("vertices", json::array())) {
        const auto p = numbers(vertex, 2, place, what + ", a vertex");
        vertices.emplace_back(p[0] * place.unit, p[1] * place.unit);
    }
    const json edges = value.value("edges", json::array());
    if (!edges.is_array() || edges.size() < 2 || edges.size() > kMostEdges) {
        throw place.error(what + " has fewer than 2 or more than 200 edges");
    }
    std::size_t before = 0;
    std::size_t first = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const std::string edge = what + ", edge " + std::to_string(e);
        const json ends = edges[e].value("endpoints", json::array());
        if (!ends.is_array() || ends.size() != 2) {
            throw place.error(edge + " has no two endpoints");
        }
        const std::size_t a = index(ends[0], vertices.size(), place, edge);
        const std::size_t b = index(ends[1], vertices.size(), place, edge);
        if (e > 0 && a != before) {
            throw place.error(edge + " does not start where the edge before it ends");
        }
        first = e == 0 ? a : first;
        before = b;
        panel.border.push_back(
            {std::to_string(e), curve_of(edges[e], vertices[a], vertices[b], place, edge)});
    }
    if (before != first) {
        throw place.error(what + ": its edges do not close");
    }
    PatternPiece piece;
    piece.name = panel.name;
    for (const Curve& curve : panel.border) {
        piece.outline.insert(piece.outline.end(), curve.points.begin(), curve.points.end() - 1);
    }
    check_piece(piece);
}

SpatialPanel read_panel(const std::string& name, const json& value, const Place& place) {
    SpatialPanel panel;
    panel.name = name;
    panel.label = value.contains("label") && value["label"].is_string()
                      ? value["label"].get<std::string>()
                      : "";
    read_border(value, place, panel);
    const std::string what = "panel '" + name + "'";
    const auto t = numbers(value.value("translation", json::array({0, 0, 0})), 3, place, what);
    const auto r = numbers(value.value("rotation", json::array({0, 0, 0})), 3, place, what);
    const double degree = std::numbers::pi / 180.0;
    panel.place = Eigen::Translation3d(place.unit * Vec3d(t[0], t[1], t[2])) *
                  Eigen::AngleAxisd(r[2] * degree, Vec3d::UnitZ()) *
                  Eigen::AngleAxisd(r[1] * degree, Vec3d::UnitY()) *
                  Eigen::AngleAxisd(r[0] * degree, Vec3d::UnitX());
    return panel;
}

std::pair<std::size_t, std::size_t> read_side(const json& side, const SpatialPattern& pattern,
                                              const Place& place, const std::string& what) {
    const std::string name = side.value("panel", "");
    const auto at = std::find_if(pattern.panels.begin(), pattern.panels.end(),
                                 [&](const SpatialPanel& panel) { return panel.name == name; });
    if (at == pattern.panels.end()) {
        throw place.error(what + " names a panel that does not exist: '" + name + "'");
    }
    return {static_cast<std::size_t>(at - pattern.panels.begin()),
            index(side.value("edge", json()), at->border.size(), place, what)};
}

void read_stitches(const json& stitches, const Place& place, SpatialPattern& pattern) {
    for (std::size_t s = 0; s < stitches.size(); ++s) {
        const std::string what = "stitch " + std::to_string(s);
        if (!stitches[s].is_array() || stitches[s].size() < 2) {
            throw place.error(what + " does not join two edges");
        }
        const auto [pa, ea] = read_side(stitches[s][0], pattern, place, what);
        const auto [pb, eb] = read_side(stitches[s][1], pattern, place, what);
        const double a = length(pattern.panels[pa].border[ea].points);
        const double b = length(pattern.panels[pb].border[eb].points);
        if (std::max(a, b) > 1.5 * std::min(a, b) && std::abs(a - b) > 0.02) {
            throw place.error(
                what + ": edge " + std::to_string(ea) + " of '" + pattern.panels[pa].name + "' (" +
                std::to_string(std::lround(1e3 * a)) + " mm) and edge " + std::to_string(eb) +
                " of '" + pattern.panels[pb].name + "' (" + std::to_string(std::lround(1e3 * b)) +
                " mm) differ too much in length to be sewn together");
        }
        pattern.stitches.push_back({pa, ea, pb, eb});
    }
}

} // namespace

bool is_garmentcode(const std::filesystem::path& file) {
    const json root = parse_json_file(file);
    return root.is_object() && root.contains("pattern") && root["pattern"].contains("panels");
}

SpatialPattern read_garmentcode(const std::filesystem::path& file) {
    const json root = parse_json_file(file);
    Place place;
    place.file = file.string();
    if (root.contains("properties") && root["properties"].contains("units_in_meter")) {
        const double units =
            number(root["properties"]["units_in_meter"], place, "properties.units_in_meter");
        if (!(units >= 0.5 && units <= 2000.0)) {
            throw place.error("properties.units_in_meter is not from 0.5 to 2000");
        }
        place.unit = 1.0 / units;
    }
    const json& body = root["pattern"];
    if (!body["panels"].is_object() || body["panels"].empty() ||
        body["panels"].size() > kMostPanels) {
        throw place.error("pattern.panels is empty, no object or holds more than 200 panels");
    }
    SpatialPattern pattern;
    for (const auto& [name, value] : body["panels"].items()) {
        if (!value.is_object()) {
            throw place.error("panel '" + name + "' is no object");
        }
        pattern.panels.push_back(read_panel(name, value, place));
    }
    read_stitches(body.value("stitches", json::array()), place, pattern);
    return pattern;
}

} // namespace toile::garment::block
