#include "body/shape_metric.h"

#include "geometry/laplacian.h"

namespace toile::body {

Eigen::SparseMatrix<float> shape_metric(const AvatarTemplate& avatar,
                                        std::span<const Vec3f> positions, double gradient_weight,
                                        double displacement_weight) {
    const auto& triangles = avatar.mesh.triangles;
    const auto nv = static_cast<int>(positions.size()), half = static_cast<int>(avatar.half);
    const Eigen::VectorXd area =
        geometry::lumped_mass(positions, triangles, geometry::MassKind::barycentric);
    Eigen::SparseMatrix<double> full =
        gradient_weight * geometry::cotangent_laplacian(positions, triangles);
    full += Eigen::SparseMatrix<double>((displacement_weight * area).asDiagonal());

    // Folded to the first half: x of a mirror image counts with opposite sign, y and z alike.
    std::vector<Eigen::Triplet<float>> entries;
    const auto fold = [&](int v) {
        return v < half ? v : static_cast<int>(avatar.mirror_of[static_cast<std::size_t>(v)]);
    };
    for (int v = 0; v < nv; ++v)
        for (Eigen::SparseMatrix<double>::InnerIterator it(full, v); it; ++it) {
            const int w = static_cast<int>(it.row());
            const bool crosses = (v < half) != (w < half);
            for (int k = 0; k < 3; ++k)
                entries.emplace_back(
                    3 * fold(w) + k, 3 * fold(v) + k,
                    static_cast<float>(crosses && k == 0 ? -it.value() : it.value()));
        }
    const int size = 3 * half + 3 * static_cast<int>(kJointCount);
    Eigen::SparseMatrix<float> out(size, size);
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
}

} // namespace toile::body
