#include "scan/warp_fusion.h"

#include "core/error.h"
#include "geometry/nearest_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::scan {
namespace {

/// Camera from scan around a place: as the nearest part of the template moves.
class WarpedPlaces : public ViewPlaces {
  public:
    WarpedPlaces(const DeformationGraph& graph, const geometry::TriangleMesh& shape,
                 const geometry::NearestSurface& surface, const std::vector<WarpedView>& views)
        : graph_(graph), shape_(shape), surface_(surface) {
        for (const WarpedView& view : views)
            inverse_.push_back(view.inverse_motions());
    }

    [[nodiscard]] std::span<const Warp> at(const Vec3f& place,
                                           std::vector<Warp>& space) const override {
        const auto near = surface_.nearest(place);
        const NodeBinding binding = graph_.at(shape_.triangles[near.triangle], near.barycentric);
        space.resize(inverse_.size());
        for (std::size_t i = 0; i < space.size(); ++i)
            space[i] = blended(binding, inverse_[i]);
        return space;
    }

  private:
    const DeformationGraph& graph_;
    const geometry::TriangleMesh& shape_;
    const geometry::NearestSurface& surface_;
    std::vector<std::vector<Warp>> inverse_; // (views) (nn)
};

/// Far where there is nothing.
double median(std::vector<float> values) {
    if (values.empty()) return 1.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return static_cast<double>(*middle);
}

/// All of one scan.
class WarpFusion {
  public:
    WarpFusion(std::vector<NumberedView> views, const MovingTemplate& body,
               const WarpFusionOptions& options, const RowLoop& rows);

    void bind_all();
    void register_parts_first(const PartStage& parts);
    void register_all(const std::function<void(double)>& progress);
    void forget_carried();
    void take_off_bias();
    [[nodiscard]] WarpedSurface surface(const std::optional<geometry::Plane>& floor);

  private:
    void leave_out_astray();
    void warp(std::span<const ViewPair> pairs, float share);
    [[nodiscard]] std::vector<ViewPair> view_pairs() const;
    [[nodiscard]] Volume fused() const;
    [[nodiscard]] double loop_rms() const;
    [[nodiscard]] double surface_rms(const Volume& volume) const;
    [[nodiscard]] std::vector<float> template_distances() const;
    void each_view(const std::function<void(std::size_t)>& work) const {
        rows_(static_cast<std::uint32_t>(views_.size()), 1,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t i = begin; i < end; ++i)
                      work(i);
              });
    }

    const WarpFusionOptions& options_;
    const RowLoop& rows_;
    geometry::TriangleMesh shape_;  // in the scan's coordinates: about the template's middle
    Pose first_ = Pose::Identity(); // scan from the first camera
    DeformationGraph graph_;
    std::optional<geometry::NearestSurface> surface_; // of the template
    std::optional<PartLayout> layout_;                // when the limbs were followed
    std::vector<WarpedView> views_;
    WarpFusionReport report_;
};

WarpFusion::WarpFusion(std::vector<NumberedView> views, const MovingTemplate& body,
                       const WarpFusionOptions& options, const RowLoop& rows)
    : options_(options), rows_(rows), shape_(body.shape), graph_(body.shape, options.nodes) {
    // The template tells its places in the first camera's coordinates.
    const TemplateMotion motion(graph_, body.poses, body.whole);
    std::vector<std::vector<Pose>> bases;
    for (const NumberedView& given : views)
        bases.push_back(motion.at(given.number));
    Vec3d middle = Vec3d::Zero();
    for (const Vec3f& p : shape_.positions)
        middle += p.cast<double>() / static_cast<double>(shape_.positions.size());
    first_.translation() = -middle;
    graph_.shift(-middle.cast<float>());
    for (Vec3f& p : shape_.positions)
        p -= middle.cast<float>();
    surface_.emplace(shape_.positions, shape_.triangles);
    for (std::size_t i = 0; i < views.size(); ++i) {
        WarpedView view;
        view.view = std::move(views[i].view);
        for (const Pose& node : bases[i])
            view.base.push_back(first_ * node);
        view.moved.assign(view.base.size(), Pose::Identity());
        view.update_motions();
        views_.push_back(std::move(view));
    }
}

void WarpFusion::bind_all() {
    each_view([&](std::size_t i) { bind(graph_, shape_, options_.binding, views_[i]); });
    std::size_t read = 0, bound = 0;
    for (const WarpedView& view : views_)
        for (std::size_t p = 0; p < view.bindings.size(); ++p)
            if (view.view.depth[p] > 0.0f) {
                ++read;
                bound += view.bound(p) ? 1 : 0;
            }
    leave_out_astray();
    report_.bound_share = read > 0 ? static_cast<double>(bound) / static_cast<double>(read) : 0.0;
}

