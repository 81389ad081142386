#include "garment/openings.h"

#include "core/error.h"
#include "geometry/nearest_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

namespace toile::garment {
namespace {

using body::Part;

constexpr std::size_t kParts = 13;
constexpr double kStiff = 0.6; // share of a piece beside head or feet
constexpr float kBelowShoulder =
    0.04f; // metres: cloth higher than this below a shoulder's joint hangs on it
constexpr double kShort = 0.05; // metres: shorter borders are holes of the mesh, not openings

/// Where each vertex of a garment lies.
struct Place {
    Part part = Part::invalid;
    float gap_m = 0.0f;
    bool stiff = false;
};

bool is_stiff(const body::BodyModel& body, std::uint32_t vertex) {
    float share = 0.0f;
    for (std::size_t k = 0; k < 4; ++k) {
        const auto joint = static_cast<body::Joint>(body.skin.joints[vertex][k]);
        const bool foot = joint == body::Joint::left_foot || joint == body::Joint::right_foot ||
                          joint == body::Joint::left_toes || joint == body::Joint::right_toes;
        if (foot || joint == body::Joint::head) share += body.skin.weights[vertex][k];
    }
    return share > 0.5f;
}

std::vector<Place> places_of(const geometry::TriangleMesh& garment, const body::BodyModel& body) {
    if (body.parts.size() != body.rest.positions.size())
        throw Error("body " + body.id + " has no part labels");
    const geometry::NearestSurface skin(body.rest.positions, body.rest.triangles);
    std::vector<Place> out;
    out.reserve(garment.positions.size());
    for (const Vec3f& p : garment.positions) {
        const geometry::SurfacePoint hit = skin.nearest(p);
        Eigen::Index corner = 0;
        hit.barycentric.maxCoeff(&corner);
        const std::uint32_t v = body.rest.triangles[hit.triangle][static_cast<std::size_t>(corner)];
        out.push_back({body.parts[v], std::abs(hit.signed_distance), is_stiff(body, v)});
    }
    return out;
}

/// Number of each vertex's piece.
std::vector<std::uint32_t> pieces_by_edges(const geometry::TriangleMesh& mesh) {
    std::vector<std::uint32_t> root(mesh.positions.size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&root](std::uint32_t v) {
        while (root[v] != v)
            v = root[v] = root[root[v]];
        return v;
    };
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 1; k < 3; ++k) {
            const std::uint32_t a = find(t[0]);
            const std::uint32_t b = find(t[k]);
            root[std::max(a, b)] = std::min(a, b);
        }
    for (std::uint32_t v = 0; v < root.size(); ++v)
        root[v] = find(v);
    return root;
}

Part most_frequent(std::span<const std::uint32_t> vertices, const std::vector<Place>& places) {
    std::array<std::size_t, kParts> counts{};
    for (const std::uint32_t v : vertices)
        ++counts[static_cast<std::size_t>(places[v].part)];
    return static_cast<Part>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

/// Borders of a manifold mesh: each vertex of one has one next.
std::vector<Opening> borders(const geometry::TriangleMesh& mesh, const std::vector<Place>& places) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> edges;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            edges[{t[k], t[(k + 1) % 3]}] = true;
    std::map<std::uint32_t, std::uint32_t> next;
    for (const auto& [edge, one] : edges)
        if (!edges.contains({edge.second, edge.first})) next[edge.second] = edge.first;
    std::vector<Opening> out;
    while (!next.empty()) {
        Opening opening;
        std::uint32_t v = next.begin()->first;
        for (auto at = next.find(v); at != next.end(); at = next.find(v)) {
            opening.vertices.push_back(v);
            v = at->second;
            opening.length_m += static_cast<double>(
                (mesh.positions[v] - mesh.positions[opening.vertices.back()]).norm());
            next.erase(at);
        }
        if (opening.length_m < kShort) continue;
        opening.around = most_frequent(opening.vertices, places);
        out.push_back(std::move(opening));
    }
    return out;
}

void describe(const geometry::TriangleMesh& garment, const std::vector<Place>& places,
              float shoulders, Piece& piece) {
    constexpr double kLeastShare = 0.05;
    std::array<std::size_t, kParts> counts{};
    double gap = 0.0;
    std::size_t stiff = 0;
    for (const std::uint32_t v : piece.vertices) {
        ++counts[static_cast<std::size_t>(places[v].part)];
        gap += static_cast<double>(places[v].gap_m);
        stiff += places[v].stiff ? 1 : 0;
        piece.on_shoulders = piece.on_shoulders || garment.positions[v].y() > shoulders;
    }
    const auto count = static_cast<double>(piece.vertices.size());
    piece.gap_m = gap / count;
    piece.stiff = static_cast<double>(stiff) / count;
    for (std::size_t p = 1; p < kParts; ++p)
        if (static_cast<double>(counts[p]) >= kLeastShare * count)
            piece.parts.push_back(static_cast<Part>(p));
}

std::string part_words(Part part) {
    std::string out(body::part_label(part));
    std::replace(out.begin(), out.end(), '_', ' ');
    return out;
}

std::string list(const std::vector<Part>& parts) {
    std::string out;
    for (const Part part : parts)
        out += (out.empty() ? "" : ", ") + part_words(part);
    return out;
}

/// The border that a piece hangs from: around the trunk, with nearly all of the piece below it.
const Opening* waistband(const geometry::TriangleMesh& garment, const Piece& piece) {
    constexpr float kAbove = 0.03f;     // metres
    constexpr double kMostAbove = 0.02; // share of the piece
    if (piece.on_shoulders) return nullptr;
    for (const Opening& opening : piece.openings) {
        if (opening.around != Part::pelvis && opening.around != Part::torso) continue;
        float highest = garment.positions[opening.vertices[0]].y();
        for (const std::uint32_t v : opening.vertices)
            highest = std::max(highest, garment.positions[v].y());
        const auto above =
            std::count_if(piece.vertices.begin(), piece.vertices.end(), [&](std::uint32_t v) {
                return garment.positions[v].y() > highest + kAbove;
            });
        if (static_cast<double>(above) <= kMostAbove * static_cast<double>(piece.vertices.size()))
            return &opening;
    }
    return nullptr;
}

/// 1 on the border, less on each ring of vertices within it.
void hold_border(const geometry::TriangleMesh& garment, const Opening& border,
                 std::vector<float>& mask) {
    constexpr std::array<float, 3> kStrength{1.0f, 0.35f, 0.1f};
    const auto rows = geometry::vertex_adjacency(garment.positions.size(), garment.triangles);
    std::vector<std::uint32_t> ring = border.vertices;
    std::vector<bool> seen(garment.positions.size(), false);
    for (const std::uint32_t v : ring)
        seen[v] = true;
    for (const float strength : kStrength) {
        std::vector<std::uint32_t> next;
        for (const std::uint32_t v : ring) {
            mask[v] = strength;
            for (std::uint32_t k = rows.first[v]; k < rows.first[v + 1]; ++k)
                if (!seen[rows.neighbours[k]]) {
                    seen[rows.neighbours[k]] = true;
                    next.push_back(rows.neighbours[k]);
                }
        }
        ring = std::move(next);
    }
}

/// Parts that both lie beside.
std::vector<Part> shared_parts(const Piece& a, const Piece& b) {
    std::vector<Part> out;
    std::set_intersection(a.parts.begin(), a.parts.end(), b.parts.begin(), b.parts.end(),
                          std::back_inserter(out));
    return out;
}

} // namespace

