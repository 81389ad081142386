#include "mannequin_scan/scan_session.h"

#include "core/error.h"

#include <algorithm>
#include <cstdio>

namespace toile::mannequin_scan {
namespace {

struct Unit {
    const char* name;
    double metres;
};
constexpr std::array<Unit, 6> kUnits = {
    {{"m", 1.0}, {"mm", 0.001}, {"cm", 0.01}, {"inch", 0.0254}, {"dm", 0.1}, {"foot", 0.3048}}};
constexpr float kSmallest = 1.0f, kTallest = 2.4f; // metres
constexpr float kUpright = 0.85f;                  // of the largest extent: arms may be spread

/// Joints in the space of "up", "legs" and "arms": where the skin around each is on the mean adult.
constexpr std::array<std::array<double, 3>, body::kJointCount> kJointAxes = {{
    {-0.35, 0.00, 0.00},   // hips
    {0.05, 0.00, 0.00},    // spine
    {0.37, 0.00, 0.00},    // chest
    {0.68, 0.00, 0.00},    // upperChest
    {0.92, 0.00, 0.00},    // neck
    {0.98, 0.00, 0.00},    // head
    {0.86, 0.00, 0.08},    // leftShoulder
    {0.89, 0.00, 0.63},    // leftUpperArm
    {1.22, 0.00, 1.93},    // leftLowerArm
    {1.55, 0.00, 3.15},    // leftHand
    {0.86, 0.00, -0.08},   // rightShoulder
    {0.89, 0.00, -0.63},   // rightUpperArm
    {1.22, 0.00, -1.93},   // rightLowerArm
    {1.55, 0.00, -3.15},   // rightHand
    {-0.18, 0.24, 0.06},   // leftUpperLeg
    {-1.05, 1.37, 0.01},   // leftLowerLeg
    {-1.66, 2.45, -0.01},  // leftFoot
    {-1.74, 2.60, -0.02},  // leftToes
    {-0.18, -0.24, -0.06}, // rightUpperLeg
    {-1.05, -1.37, -0.01}, // rightLowerLeg
    {-1.66, -2.45, 0.01},  // rightFoot
    {-1.74, -2.60, 0.02},  // rightToes
}};
constexpr double kAround = 0.08; // of that space: the ring of skin at a joint

Vec3f extent_of(const geometry::TriangleMesh& mesh) {
    Eigen::AlignedBox3f box;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t)
            if (v < mesh.positions.size() && mesh.positions[v].allFinite())
                box.extend(mesh.positions[v]);
    if (box.isEmpty()) throw Error("the scan has no surface: it needs triangles, not points alone");
    return box.sizes();
}

/// Of the surface's main piece, so that the floor and clutter do not count.
Unit unit_of(const Vec3f& extent) {
    for (const Unit& unit : kUnits) {
        const float size = static_cast<float>(unit.metres) * extent.maxCoeff();
        if (size >= kSmallest && size <= kTallest) return unit;
    }
    char text[200];
    std::snprintf(text, sizeof(text),
                  "nothing in the scan is as large as a person, whatever its unit (its largest "
                  "piece measures %.3g x %.3g x %.3g)",
                  static_cast<double>(extent.x()), static_cast<double>(extent.y()),
                  static_cast<double>(extent.z()));
    throw Error(text);
}

} // namespace

CleanScan clean_scan(const geometry::TriangleMesh& scan, const std::vector<Rgba>& colors) {
    CleanScan out;
    // Points merge within 1/20,000 of the largest extent: 0.1 mm of a person, whatever the unit.
    geometry::CleanUpOptions options;
    options.merge_m = 5e-5f * extent_of(scan).maxCoeff();
    out.clean = geometry::clean_up(scan, options);
    const Vec3f extent = extent_of(out.clean.mesh);
    const Unit unit = unit_of(extent);
    out.unit = unit.name;
    out.metres_per_unit = unit.metres;
    if (extent.y() < kUpright * extent.maxCoeff())
        throw Error("the scan does not stand upright: turn it so that +Y is up and the person "
                    "faces +Z");
    for (Vec3f& p : out.clean.mesh.positions)
        p *= static_cast<float>(unit.metres);
    for (const std::uint32_t v : out.clean.source)
        if (!colors.empty()) out.colors.push_back(colors.at(v));
    try {
        out.parts = body::spectral_parts(out.clean.mesh);
    } catch (const Error& e) {
        out.why_no_parts = e.what();
    }
    return out;
}

std::array<Vec3f, body::kJointCount> joints_of(const geometry::TriangleMesh& mesh,
                                               const body::SpectralParts& parts) {
    std::array<Vec3f, body::kJointCount> out;
    for (std::size_t j = 0; j < out.size(); ++j) {
        const Eigen::RowVector3d at(kJointAxes[j][0], kJointAxes[j][1], kJointAxes[j][2]);
        const double nearest = (parts.axes.rowwise() - at).rowwise().norm().minCoeff();
        Vec3d sum = Vec3d::Zero();
        double count = 0.0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const double away =
                (parts.axes.row(static_cast<Eigen::Index>(v)) - at).norm() - nearest;
            if (away > kAround) continue;
            sum += mesh.positions[v].cast<double>();
            count += 1.0;
        }
        if (count < 1.0)
            throw Error("no skin around the joint " +
                        std::string(body::joint_name(static_cast<body::Joint>(j))));
        out[j] = (sum / count).cast<float>();
    }
    return out;
}

nlohmann::ordered_json report_of(const CleanScan& scan) {
    const geometry::CleanUpReport& r = scan.clean.report;
    nlohmann::ordered_json out;
    out["unit"] = scan.unit;
    out["metres_per_unit"] = scan.metres_per_unit;
    out["vertices"] = scan.clean.mesh.positions.size();
    out["clean_up"] = {{"merged_points", r.merged_points},
                       {"dropped_triangles", r.dropped_triangles},
                       {"non_manifold_edges", r.non_manifold_edges},
                       {"dropped_pieces", r.dropped_pieces},
                       {"filled_holes", r.filled_holes},
                       {"open_holes", r.open_holes},
                       {"smoothing_rms_m", r.smoothing_rms_m * scan.metres_per_unit}};
    if (!scan.parts) {
        out["parts"] = scan.why_no_parts;
        return out;
    }
    float low = 10.0f, high = -10.0f;
    for (std::size_t v = 0; v < scan.parts->of.size(); ++v) {
        if (scan.parts->of[v] != body::SpectralPart::abdomen) continue;
        low = std::min(low, scan.clean.mesh.positions[v].y());
        high = std::max(high, scan.clean.mesh.positions[v].y());
    }
    out["parts"] = {
        {"eigenvalues", {scan.parts->values[0], scan.parts->values[1], scan.parts->values[2]}},
        {"rounds", scan.parts->rounds},
        {"abdomen_low_m", low},
        {"abdomen_high_m", high}};
    return out;
}

} // namespace toile::mannequin_scan