/// Where the template is the person's own surface, limbs that are elsewhere were not followed.
void WarpFusion::leave_out_astray() {
    if (!layout_) return;
    constexpr float kBeside_m = 0.04f;
    constexpr double kBag = 0.02, kWideClothes = 0.15; // shares
    const std::vector<float> off = template_distances();
    if (median(off) >= options_.likely_m) return;
    report_.beside_share = static_cast<double>(std::count_if(
                               off.begin(), off.end(), [](float d) { return d > kBeside_m; })) /
                           static_cast<double>(std::max<std::size_t>(1, off.size()));
    AstrayOptions options;
    report_.carried_left_out = report_.beside_share > kBag && report_.beside_share < kWideClothes;
    if (report_.carried_left_out) options.trunk_off_m = options.most_off_m = 0.02f;
    report_.limbs_astray = scan::leave_out_astray(*layout_, *surface_, options, views_, rows_);
}

/// What was left out says nothing of the space behind it either.
void WarpFusion::forget_carried() {
    if (!report_.carried_left_out) return;
    for (WarpedView& view : views_)
        for (std::size_t i = 0; i < view.bindings.size(); ++i)
            if (view.view.depth[i] > 0.0f && !view.bound(i)) {
                view.view.depth[i] = view.view.weight[i] = 0.0f;
                view.view.beyond[i] = Beyond::unknown;
            }
}

/// What the views of the end of the turn see of the start, off each other.
double WarpFusion::loop_rms() const {
    if (views_.size() < 4) return 0.0;
    const auto last = static_cast<std::uint32_t>(views_.size() - 1);
    std::vector<WarpedView> copy{views_[0], views_[1], views_[last - 1], views_[last]};
    const std::vector<ViewPair> pairs{{0, 3}, {1, 3}, {0, 2}};
    return warp_jointly(graph_, pairs, options_.joint, copy, rows_).rms_m;
}

/// One round over all pairs; `share` of the way from the first reach to the last.
void WarpFusion::warp(std::span<const ViewPair> pairs, float share) {
    JointWarpOptions joint = options_.joint;
    joint.reach_m += share * (options_.end_reach_m - joint.reach_m);
    report_.rounds.push_back(warp_jointly(graph_, pairs, joint, views_, rows_));
}

std::vector<ViewPair> WarpFusion::view_pairs() const {
    std::vector<Pose> poses;
    for (const WarpedView& view : views_)
        poses.push_back(overall_pose(view, graph_));
    return overlapping_pairs(poses, options_.pair_angle, options_.pairs);
}

void WarpFusion::register_all(const std::function<void(double)>& progress) {
    const std::vector<ViewPair> pairs = view_pairs();
    report_.loop_gap_m = loop_rms();
    const int half = options_.rounds / 2;
    for (int round = 0; round < options_.rounds; ++round) {
        const float share =
            std::min(1.0f, static_cast<float>(round) / static_cast<float>(std::max(1, half)));
        warp(pairs, share);
        progress(0.3 + 0.4 * (round + 1) / options_.rounds);
        // The template follows, and readings go to where it then is.
        if (round == half) bind_all();
        const auto& done = report_.rounds;
        if (share >= 1.0f &&
            (done.back().step_m < 2e-4 || done.back().rms_m > 0.998 * done[done.size() - 2].rms_m))
            break;
    }
    report_.loop_error_m = loop_rms();
    for (const WarpedView& view : views_)
        for (std::size_t n = 0; n < view.moved.size(); ++n) {
            const Vec3d at = graph_.nodes()[n].cast<double>();
            report_.largest_move_m =
                std::max(report_.largest_move_m, (view.moved[n] * at - at).norm());
        }
}

/// P4: labels, trunk, limbs, and with what came of it again; an iteration that does not help is
/// taken back and is the last.
void WarpFusion::register_parts_first(const PartStage& parts) {
    const PartLayout& layout = layout_.emplace(graph_, shape_, parts.groups);
    const std::vector<ViewPair> pairs = view_pairs();
    const auto measured = [&] { return residual(views_, pairs, parts.residual_reach_m, rows_); };
    report_.residuals_m.push_back(measured());
    follow_parts(graph_, layout, shape_, *surface_, parts.options, views_, rows_);
    bind_all();
    report_.residuals_m.push_back(measured());
    for (int k = 0; k < parts.iterations; ++k) {
        struct Kept {
            std::vector<Pose> moved;
            std::vector<NodeBinding> bindings;
        };
        std::vector<Kept> before;
        for (const WarpedView& view : views_)
            before.push_back({view.moved, view.bindings});
        bind_all();
        const auto told = register_parts(layout, pairs, parts.options, views_, rows_);
        for (const float share : {0.5f, 1.0f})
            warp(pairs, share);
        const double now = measured();
        if (now > report_.residuals_m.back()) {
            for (std::size_t i = 0; i < views_.size(); ++i) {
                views_[i].moved = std::move(before[i].moved);
                views_[i].bindings = std::move(before[i].bindings);
                views_[i].update_motions();
            }
            break;
        }
        report_.parts_left_out = told.left_out;
        const bool enough = now > 0.98 * report_.residuals_m.back();
        report_.residuals_m.push_back(now);
        if (enough) break;
    }
}

