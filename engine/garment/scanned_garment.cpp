#include "garment/scanned_garment.h"

#include "core/error.h"
#include "garment/flatten.h"
#include "garment/import.h"
#include "garment/mend.h"
#include "geometry/clean_up.h"
#include "geometry/cut.h"
#include "geometry/decimate.h"
#include "geometry/nearest_surface.h"
#include "geometry/point_tree.h"
#include "geometry/remesh.h"

#include <algorithm>
#include <cmath>

namespace toile::garment {
namespace {

constexpr double kLeastArea = 0.05;     // m^2
constexpr std::size_t kVertices = 3000; // of the sheet
constexpr float kCapDown = -0.75f;      // y of the normal of what closes a hem
constexpr float kCapGap = 0.02f;        // metres off the skin
constexpr std::size_t kSmallHole = 24;  // edges: filled
constexpr int kPictureSide = 1024;      // pixels
constexpr float kPinned = 0.025f;       // metres below the upper edge
constexpr float kTouches = 0.02f;       // metres off the skin
constexpr double kShoulders = 0.79;     // of the stature: what reaches there hangs by itself

geometry::TriangleMesh without_caps(const geometry::CutMesh& cut, std::span<const float> gaps) {
    geometry::TriangleMesh out;
    out.positions = cut.mesh.positions;
    for (const Triangle& t : cut.mesh.triangles) {
        const Vec3f n = (out.positions[t[1]] - out.positions[t[0]])
                            .cross(out.positions[t[2]] - out.positions[t[0]])
                            .normalized();
        float gap = 0.0f;
        for (const std::uint32_t v : t)
            gap = std::max(gap, gaps[cut.from[v].a]);
        if (n.y() < kCapDown && gap > kCapGap) continue;
        out.triangles.push_back(t);
    }
    return out;
}

geometry::TriangleMesh fewer(const geometry::TriangleMesh& mesh, std::size_t count) {
    const geometry::Decimation kept = geometry::decimate(mesh, count);
    geometry::TriangleMesh out;
    for (const std::uint32_t v : kept.vertices)
        out.positions.push_back(mesh.positions[v]);
    out.triangles = kept.triangles;
    return out;
}

/// About `kVertices` even triangles on the same sheet.
geometry::TriangleMesh even(const geometry::TriangleMesh& sheet) {
    const geometry::NearestSurface surface(sheet.positions, sheet.triangles);
    const double edge =
        std::sqrt(geometry::surface_area(sheet) / (0.866 * static_cast<double>(kVertices)));
    geometry::RemeshOptions options;
    options.edge_length = [edge](const Vec3f&) { return static_cast<float>(edge); };
    options.project = [&](const Vec3f& p) { return surface.nearest(p).point; };
    return geometry::remesh(
        sheet.positions.size() > 4 * kVertices ? fewer(sheet, 3 * kVertices) : sheet, options);
}

/// Triangles that no chart could place keep their own shape, beside the others.
void lay_lost(ScannedGarment& out) {
    Vec2f corner(0.0f, 0.0f);
    for (const Vec2f& c : out.coords)
        if (c.allFinite()) corner = corner.cwiseMax(c);
    for (std::size_t i = 0; i < out.mesh.triangles.size(); ++i) {
        Vec2f* const c = out.coords.data() + 3 * i;
        if (c[0].allFinite() && c[1].allFinite() && c[2].allFinite()) continue;
        const Triangle& t = out.mesh.triangles[i];
        const Vec3f along = out.mesh.positions[t[1]] - out.mesh.positions[t[0]];
        const Vec3f other = out.mesh.positions[t[2]] - out.mesh.positions[t[0]];
        const float base = std::max(along.norm(), 1e-4f);
        const float foot = other.dot(along) / base;
        const float height = std::max(along.cross(other).norm() / base, 1e-4f);
        c[0] = corner;
        c[1] = corner + Vec2f(base, 0.0f);
        c[2] = corner + Vec2f(foot, height);
        corner.x() += base + 0.002f;
    }
}

/// Paints the charts, a texel's width beyond their edges too.
void paint(const geometry::TriangleMesh& scan, std::span<const std::array<std::uint8_t, 4>> colors,
           ScannedGarment& out) {
    Eigen::AlignedBox2f box;
    for (const Vec2f& c : out.coords)
        box.extend(c);
    const float scale = 0.98f / std::max(box.sizes().maxCoeff(), 1e-6f);
    for (const Vec2f& c : out.coords) {
        const Vec2f at = Vec2f::Constant(0.01f) + scale * (c - box.min());
        out.texcoords.emplace_back(at.x(), 1.0f - at.y());
    }
    if (colors.empty()) return;
    const geometry::PointTree points(scan.positions);
    out.picture.width = out.picture.height = kPictureSide;
    const auto side = static_cast<std::size_t>(kPictureSide);
    out.picture.pixels.assign(4 * side * side, 255);
    std::vector<float> how(side * side, -1e9f); // deepest triangle wins
    for (std::size_t i = 0; i < out.mesh.triangles.size(); ++i) {
        std::array<Vec2f, 3> p;
        for (std::size_t k = 0; k < 3; ++k)
            p[k] = static_cast<float>(kPictureSide) * out.texcoords[3 * i + k];
        const float area =
            (p[1] - p[0]).x() * (p[2] - p[0]).y() - (p[1] - p[0]).y() * (p[2] - p[0]).x();
        if (std::abs(area) < 1e-6f) continue;
        const auto low = [&](int k) { return std::min({p[0][k], p[1][k], p[2][k]}) - 2.0f; };
        const auto high = [&](int k) { return std::max({p[0][k], p[1][k], p[2][k]}) + 2.0f; };
        for (int y = std::max(0, static_cast<int>(low(1)));
             y < std::min(kPictureSide, static_cast<int>(high(1)) + 1); ++y)
            for (int x = std::max(0, static_cast<int>(low(0)));
                 x < std::min(kPictureSide, static_cast<int>(high(0)) + 1); ++x) {
                const Vec2f q(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                Vec3f w;
                for (int k = 0; k < 3; ++k) {
                    const auto a = static_cast<std::size_t>((k + 1) % 3),
                               b = static_cast<std::size_t>((k + 2) % 3);
                    w[k] =
                        ((p[a] - q).x() * (p[b] - q).y() - (p[a] - q).y() * (p[b] - q).x()) / area;
                }
                const float depth = w.minCoeff();
                const auto texel = static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x);
                if (depth < -0.6f || depth <= how[texel]) continue;
                how[texel] = depth;
                Vec3f place = Vec3f::Zero();
                for (std::size_t k = 0; k < 3; ++k)
                    place += w[static_cast<Eigen::Index>(k)] *
                             out.mesh.positions[out.mesh.triangles[i][k]];
                const auto& color = colors[points.nearest(place).index];
                std::copy_n(color.data(), 3, out.picture.pixels.data() + 4 * texel);
            }
    }
}

/// Drawn as it is simulated, cut where its texture coordinates are.
assets::Scene render_of(const ScannedGarment& garment, const std::vector<Vec3f>& positions) {
    assets::Scene scene;
    assets::Material cloth;
    cloth.name = "cloth";
    cloth.roughness = 0.95f;
    cloth.double_sided = true;
    assets::Primitive primitive;
    std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> cut;
    for (std::size_t i = 0; i < garment.mesh.triangles.size(); ++i) {
        Triangle corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = garment.mesh.triangles[i][k];
            const Vec2f& at = garment.texcoords[3 * i + k];
            const auto [place, added] = cut.try_emplace(
                {v, at.x(), at.y()}, static_cast<std::uint32_t>(primitive.positions.size()));
            if (added) {
                primitive.positions.push_back(positions[v]);
                primitive.texcoords.push_back(at);
            }
            corners[k] = place->second;
        }
        primitive.triangles.push_back(corners);
    }
    if (!garment.picture.pixels.empty()) {
        scene.textures.push_back({"scan", garment.picture, false});
        cloth.base_color_texture = 0;
    }
    scene.materials.push_back(cloth);
    primitive.material = 0;
    scene.meshes.push_back({"render", {std::move(primitive)}, {}});
    assets::Node node;
    node.name = "render";
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

} // namespace

ScannedGarment separate_garment(const geometry::TriangleMesh& scan,
                                std::span<const std::array<std::uint8_t, 4>> colors,
                                const ClothCover& cover) {
    std::vector<float> field;
    field.reserve(cover.cloth.size());
    for (const float c : cover.cloth)
        field.push_back(c - 0.5f);
    const geometry::CutMesh cut = geometry::cut_where(scan, field, false);
    geometry::CleanUpOptions options;
    options.smoothing = 0.3;
    options.largest_hole = kSmallHole;
    const geometry::TriangleMesh open = without_caps(cut, cover.gaps);
    if (geometry::surface_area(open) < kLeastArea)
        throw Error("hardly any cloth was found on the mannequin: it must differ from the "
                    "mannequin in colour, or stand off it");
    const geometry::CleanMesh sheet = geometry::clean_up(open, options);
    ScannedGarment out;
    const geometry::TriangleMesh regular = even(sheet.mesh);
    out.mesh = mend(regular.positions, regular.triangles).mesh; // what was pinched stands apart
    out.mesh.normals.resize(out.mesh.positions.size());
    geometry::vertex_normals(out.mesh.positions, out.mesh.triangles, out.mesh.normals);
    out.coords = flatten(out.mesh, {}).coords;
    lay_lost(out);
    paint(scan, colors, out);
    return out;
}

GarmentPackage package_scanned(const ScannedGarment& garment, std::vector<Vec3f> positions,
                               std::span<const float> gaps, double stature_m,
                               const ScannedPackageOptions& options) {
    GarmentPackage out;
    Manifest& m = out.manifest;
    m.id = options.id;
    m.version = "0.1.0";
    m.name = options.id;
    m.maker = "unknown";
    m.licence = "not stated";
    m.kind = "garment";
    m.made_on = options.made_on;
    m.fabric = usual_fabric("garment");
    GarmentSize size;
    size.entry.name = "scanned";
    size.entry.mesh = "scanned.glb";
    for (const char* name : {"bust_girth", "waist_girth", "hip_girth"})
        if (const auto at = options.wearer.find(name); at != options.wearer.end())
            size.entry.chart[name] = {at->second - 0.03, at->second + 0.03};
    float top = -1e9f;
    for (const Vec3f& p : positions)
        top = std::max(top, p.y());
    if (static_cast<double>(top) < kShoulders * stature_m) {
        PinGroup pins;
        pins.name = "upper edge";
        for (std::uint32_t v = 0; v < positions.size(); ++v)
            if (positions[v].y() > top - kPinned && gaps[v] < kTouches) pins.vertices.push_back(v);
        if (!pins.vertices.empty()) m.pins.push_back(std::move(pins));
    }
    size.render = render_of(garment, positions);
    size.simulation.positions = std::move(positions);
    size.simulation.triangles = garment.mesh.triangles;
    size.material_coords = garment.coords;
    m.sizes.push_back(size.entry);
    out.sizes.push_back(std::move(size));
    return out;
}

} // namespace toile::garment
