// Derivatives by shape: used in the first seconds only.
#include "body_tracker/registration.h"

#include <cmath>

namespace toile::body_tracker {

using body::kJointCount;

constexpr std::size_t kEvery = 3; // cells; no divisor of usual widths

void Registration::linearise_shape(const SeenPerson& seen, const RegistrationOptions& options,
                                   int shapes, Eigen::MatrixXd& normal,
                                   Eigen::VectorXd& gradient) const noexcept {
    const body::FitModel& model = body_.model();
    const body::FitLevel& level = body_.level();
    // World moves of the joints by coefficient, along the chain of bones.
    const body::ShapeRows& local = model.joint_components();
    Eigen::MatrixXf joints = Eigen::MatrixXf::Zero(3 * kJointCount, shapes);
    for (std::size_t j = 1; j < kJointCount; ++j) {
        const auto p = static_cast<std::size_t>(*body::joint_parent(static_cast<body::Joint>(j)));
        const auto at = static_cast<int>(3 * j), from = static_cast<int>(3 * p);
        joints.middleRows<3>(at) =
            joints.middleRows<3>(from) +
            posed_.joints[p].rotation.toRotationMatrix() *
                (local.block(at, 0, 3, shapes) - local.block(from, 0, 3, shapes));
    }
    const int size = shapes + body::kPoseUnknowns;
    Eigen::MatrixXf sums = Eigen::MatrixXf::Zero(size + 1, size + 1);
    Eigen::VectorXf row(size + 1);
    const float information = static_cast<float>(kEvery) * options.cell_information /
                              (options.deviation_m * options.deviation_m);
    for (std::size_t i = 0; i < drawing_.cells.size(); i += kEvery) {
        const DrawnCell& cell = drawing_.cells[i];
        if (cell.depth == 0.0f || seen.mask.cells[i] == 0) continue;
        const float off = cell.depth - seen.grid.depth[i];
        if (std::abs(off) > options.reach_m) continue;
        const Place place = place_of(cell);
        const auto n = static_cast<int>(i);
        const Vec3f ray = camera_.point(static_cast<float>(n % camera_.width),
                                        static_cast<float>(n / camera_.width), 1.0f);
        if (-place.normal.dot(ray) < 0.35f * ray.norm()) continue;
        row.setZero();
        const Triangle& t = level.triangles[static_cast<std::size_t>(cell.triangle)];
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t v = t[c];
            const Vec3f rest = posed_.rotations[v].conjugate() * place.normal;
            row.head(shapes) +=
                place.weights[c] *
                (rest.transpose() * level.components.block(static_cast<int>(3 * v), 0, 3, shapes))
                    .transpose();
            for (std::size_t k = 0; k < 4; ++k) {
                const float w = place.weights[c] * level.skin.weights[v][k];
                if (w == 0.0f) continue;
                const int j = level.skin.joints[v][k];
                const Vec3f turned =
                    posed_.joints[static_cast<std::size_t>(j)].rotation.conjugate() * place.normal;
                row.head(shapes) += w * ((place.normal.transpose() * joints.middleRows<3>(3 * j)) -
                                         turned.transpose() * local.block(3 * j, 0, 3, shapes))
                                            .transpose();
            }
        }
        row.segment<3>(shapes) = place.normal;
        const TriangleJoints& moved = body_.joints_of(cell.triangle);
        for (std::uint8_t k = 0; k < moved.count; ++k) {
            const std::size_t j = moved.joints[k];
            const float share = place.weights[0] * level.below[t[0]][j] +
                                place.weights[1] * level.below[t[1]][j] +
                                place.weights[2] * level.below[t[2]][j];
            Vec3f turn =
                share * (place.position - posed_.joints[j].translation).cross(place.normal);
            if (const auto parent = body::joint_parent(static_cast<body::Joint>(j)))
                turn = posed_.joints[static_cast<std::size_t>(*parent)].rotation.conjugate() * turn;
            row.segment<3>(shapes + 3 + 3 * static_cast<int>(j)) = turn;
        }
        const float residual = place.normal.dot(off * ray);
        row[size] = residual;
        const float s = options.robust_m * options.robust_m;
        const float robust = s / (s + residual * residual);
        sums.selfadjointView<Eigen::Lower>().rankUpdate(row, information * robust * robust);
    }
    normal = Eigen::MatrixXf(sums.selfadjointView<Eigen::Lower>())
                 .topLeftCorner(size, size)
                 .cast<double>();
    gradient = sums.row(size).head(size).cast<double>().transpose();
}

} // namespace toile::body_tracker