Volume WarpFusion::fused() const {
    VolumeOptions volume;
    volume.voxel_m = options_.voxel_m;
    volume.truncation_m = options_.truncation_m;
    Volume out(Vec3f::Zero(), volume);
    constexpr std::size_t kAtOnce = 8; // views: the readings of all would be many
    for (std::size_t from = 0; from < views_.size(); from += kAtOnce) {
        std::vector<std::vector<Reading>> readings(std::min(kAtOnce, views_.size() - from));
        rows_(static_cast<std::uint32_t>(readings.size()), 1,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t k = begin; k < end; ++k) {
                      const WarpedView& view = views_[from + k];
                      const PulledView seen = pulled(view);
                      for (std::size_t p = 0; p < seen.points.size(); ++p)
                          if (seen.points[p].x() == seen.points[p].x())
                              readings[k].push_back(
                                  {seen.points[p], seen.normals[p], view.view.weight[p]});
                  }
              });
        std::vector<Reading> all;
        for (const auto& some : readings)
            all.insert(all.end(), some.begin(), some.end());
        out.add(all, options_.disc_m, rows_);
    }
    return out;
}

void WarpFusion::take_off_bias() {
    for (int round = 0; round < options_.bias_rounds && options_.filter.joint_bilateral; ++round) {
        const Volume volume = fused();
        each_view([&](std::size_t i) {
            WarpedView& view = views_[i];
            const auto map = [&](std::size_t pixel) -> Warp {
                if (view.bound(pixel)) return blended(view.bindings[pixel], view.motions);
                return Warp::Constant(std::numeric_limits<float>::quiet_NaN());
            };
            scan::take_off_bias(view.view, predicted_depth(volume, view.view, map),
                                options_.filter);
        });
    }
}

double WarpFusion::surface_rms(const Volume& volume) const {
    double square = 0.0, count = 0.0;
    for (const WarpedView& view : views_) {
        const Window& camera = view.view.camera;
        for (int y = 0; y < camera.height; y += 4)
            for (int x = 0; x < camera.width; x += 4) {
                const std::size_t i = camera.at(x, y);
                if (view.view.weight[i] <= 0.0f || !view.bound(i)) continue;
                const Vec3f p =
                    view.view.raw[i] * camera.ray(static_cast<float>(x), static_cast<float>(y));
                float distance = 0.0f;
                if (!volume.sample(warped(blended(view.bindings[i], view.motions), p), distance))
                    continue;
                square += static_cast<double>(distance) * static_cast<double>(distance);
                count += 1.0;
            }
    }
    return count > 0.0 ? std::sqrt(square / count) : 0.0;
}

/// Of some of the readings from the template.
std::vector<float> WarpFusion::template_distances() const {
    std::vector<float> off;
    for (const WarpedView& view : views_) {
        const PulledView seen = pulled(view);
        for (std::size_t p = 0; p < seen.points.size(); p += 37)
            if (seen.points[p].x() == seen.points[p].x())
                off.push_back(surface_->nearest(seen.points[p]).distance);
    }
    return off;
}

WarpedSurface WarpFusion::surface(const std::optional<geometry::Plane>& floor) {
    const Volume volume = fused();
    std::optional<geometry::Plane> ground;
    if (floor) ground = moved(first_, *floor);
    std::vector<const DepthView*> views;
    for (const WarpedView& view : views_)
        views.push_back(&view.view);
    const WarpedPlaces places(graph_, shape_, *surface_, views_);
    report_.template_off_m = median(template_distances());
    ClosedSurface closed =
        closed_surface(volume, views, places, ground,
                       report_.template_off_m < options_.likely_m ? &*surface_ : nullptr, rows_);
    for (int round = 0; round < options_.smoothing_rounds; ++round)
        smooth(closed.mesh);
    WarpedSurface out;
    out.colors = vertex_colors(closed.mesh, views, places, rows_);
    out.mesh = std::move(closed.mesh);
    move(first_.inverse(), out.mesh);
    report_.surface_rms_m = surface_rms(volume);
    report_.dropped_pieces = closed.dropped_pieces;
    report_.guessed_share = closed.guessed_share;
    out.report = report_;
    return out;
}

} // namespace

WarpedSurface fuse_warped(std::vector<NumberedView> views, const MovingTemplate& body,
                          const std::optional<geometry::Plane>& floor,
                          const WarpFusionOptions& options, const PartStage& parts,
                          const RowLoop& rows, const std::function<void(double)>& progress) {
    if (views.size() < 2)
        throw Error(
            "a single view shows one side only: let the person turn once before the camera");
    WarpFusion fusion(std::move(views), body, options, rows);
    fusion.bind_all();
    progress(0.2);
    if (!parts.groups.empty()) fusion.register_parts_first(parts);
    progress(0.3);
    fusion.register_all(progress);
    fusion.forget_carried();
    fusion.take_off_bias();
    progress(0.85);
    return fusion.surface(floor);
}

} // namespace toile::scan
