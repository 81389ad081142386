#include "body/measurement.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace toile::body {
namespace {

/// Letters that must change to make one word the other (Levenshtein).
std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t corner = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = corner + (a[i] == b[j] ? 0 : 1);
            corner = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, corner + 1});
        }
    }
    return row.back();
}

Reading taken(Survey& survey, const MeasurementDefinition& definition) {
    survey.begin();
    Reading reading = definition.read(survey);
    if (!std::isfinite(reading.value_m) || reading.value_m <= 0.0) return {};
    return reading;
}

} // namespace

const MeasurementDefinition& measurement_definition(std::string_view name) {
    const MeasurementDefinition* nearest = nullptr;
    std::size_t least = 0;
    for (const MeasurementDefinition& d : measurement_definitions()) {
        if (d.name == name) return d;
        const std::size_t distance = edits(name, d.name);
        if (nearest != nullptr && distance >= least) continue;
        least = distance;
        nearest = &d;
    }
    throw Error("no measurement is called '" + std::string(name) + "'; did you mean '" +
                std::string(nearest->name) + "'?");
}

std::vector<const MeasurementDefinition*>
measurement_definitions(std::span<const std::string> names) {
    std::vector<const MeasurementDefinition*> out;
    for (const std::string& name : names)
        out.push_back(&measurement_definition(name));
    return out;
}

Measurements measure(const Figure& figure,
                     std::span<const MeasurementDefinition* const> definitions) {
    Survey survey(figure);
    Measurements out;
    out.reserve(definitions.size());
    for (const MeasurementDefinition* d : definitions) {
        const Reading reading = taken(survey, *d);
        out.push_back({d->name, reading.value_m, reading.confidence});
    }
    return out;
}

std::vector<LaidMeasurement> lay_tapes(const Figure& figure,
                                       std::span<const MeasurementDefinition* const> definitions) {
    Survey survey(figure);
    std::vector<LaidMeasurement> out;
    out.reserve(definitions.size());
    for (const MeasurementDefinition* d : definitions)
        out.push_back({d, taken(survey, *d)});
    return out;
}

double girth_at_same_place(const Reading& girth, std::span<const Vec3f> positions,
                           std::span<const Triangle> triangles, double reach_m) {
    if (!girth.cut || girth.tapes.empty()) return 0.0;
    const std::vector<Vec3f>& hull = girth.tapes.front().points; // around the plane's normal
    const auto outside = [&](const Vec3f& p) {
        float most = -std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < hull.size(); ++i) {
            const Vec3f side = hull[(i + 1) % hull.size()] - hull[i];
            most = std::max(most, side.cross(girth.cut->normal).normalized().dot(p - hull[i]));
        }
        return static_cast<double>(most);
    };
    std::vector<Vec3f> points;
    for (const geometry::Loop& loop : geometry::slice(positions, triangles, *girth.cut)) {
        if (outside(loop.centroid()) > 0.0) continue; // of a neighbour, such as the other thigh
        std::copy_if(loop.points.begin(), loop.points.end(), std::back_inserter(points),
                     [&](const Vec3f& p) { return outside(p) <= reach_m; });
    }
    return geometry::hull_girth(points, *girth.cut);
}

} // namespace toile::body
