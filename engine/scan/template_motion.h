// Where a rough template stood in each view: known at some instants, in between along the way.
#pragma once

#include "scan/deformation_graph.h"

#include <map>

namespace toile::scan {

/// The template's vertices before the camera, at the numbers of some views; the first is that of
/// the scan.
using TemplatePoses = std::map<std::uint32_t, std::vector<Vec3f>>;

/// How the subject moved as a whole: scan from camera, by the numbers of views.
using WholeMotion = std::map<std::uint32_t, Pose>;

/// The rigid motion of most of the template, from `from` to `to` (nv each); limbs that moved count
/// less.
[[nodiscard]] Pose whole_motion(std::span<const Vec3f> from, std::span<const Vec3f> to);

/// At any view, between those that are known: evenly, and `about` (in what they lead to) goes
/// straight. Before the first and after the last as there. Not of none.
[[nodiscard]] Pose turned_evenly(const WholeMotion& known, std::uint32_t number,
                                 const Vec3d& about);

/// (nn) scan from camera of each node at any view. The whole moves as `whole` says; where that does
/// not know a view, it turns evenly about the template's middle from instant to instant. Within it
/// each node goes its own way between two instants.
class TemplateMotion {
  public:
    /// \throw Error when there is no instant, or one of another number of vertices
    TemplateMotion(const DeformationGraph& graph, const TemplatePoses& poses,
                   WholeMotion whole = {});

    [[nodiscard]] std::vector<Pose> at(std::uint32_t number) const;

  private:
    struct Instant {
        Pose whole;              ///< scan from camera, of all of it
        std::vector<Pose> nodes; ///< (nn) beside that: in the scan's coordinates
    };
    [[nodiscard]] Pose whole_at(std::uint32_t number) const;

    const DeformationGraph& graph_;
    WholeMotion whole_, at_instants_;
    Vec3d middle_ = Vec3d::Zero();
    std::map<std::uint32_t, Instant> instants_;
};

} // namespace toile::scan