std::vector<Piece> find_pieces(const geometry::TriangleMesh& garment, const body::BodyModel& body) {
    const std::vector<Place> places = places_of(garment, body);
    const std::vector<std::uint32_t> root = pieces_by_edges(garment);
    const float shoulders = body.skeleton.rest(body::Joint::left_upper_arm).y() - kBelowShoulder;
    std::map<std::uint32_t, Piece> by_root;
    for (std::uint32_t v = 0; v < root.size(); ++v)
        by_root[root[v]].vertices.push_back(v);
    for (Opening& opening : borders(garment, places))
        by_root[root[opening.vertices[0]]].openings.push_back(std::move(opening));
    std::vector<Piece> out;
    for (auto& [first, piece] : by_root) {
        describe(garment, places, shoulders, piece);
        std::stable_sort(
            piece.openings.begin(), piece.openings.end(),
            [](const Opening& a, const Opening& b) { return a.length_m > b.length_m; });
        out.push_back(std::move(piece));
    }
    std::stable_sort(out.begin(), out.end(), [](const Piece& a, const Piece& b) {
        return a.vertices.size() > b.vertices.size();
    });
    return out;
}

std::vector<PinGroup> propose_pins(const geometry::TriangleMesh& garment,
                                   const std::vector<Piece>& pieces) {
    PinGroup stiff;
    stiff.name = "stiff";
    PinGroup band;
    band.name = "waistband";
    band.mask.assign(garment.positions.size(), 0.0f);
    bool banded = false;
    for (const Piece& piece : pieces) {
        if (piece.stiff >= kStiff) {
            stiff.vertices.insert(stiff.vertices.end(), piece.vertices.begin(),
                                  piece.vertices.end());
        } else if (const Opening* border = waistband(garment, piece)) {
            hold_border(garment, *border, band.mask);
            banded = true;
        }
    }
    std::vector<PinGroup> out;
    std::sort(stiff.vertices.begin(), stiff.vertices.end());
    if (!stiff.vertices.empty()) out.push_back(std::move(stiff));
    if (banded) out.push_back(std::move(band));
    return out;
}

std::vector<std::string> tell_pieces(const std::vector<Piece>& pieces) {
    constexpr std::size_t kMostTold = 8;
    std::vector<std::string> out;
    for (std::size_t i = 0; i < std::min(pieces.size(), kMostTold); ++i) {
        const Piece& piece = pieces[i];
        std::string text = "piece " + std::to_string(i + 1) + " of " +
                           std::to_string(pieces.size()) + ": on " + list(piece.parts) + ", " +
                           std::to_string(std::lround(1e3 * piece.gap_m)) + " mm from the skin; ";
        if (piece.openings.empty()) text += "no opening";
        for (std::size_t k = 0; k < piece.openings.size(); ++k)
            text += (k == 0 ? "openings: " : ", ") + part_words(piece.openings[k].around) + " (" +
                    std::to_string(std::lround(100.0 * piece.openings[k].length_m)) + " cm)";
        out.push_back(std::move(text));
        for (std::size_t j = 0; j < i; ++j) {
            const std::vector<Part> both = shared_parts(piece, pieces[j]);
            if (both.empty() || piece.stiff >= kStiff || pieces[j].stiff >= kStiff) continue;
            const bool over = piece.gap_m > pieces[j].gap_m;
            out.push_back("piece " + std::to_string(over ? i + 1 : j + 1) + " lies over piece " +
                          std::to_string(over ? j + 1 : i + 1) + " on " + list(both) +
                          ": one file for each, with layers of their own, lets them move apart");
        }
    }
    if (pieces.size() > kMostTold)
        out.push_back("and " + std::to_string(pieces.size() - kMostTold) + " smaller pieces");
    return out;
}

} // namespace toile::garment
