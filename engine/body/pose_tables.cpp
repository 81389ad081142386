#include "body/pose_tables.h"

#include "body/table_file.h"
#include "core/error.h"

namespace toile::body {
namespace {

constexpr const char* kFile = "pose.tables";

std::vector<std::uint32_t> flatten(const std::vector<NearJoints>& joints) {
    std::vector<std::uint32_t> out;
    for (const auto& group : joints)
        out.insert(out.end(), group.begin(), group.end());
    return out;
}

std::vector<NearJoints> joints_of(const TableReader& tables, const std::string& name,
                                  std::size_t count, const std::string& file) {
    const auto flat = tables.integers(name, static_cast<std::uint32_t>(kJointCount));
    if (flat.size() != count * kNearJoints)
        throw FileError(file, "table '" + name + "' does not fit the model beside it");
    std::vector<NearJoints> out(count);
    for (std::size_t i = 0; i < flat.size(); ++i)
        out[i / kNearJoints][i % kNearJoints] = static_cast<std::uint8_t>(flat[i]);
    return out;
}

/// One row of numbers for each small matrix, its columns one after the other.
template <class Matrix>
Eigen::MatrixXf stack(const std::vector<Matrix>& matrices) {
    Eigen::MatrixXf out(static_cast<int>(matrices.size()), Matrix::SizeAtCompileTime);
    for (std::size_t i = 0; i < matrices.size(); ++i)
        out.row(static_cast<int>(i)) =
            Eigen::Map<const Eigen::RowVectorXf>(matrices[i].data(), Matrix::SizeAtCompileTime);
    return out;
}

template <class Matrix>
std::vector<Matrix> unstack(const TableReader& tables, const std::string& name, std::size_t count) {
    constexpr int kSize = Matrix::SizeAtCompileTime;
    const Eigen::MatrixXf rows = tables.numbers(name, count, kSize);
    std::vector<Matrix> out(count);
    for (std::size_t i = 0; i < count; ++i)
        Eigen::Map<Eigen::RowVectorXf>(out[i].data(), kSize) = rows.row(static_cast<int>(i));
    return out;
}

} // namespace

void save_pose_tables(const PoseTables& tables, const BodyModel& model) {
    TableWriter out;
    out.integers("triangle_joints", flatten(tables.deformation.joints));
    out.numbers("triangle_deformation", stack(tables.deformation.weights));
    out.integers("vertex_joints", flatten(tables.correctives.joints));
    out.numbers("vertex_correctives", stack(tables.correctives.weights));
    out.write(model.folder / kFile);
}

PoseTables load_pose_tables(const BodyModel& model) {
    const std::filesystem::path file = model.folder / kFile;
    const TableReader in(file);
    const std::size_t nf = model.rest.triangles.size(), nv = model.rest.positions.size();
    PoseTables out;
    out.deformation.joints = joints_of(in, "triangle_joints", nf, file.string());
    out.deformation.weights =
        unstack<Eigen::Matrix<float, 9, kPoseFeatures>>(in, "triangle_deformation", nf);
    out.correctives.joints = joints_of(in, "vertex_joints", nv, file.string());
    out.correctives.weights =
        unstack<Eigen::Matrix<float, 3, kPoseFeatures>>(in, "vertex_correctives", nv);
    return out;
}

} // namespace toile::body
