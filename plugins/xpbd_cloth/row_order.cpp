#include "xpbd_cloth/row_order.h"

#include "cloth/body_places.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile::xpbd_cloth {
namespace {

/// Every third bit from the ten lowest.
std::uint32_t spread(std::uint32_t bits) {
    std::uint32_t out = 0;
    for (std::uint32_t b = 0; b < 10; ++b) {
        out |= ((bits >> b) & 1u) << (3 * b);
    }
    return out;
}

/// Numbers of the points along the curve.
std::vector<std::uint32_t> along_curve(std::span<const Vec3f> points) {
    Vec3f low = points.front();
    Vec3f high = low;
    for (const Vec3f& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const float per_metre = 1023.0f / std::max((high - low).maxCoeff(), 1e-6f);
    std::vector<std::uint32_t> code;
    for (const Vec3f& p : points) {
        const Eigen::Vector3i cell = ((p - low) * per_metre).cast<int>();
        code.push_back(spread(std::uint32_t(cell.x())) | spread(std::uint32_t(cell.z())) << 1 |
                       spread(std::uint32_t(cell.y())) << 2);
    }
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return code[a] < code[b]; });
    return order;
}

std::vector<Vec3f> centres(const cloth::ClothMesh& mesh) {
    std::vector<Vec3f> out;
    for (const Triangle& t : mesh.triangles) {
        out.emplace_back((mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) /
                         3.0f);
    }
    return out;
}

} // namespace

OrderedGarment::OrderedGarment(const cloth::GarmentInput& in) : input_(in) {
    cloth::check(in.mesh, in.fabric);
    cloth::check_areas(in.mesh);
    cloth::check_skin(in.joints, in.weights, in.mesh.positions.size());
    const std::vector<float> attachment = cloth::attachments(in);
    vertex = along_curve(in.mesh.positions);
    std::vector<std::uint32_t> row(vertex.size());
    for (std::uint32_t r = 0; r < vertex.size(); ++r) {
        const std::uint32_t v = vertex[r];
        row[v] = r;
        positions_.push_back(in.mesh.positions[v]);
        joints_.push_back(in.joints[v]);
        weights_.push_back(in.weights[v]);
        attachment_.push_back(attachment[v]);
    }
    for (const std::uint32_t t : along_curve(centres(in.mesh))) {
        const Triangle& corner = in.mesh.triangles[t];
        triangles_.push_back({row[corner[0]], row[corner[1]], row[corner[2]]});
        for (std::size_t k = 3 * t; k < 3 * t + 3 && !in.mesh.corner_coords.empty(); ++k) {
            corner_coords_.push_back(in.mesh.corner_coords[k]);
        }
    }
    for (const auto& seam : in.mesh.seams) {
        seams_.push_back({row[seam[0]], row[seam[1]]});
    }
    input_.mesh = {positions_, triangles_, corner_coords_, seams_};
    input_.joints = joints_;
    input_.weights = weights_;
    input_.attachment = attachment_;
}

} // namespace toile::xpbd_cloth
