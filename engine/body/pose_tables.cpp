#include "body/pose_tables.h"

#include "body/table_file.h"
#include "core/error.h"

namespace toile::body {
namespace {

constexpr const char* kScapeFile = "scape.tables";
constexpr const char* kBakedFile = "baked.tables";
constexpr std::uint32_t kAnyWord = 0xffffffffu;

/// Four joints in a word, the nearest in its lowest byte.
std::vector<std::uint32_t> pack(const std::vector<NearJoints>& joints) {
    std::vector<std::uint32_t> out;
    for (const auto& group : joints) {
        std::uint32_t word = 0;
        for (std::size_t i = 0; i < kNearJoints; ++i)
            word |= static_cast<std::uint32_t>(group[i]) << (8 * i);
        out.push_back(word);
    }
    return out;
}

std::vector<NearJoints> unpack(const TableReader& tables, std::size_t count,
                               const std::string& file) {
    const auto words = tables.integers("joints", kAnyWord);
    if (words.size() != count)
        throw FileError(file, "table 'joints' does not fit the model beside it");
    std::vector<NearJoints> out(count);
    for (std::size_t w = 0; w < count; ++w)
        for (std::size_t i = 0; i < kNearJoints; ++i) {
            out[w][i] = static_cast<std::uint8_t>(words[w] >> (8 * i));
            if (out[w][i] >= kJointCount)
                throw FileError(file, "table 'joints' names a joint that does not exist");
        }
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
std::vector<Matrix> unstack(const TableReader& tables, std::size_t count) {
    constexpr int kSize = Matrix::SizeAtCompileTime;
    const Eigen::MatrixXf rows = tables.numbers("weights", count, kSize);
    std::vector<Matrix> out(count);
    for (std::size_t i = 0; i < count; ++i)
        Eigen::Map<Eigen::RowVectorXf>(out[i].data(), kSize) = rows.row(static_cast<int>(i));
    return out;
}

} // namespace

void save_pose_tables(const PoseTables& tables, const BodyModel& model) {
    TableWriter scape, baked;
    scape.integers("joints", pack(tables.deformation.joints));
    scape.numbers("weights", stack(tables.deformation.weights));
    scape.write(model.folder / kScapeFile);
    baked.integers("joints", pack(tables.correctives.joints));
    baked.numbers("weights", stack(tables.correctives.weights));
    baked.write(model.folder / kBakedFile);
}

PoseTables load_pose_tables(const BodyModel& model) {
    const std::filesystem::path scape_file = model.folder / kScapeFile;
    const std::filesystem::path baked_file = model.folder / kBakedFile;
    const TableReader scape(scape_file), baked(baked_file);
    const std::size_t nf = model.rest.triangles.size(), nv = model.rest.positions.size();
    PoseTables out;
    out.deformation.joints = unpack(scape, nf, scape_file.string());
    out.deformation.weights = unstack<Eigen::Matrix<float, 6, kPoseFeatures>>(scape, nf);
    out.correctives.joints = unpack(baked, nv, baked_file.string());
    out.correctives.weights = unstack<Eigen::Matrix<float, 3, kPoseFeatures>>(baked, nv);
    return out;
}

} // namespace toile::body
