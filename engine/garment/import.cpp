#include "garment/import.h"

#include "assets/files.h"
#include "garment/flatten.h"
#include "garment/manifest_reader.h"
#include "garment/mend.h"
#include "garment/openings.h"
#include "garment/pose_match.h"
#include "garment/size_reader.h"
#include "geometry/nearest_surface.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace toile::garment {
namespace {

/// printf into a string.
template <typename... Values>
std::string say(const char* format, Values... values) {
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

/// All vertices and triangles of a render scene; texture coordinates per vertex where there are.
struct Joined {
    std::vector<Vec3f> positions;
    std::vector<Vec2f> texcoords;
    std::vector<Triangle> triangles;
    bool textured = true;
};

Joined join(const assets::Scene& scene) {
    Joined out;
    for (const assets::Mesh& mesh : scene.meshes)
        for (const assets::Primitive& p : mesh.primitives) {
            const auto base = static_cast<std::uint32_t>(out.positions.size());
            out.positions.insert(out.positions.end(), p.positions.begin(), p.positions.end());
            out.textured = out.textured && p.texcoords.size() == p.positions.size();
            out.texcoords.insert(out.texcoords.end(), p.texcoords.begin(), p.texcoords.end());
            for (const Triangle& t : p.triangles)
                out.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
        }
    if (!out.textured) out.texcoords.clear();
    return out;
}

/// Takes a mesh named `simulation` out of what is drawn, where the file has it beside others.
std::optional<assets::Scene> take_simulation(assets::Scene& drawn) {
    std::vector<std::size_t> cloth, others;
    for (std::size_t i = 0; i < drawn.nodes.size(); ++i)
        (is_simulation(drawn, drawn.nodes[i]) ? cloth : others).push_back(i);
    if (cloth.empty() || others.empty()) return std::nullopt;
    assets::Scene out, rest;
    append_nodes(drawn, cloth, out);
    append_nodes(drawn, others, rest);
    drawn = std::move(rest);
    return out;
}

void transform(assets::Scene& scene, const Eigen::Affine3f& move) {
    const Mat3f for_normals = move.linear().inverse().transpose();
    for (assets::Mesh& mesh : scene.meshes)
        for (assets::Primitive& p : mesh.primitives) {
            for (Vec3f& x : p.positions)
                x = move * x;
            for (Vec3f& n : p.normals)
                n = (for_normals * n).normalized();
        }
}

void tell_placement(const Placement& p, const ImportOptions& options,
                    std::vector<std::string>& findings) {
    findings.push_back("the mesh is in " + std::string(unit_name(p.unit)) +
                       (options.unit ? " (as told)" : " (judged by its size)"));
    if (p.z_up) findings.emplace_back("its Z axis points up: turned to Y");
    if (p.faces_back) findings.emplace_back("it faced backwards: turned round");
    if (options.made_on.empty()) return;
    if (p.shift.norm() > 0.0f)
        findings.push_back(say("moved by (%.3f, %.3f, %.3f) m onto '%s'",
                               static_cast<double>(p.shift.x()), static_cast<double>(p.shift.y()),
                               static_cast<double>(p.shift.z()), options.made_on.c_str()));
    findings.push_back(say("it lies %.0f mm from the skin of '%s' on average; %.0f %% of its "
                           "vertices are inside, which binding pushes out",
                           1000.0 * p.mean_distance, options.made_on.c_str(), 100.0 * p.inside));
}

void tell_mending(const MendedMesh& mended, std::vector<std::string>& findings) {
    const auto tell = [&findings](std::size_t count, const char* what) {
        if (count > 0) findings.push_back(std::to_string(count) + " " + what);
    };
    findings.push_back(say("the simulation mesh has %zu vertices and %zu triangles",
                           mended.mesh.positions.size(), mended.mesh.triangles.size()));
    tell(mended.merged_vertices, "vertices stood within 0.02 mm of another: merged");
    tell(mended.dropped_triangles, "triangles had no area or stood twice: dropped");
    tell(mended.turned_triangles, "triangles faced the other way than their neighbours: turned");
    tell(mended.cut_edges, "edges had more than two triangles: cut open");
    if (mended.mesh.positions.size() > 6000)
        findings.emplace_back("that is more than the 3,000 or so that real time allows: simplify "
                              "it in a 3D program for the mirror");
}

/// Pieces that face the body are turned inside out.
std::size_t turn_outwards(const geometry::TriangleMesh& body, MendedMesh& mended) {
    const geometry::NearestSurface nearest(body.positions, body.triangles);
    double agreement = 0.0;
    for (const Triangle& t : mended.mesh.triangles) {
        const auto& p = mended.mesh.positions;
        const Vec3f n = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
        const auto hit = nearest.nearest((p[t[0]] + p[t[1]] + p[t[2]]) / 3.0f);
        agreement += static_cast<double>(n.dot(hit.normal));
    }
    if (agreement >= 0.0) return 0;
    for (std::size_t i = 0; i < mended.corners.size(); ++i) {
        std::swap(mended.mesh.triangles[i][1], mended.mesh.triangles[i][2]);
        std::swap(mended.corners[i][1], mended.corners[i][2]);
    }
    return mended.corners.size();
}

std::vector<Vec2f> corner_texcoords(const MendedMesh& mended, const Joined& joined) {
    std::vector<Vec2f> out;
    if (!joined.textured) return out;
    for (const Triangle& corners : mended.corners)
        for (const std::uint32_t v : corners)
            out.push_back(joined.texcoords[v]);
    return out;
}

/// True when it was modelled in another pose; the scene then holds it in this one.
bool lay_into_pose(const body::BodyModel& body, const Joined& joined, assets::Scene& render,
                   std::vector<std::string>& findings) {
    std::vector<Vec3f> positions = joined.positions;
    const PoseMatch match = match_pose(body, joined.triangles, positions);
    if (!match.moved()) return false;
    std::size_t v = 0;
    for (assets::Mesh& mesh : render.meshes)
        for (assets::Primitive& p : mesh.primitives)
            for (std::size_t i = 0; i < p.positions.size(); ++i, ++v) {
                p.positions[i] = positions[v];
                if (!p.normals.empty()) p.normals[i] = (match.turns[v] * p.normals[i]).normalized();
            }
    findings.push_back(match.text());
    return true;
}

/// Tells what the mesh is made of; true when pins are proposed.
bool propose(const body::BodyModel& body, const geometry::TriangleMesh& garment, Import& out) {
    const std::vector<Piece> pieces = find_pieces(garment, body);
    for (std::string& line : tell_pieces(pieces))
        out.findings.push_back(std::move(line));
    out.package.manifest.pins = propose_pins(garment, pieces);
    for (const PinGroup& group : out.package.manifest.pins)
        out.findings.push_back("pins proposed: " + group.name +
                               (group.mask.empty() ? " (all of a hat or of shoes)"
                                                   : " (the upper border, so that it does not "
                                                     "slip down)"));
    return !out.package.manifest.pins.empty();
}

Manifest start_manifest(const ImportOptions& options) {
    if (!is_identifier(options.id))
        throw Error("the id '" + options.id +
                    "' must be 1 to 64 of a-z, 0-9, - and _, starting with a letter");
    if (!is_identifier(options.kind))
        throw Error("the kind '" + options.kind + "' must be written like an id: t-shirt");
    Manifest m;
    m.id = options.id;
    m.version = "0.1.0";
    m.name = options.name.empty() ? options.id : options.name;
    m.maker = options.maker;
    m.licence = options.licence;
    m.kind = options.kind;
    m.layer = options.layer;
    m.made_on = options.made_on;
    m.fabric = usual_fabric(options.kind);
    return m;
}

} // namespace

Fabric usual_fabric(const std::string& kind) {
    const auto is = [&kind](std::initializer_list<const char*> kinds) {
        return std::any_of(kinds.begin(), kinds.end(),
                           [&kind](const char* k) { return kind == k; });
    };
    if (is({"t-shirt", "top", "vest", "leggings"}))
        return {"cotton jersey", 0.16, 0.0006, 300.0, 200.0, 60.0, 5e-6, 4e-6, 0.4, 0.5};
    if (is({"jeans", "trousers", "jacket", "coat", "suit"}))
        return {"cotton twill", 0.26, 0.0008, 1800.0, 1500.0, 300.0, 3e-5, 2.5e-5, 0.45, 0.5};
    if (is({"blouse", "dress", "scarf"}))
        return {"viscose", 0.12, 0.0003, 700.0, 600.0, 80.0, 3e-6, 2.5e-6, 0.3, 0.4};
    return {"cotton", 0.18, 0.0005, 900.0, 800.0, 150.0, 9e-6, 8e-6, 0.4, 0.5};
}

Import import_garment(const std::filesystem::path& mesh, const ImportOptions& options,
                      const body::BodyModel* body) {
    Import out;
    const bool labelled = body != nullptr && !body->parts.empty();
    out.package.manifest = start_manifest(options);
    const assets::Scene scene = assets::load_scene(mesh);
    GarmentSize size;
    append_nodes(scene, nodes_with_meshes(scene), size.render);
    Joined joined = join(size.render);
    if (joined.triangles.empty()) throw FileError(mesh.string(), "has no mesh");

    const Placement placement = body != nullptr
                                    ? place_on_body(joined.positions, body->rest, options.unit)
                                    : place_freely(joined.positions, options.unit);
    transform(size.render, placement.transform());
    joined = join(size.render);
    tell_placement(placement, options, out.findings);
    if (labelled && lay_into_pose(*body, joined, size.render, out.findings))
        joined = join(size.render);
    if (const auto cloth = take_simulation(size.render)) {
        joined = join(*cloth);
        out.findings.emplace_back("its mesh 'simulation' is the cloth, the others are drawn");
    }
    for (std::size_t i = 0; i < size.render.nodes.size(); ++i)
        size.render.nodes[i].name = "render" + (i == 0 ? "" : std::to_string(i));
    for (assets::Mesh& drawn : size.render.meshes)
        drawn.name = "render";

    MendedMesh mended = mend(joined.positions, joined.triangles);
    if (body != nullptr) {
        const std::size_t turned = turn_outwards(body->rest, mended);
        if (turned > 0) out.findings.emplace_back("it was inside out: turned");
    }
    tell_mending(mended, out.findings);
    if (mended.mesh.triangles.empty())
        throw FileError(mesh.string(), "has no triangle with an area");

    const Flattening flat = flatten(mended.mesh, corner_texcoords(mended, joined));
    out.findings.push_back(
        say("material coordinates: %zu charts %s, laid flat with a mean strain of "
            "%.1f %%; %zu triangles that do not flatten keep their own shape",
            flat.charts, joined.textured ? "along the texture's seams" : "by direction",
            100.0 * flat.mean_strain, flat.loose_triangles));
    if (scene.textures.empty()) out.findings.emplace_back("it has no textures: one plain colour");
    const bool pinned = labelled && propose(*body, mended.mesh, out);

    size.simulation = std::move(mended.mesh);
    size.material_coords = flat.coords;
    size.entry.name = options.size_name;
    size.entry.chart = options.chart;
    size.entry.mesh = options.size_name + ".glb";
    out.package.manifest.sizes.push_back(size.entry);
    out.package.sizes.push_back(std::move(size));
    const ImportOptions usual;
    std::string open;
    if (options.maker == usual.maker) open += "maker, ";
    if (options.licence == usual.licence) open += "licence, ";
    if (options.kind == usual.kind) open += "kind, ";
    if (options.chart.empty()) open += "size chart, ";
    if (!pinned) open += "pins where it must not slip, ";
    out.findings.emplace_back("to fill in by hand in garment.json: " + open +
                              "the true fabric (taken: " + out.package.manifest.fabric.name + ")");
    return out;
}

} // namespace toile::garment
