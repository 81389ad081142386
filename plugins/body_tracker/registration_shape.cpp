// Derivatives by shape: used in the first seconds only.
#include "body_tracker/registration.h"

#include <cmath>

namespace toile::body_tracker {

using body::kJointCount;

constexpr std::size_t kCells = 600; // readings of a frame that are enough

void Registration::linearise_shape(const SeenPerson& seen, const RegistrationOptions& options,
                                   int shapes, Eigen::MatrixXd& normal, Eigen::VectorXd& gradient) {
    RegistrationOptions fewer = options;
    fewer.most_cells = kCells;
    rows_.clear();
    recording_ = true;
    find_visible(seen);
    add_readings(seen, fewer);
    add_extra(seen, fewer);
    add_outline(seen, fewer);
    add_soles(seen, options);
    recording_ = false;
    const Eigen::MatrixXf joints = joint_moves(shapes);
    const int surface = shapes + kWearCount, size = surface + body::kPoseUnknowns;
    Eigen::MatrixXf sums = Eigen::MatrixXf::Zero(size + 1, size + 1);
    Eigen::VectorXf line(size + 1);
    for (const Row& row : rows_) {
        line.setZero();
        line.head(shapes) = shape_motion(row, joints);
        line.segment<kWearCount>(shapes) = wear_motion(row);
        PlaceMotion motion;
        body_.motion(posed_, row.triangle, row.weights, row.at, row.along, motion);
        for (std::size_t k = 0; k < static_cast<std::size_t>(motion.count); ++k)
            line.segment<3>(surface + motion.start[k]) = motion.block[k];
        line[size] = row.residual;
        sums.selfadjointView<Eigen::Lower>().rankUpdate(line, row.weight);
    }
    normal = Eigen::MatrixXf(sums.selfadjointView<Eigen::Lower>())
                 .topLeftCorner(size, size)
                 .cast<double>();
    gradient = sums.row(size).head(size).cast<double>().transpose();
}

/// How the joints move with each coefficient, along the chain of bones (3 joints x shapes).
Eigen::MatrixXf Registration::joint_moves(int shapes) const {
    const body::ShapeRows& local = body_.model().joint_components();
    Eigen::MatrixXf out = Eigen::MatrixXf::Zero(3 * kJointCount, shapes);
    for (std::size_t j = 1; j < kJointCount; ++j) {
        const auto p = static_cast<std::size_t>(*body::joint_parent(static_cast<body::Joint>(j)));
        const auto at = static_cast<int>(3 * j), from = static_cast<int>(3 * p);
        out.middleRows<3>(at) =
            out.middleRows<3>(from) +
            posed_.joints[p].rotation.toRotationMatrix() *
                (local.block(at, 0, 3, shapes) - local.block(from, 0, 3, shapes));
    }
    return out;
}

/// How row.along . x changes with each coefficient (shapes).
Eigen::VectorXf Registration::shape_motion(const Row& row, const Eigen::MatrixXf& joints) const {
    const auto shapes = static_cast<int>(joints.cols());
    const body::FitLevel& level = body_.level();
    const body::ShapeRows& local = body_.model().joint_components();
    Eigen::RowVectorXf out = Eigen::RowVectorXf::Zero(shapes);
    const Triangle& corners = level.triangles[static_cast<std::size_t>(row.triangle)];
    for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = corners[c];
        if (row.weights[c] == 0.0f) continue;
        const Vec3f rest = posed_.rotations[v].conjugate() * row.along;
        out += row.weights[c] *
               (rest.transpose() * level.components.block(static_cast<int>(3 * v), 0, 3, shapes));
        for (std::size_t k = 0; k < 4; ++k) {
            const float w = row.weights[c] * level.skin.weights[v][k];
            if (w == 0.0f) continue;
            const int j = level.skin.joints[v][k];
            const Vec3f turned =
                posed_.joints[static_cast<std::size_t>(j)].rotation.conjugate() * row.along;
            out += w * (row.along.transpose() * joints.middleRows<3>(3 * j) -
                        turned.transpose() * local.block(3 * j, 0, 3, shapes));
        }
    }
    return out.transpose();
}

/// And with each part of what is worn.
Eigen::Vector<float, kWearCount> Registration::wear_motion(const Row& row) const {
    Eigen::Vector<float, kWearCount> out = Eigen::Vector<float, kWearCount>::Zero();
    const body::FitLevel& level = body_.level();
    const Triangle& corners = level.triangles[static_cast<std::size_t>(row.triangle)];
    for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = corners[c];
        const float outwards =
            row.weights[c] * row.along.dot(posed_.rotations[v] * level.mean_normals[v]);
        for (int part = 0; part < kWearCount; ++part)
            out[part] += outwards * body_.worn(v)[static_cast<std::size_t>(part)];
    }
    return out;
}

} // namespace toile::body_tracker
