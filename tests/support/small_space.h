// A body space of 66 vertices as files, for tests of what reads them.
#pragma once

#include "body/avatar_files.h"
#include "body/body_space.h"
#include "body/pose_tables.h"
#include "body/table_file.h"
#include "core/bytes.h"
#include "support/meshes.h"
#include "unit/body/body_fixture.h"

#include <numeric>

namespace toile::test {

/// A sphere in two components; its level is the octahedron that it was made of.
inline body::BodyModel small_model() {
    body::BodyModel out;
    out.id = "small";
    out.version = "1.0.0";
    out.name = "Small";
    out.rest = sphere(0.8f, 2);
    const std::size_t nv = out.rest.positions.size();
    for (Vec3f& p : out.rest.positions)
        p.y() += 0.8f;
    out.rest.normals.resize(nv);
    geometry::vertex_normals(out.rest.positions, out.rest.triangles, out.rest.normals);
    out.layout.welded.resize(nv);
    std::iota(out.layout.welded.begin(), out.layout.welded.end(), 0u);
    out.layout.triangles = out.rest.triangles;
    out.skeleton = adult_skeleton();
    out.skin.joints.assign(nv, {0, 1, 0, 0});
    out.skin.weights.assign(nv, {0.75f, 0.25f, 0.0f, 0.0f});
    out.parts.assign(nv, body::Part::torso);
    out.landmarks["navel"] = 4;
    out.measurements["stature"] = 1.6;
    for (const float step : {0.01f, -0.02f}) {
        body::ShapeComponent component;
        component.name = "shape_" + std::to_string(out.shape.size() + 1);
        for (const Vec3f& p : out.rest.positions)
            component.vertex_offsets.emplace_back(step * p.x(), 0.0f, step * p.z());
        component.joint_offsets.fill(Vec3f(0.0f, step, 0.0f));
        out.shape.push_back(std::move(component));
    }
    return out;
}

/// Writes `model` into a folder with all that makes it a space.
inline void write_space(body::BodyModel model, const std::filesystem::path& folder) {
    model.folder = folder;
    save_body_model(model, {}, "Made by a test.\n", folder);
    nlohmann::ordered_json json;
    json["schema"] = 1;
    for (const body::Sex sex : body::kSexes)
        json["coefficients"][sex_name(sex)] = {{"mean", {0.5, -0.25}},
                                               {"covariance", {1.0, 0.25, 0.25, 0.5}}};
    json["levels"] = {"octahedron"};
    json["tables"] = "space.tables";
    write_text(folder / "space.json", json.dump() + "\n");
    body::TableWriter tables;
    tables.integers("octahedron_vertices", std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5});
    std::vector<std::uint32_t> corners;
    for (const Triangle& t : sphere(1.0f, 0).triangles)
        corners.insert(corners.end(), t.begin(), t.end());
    tables.integers("octahedron_triangles", corners);
    tables.write(folder / "space.tables");
    body::PoseTables poses;
    const std::size_t nf = model.rest.triangles.size(), nv = model.rest.positions.size();
    poses.deformation.joints.assign(nf, {0, 1, 2, 3});
    poses.deformation.weights.assign(nf, Eigen::Matrix<float, 6, body::kPoseFeatures>::Ones());
    poses.correctives.joints.assign(nv, {0, 1, 2, 3});
    poses.correctives.weights.assign(nv, Eigen::Matrix<float, 3, body::kPoseFeatures>::Ones());
    save_pose_tables(poses, model);
}

} // namespace toile::test
