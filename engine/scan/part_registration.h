// A body's parts laid on each other view by view, the trunk first and each limb after what it hangs
// on (P4 2.3).
#pragma once

#include "core/row_loop.h"
#include "geometry/nearest_surface.h"
#include "scan/registration.h"
#include "scan/warped_view.h"

#include <limits>

namespace toile::scan {

/// What moves as one, in the order in which it is registered.
enum class BodyGroup : std::uint8_t {
    trunk,
    head,
    left_upper_arm,
    left_lower_arm,
    right_upper_arm,
    right_lower_arm,
    left_upper_leg,
    left_lower_leg,
    right_upper_leg,
    right_lower_leg,
};
inline constexpr std::size_t kGroupCount = 10;

/// What a group hangs on; the trunk on itself.
[[nodiscard]] BodyGroup parent_of(BodyGroup group);

/// The template's joints and which of its nodes and vertices belong to which group.
class PartLayout {
  public:
    /// `shape`: the template in the scan's pose; `groups` (nv). \throw Error for another number
    PartLayout(const DeformationGraph& graph, const geometry::TriangleMesh& shape,
               std::span<const BodyGroup> groups);

    /// (nn)
    [[nodiscard]] const std::vector<BodyGroup>& node_groups() const { return node_groups_; }
    /// Of a place that is bound so.
    [[nodiscard]] BodyGroup group(const NodeBinding& binding) const {
        return node_groups_[binding.nodes[0]];
    }
    /// Where a group meets its parent, in the scan's coordinates.
    [[nodiscard]] const Vec3d& joint(BodyGroup group) const {
        return joints_[static_cast<std::size_t>(group)];
    }
    /// Whether `group` hangs on `on`, or is it.
    [[nodiscard]] static bool hangs_on(BodyGroup group, BodyGroup on);

    /// (nn)
    [[nodiscard]] const std::vector<Vec3f>& node_places() const { return node_places_; }

  private:
    std::vector<BodyGroup> node_groups_;
    std::vector<Vec3f> node_places_;
    std::array<Vec3d, kGroupCount> joints_;
};

struct PartRegistrationOptions {
    float start_reach_m = 0.08f, end_reach_m = 0.02f;
    float angle = 0.9f; ///< most between normals, radians
    int stride = 3;
    int rounds = 6;
    int follow_rounds = 3;      ///< of binding and laying on the template
    double least_share = 0.3;   ///< of the usual number of readings; a part with fewer is left out
    double most_apart_m = 0.04; ///< a limb that leaves its joint farther is left out
};

struct PartRegistrationReport {
    std::size_t left_out = 0; ///< parts of views: hidden, or torn off
};

/// One pass of P4 2.3: trunk, then limbs in the order of their dependencies, each from view to view
/// and then against all that `pairs` names beside it. Readings of parts that are left out are
/// unbound.
PartRegistrationReport register_parts(const PartLayout& layout, std::span<const ViewPair> pairs,
                                      const PartRegistrationOptions& options,
                                      std::vector<WarpedView>& views, const RowLoop& rows);

/// Lays each view's readings on the template, part by part in the same order: what the body was
/// told to do between two instants is made right. `shape`: the template in the scan's pose, as a
/// tree and as triangles.
void follow_parts(const DeformationGraph& graph, const PartLayout& layout,
                  const geometry::TriangleMesh& shape, const geometry::NearestSurface& surface,
                  const PartRegistrationOptions& options, std::vector<WarpedView>& views,
                  const RowLoop& rows);

/// Unbinds readings of limbs that are far from a template which elsewhere is near: those farther
/// than `most_off_m`, and whole limbs of views of which `least_near` is not within `near_m`; of the
/// trunk those farther than `trunk_off_m`. Returns the number of whole limbs.
struct AstrayOptions {
    float near_m = 0.015f, most_off_m = 0.03f;
    float trunk_off_m = std::numeric_limits<float>::infinity();
    double least_near = 0.6;
};
std::size_t leave_out_astray(const PartLayout& layout, const geometry::NearestSurface& surface,
                             const AstrayOptions& options, std::vector<WarpedView>& views,
                             const RowLoop& rows);

/// Root mean square of how far readings are from what the other view of a pair saw there, along the
/// normals; those farther than `reach_m`, or that face elsewhere, count as that.
[[nodiscard]] double residual(std::span<const WarpedView> views, std::span<const ViewPair> pairs,
                              float reach_m, const RowLoop& rows);

} // namespace toile::scan
