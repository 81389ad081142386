// A view of a subject that moved: which nodes of a deformation graph its readings belong to, and
// how these bring them back to where they were in the first frame.
#pragma once

#include "scan/deformation_graph.h"
#include "scan/volume.h"

#include <optional>

namespace toile::scan {

/// Readings of a view in the scan's coordinates, one for each pixel; NaN where there is none.
struct PulledView {
    std::vector<Vec3f> points, normals;
};

struct WarpedView {
    DepthView view;
    std::vector<Pose> base;            ///< (nn) scan from camera, as the template has it
    std::vector<Pose> moved;           ///< (nn) what registration adds, in the scan's coordinates
    std::vector<Warp> motions;         ///< (nn) moved * base
    std::vector<NodeBinding> bindings; ///< (pixels); the first weight is 0 where there is none

    /// After `moved` changed.
    void update_motions();
    /// What was found counts as the template's own motion from here on.
    void settle();
    /// Camera from scan of each node.
    [[nodiscard]] std::vector<Warp> inverse_motions() const;
    [[nodiscard]] bool bound(std::size_t pixel) const { return bindings[pixel].weights[0] > 0.0f; }
};

struct BindingOptions {
    float reach_m = 0.15f;   ///< farther from the template is nobody's: hair and skirts lie within
    float opposed_m = 0.02f; ///< a template that faces away must be as near as this
};

/// (nv) the template's vertices as the motions place them before the camera.
[[nodiscard]] std::vector<Vec3f> posed_template(const DeformationGraph& graph,
                                                std::span<const Vec3f> positions,
                                                std::span<const Warp> camera_from_scan);

/// Binds each reading to the nodes of the nearest place of the template, posed by the motions; with
/// a stride only those of every so many columns and rows.
void bind(const DeformationGraph& graph, const geometry::TriangleMesh& shape,
          const BindingOptions& options, WarpedView& view, int stride = 1);

[[nodiscard]] PulledView pulled(const WarpedView& view);

/// A view made ready to be compared with others.
struct PreparedView {
    PulledView pulled;
    std::vector<Warp> inverse; ///< (nn) camera from scan
};
[[nodiscard]] PreparedView prepared(const WarpedView& view);

/// The pixel where `to` sees the place of a reading of `from` (in the scan's coordinates, moved by
/// `binding`); false when it sees nothing there.
[[nodiscard]] bool find_partner(const NodeBinding& binding, const Vec3f& place,
                                const WarpedView& to, const PreparedView& to_at,
                                std::size_t& pixel);

/// Median motion of the nodes: where the camera stands to the most of the subject.
[[nodiscard]] Pose overall_pose(const WarpedView& view, const DeformationGraph& graph);

} // namespace toile::scan
