#include "scan/part_registration.h"

#include "core/error.h"
#include "scan/normal_equations.h"

#include <numeric>
#include <string>

namespace toile::scan {
namespace {

std::size_t index(BodyGroup group) {
    return static_cast<std::size_t>(group);
}

/// (views) those that are paired with each.
std::vector<std::vector<std::size_t>> paired(std::size_t views, std::span<const ViewPair> pairs) {
    std::vector<std::vector<std::size_t>> out(views);
    for (const auto& [a, b] : pairs) {
        out[a].push_back(b);
        out[b].push_back(a);
    }
    return out;
}

/// A rigid move of one group of one view.
class GroupMove {
  public:
    GroupMove(const PartLayout& layout, BodyGroup group, const PartRegistrationOptions& options)
        : layout_(layout), group_(group), options_(options) {}

    /// Against what others saw of the group. The joint holds what the readings leave open.
    [[nodiscard]] Pose find(const WarpedView& view, std::span<const WarpedView> views,
                            std::span<const PreparedView> at, std::span<const std::size_t> others,
                            float start_reach) const {
        const PulledView seen = pulled(view);
        return descend(start_reach, [&](const Pose& move, float reach, Sums& sums) {
            for (const std::size_t b : others)
                each_reading(view, seen, move, [&](std::size_t i, const Vec3f& p, const Vec3f& m) {
                    std::size_t j = 0;
                    if (!find_partner(view.bindings[i], p, views[b], at[b], j) ||
                        layout_.group(views[b].bindings[j]) != group_)
                        return;
                    add(p, m, at[b].pulled.points[j], at[b].pulled.normals[j], reach, sums);
                });
        });
    }

    /// Against the template itself.
    [[nodiscard]] Pose find(const WarpedView& view, const geometry::NearestSurface& surface,
                            float start_reach) const {
        const PulledView seen = pulled(view);
        return descend(start_reach, [&](const Pose& move, float reach, Sums& sums) {
            each_reading(view, seen, move, [&](std::size_t, const Vec3f& p, const Vec3f& m) {
                const auto near = surface.nearest(p, reach);
                if (near.triangle == geometry::kNoTriangle) return;
                add(p, m, near.point, near.normal, reach, sums);
            });
        });
    }

  private:
    /// Gauss-Newton with pairs that become closer; collect(move, reach, sums).
    template <class Collect>
    [[nodiscard]] Pose descend(float start_reach, const Collect& collect) const {
        Pose out = Pose::Identity();
        for (int round = 0; round < options_.rounds; ++round) {
            const float share =
                static_cast<float>(round) / static_cast<float>(std::max(1, options_.rounds - 1));
            Sums sums;
            collect(out, start_reach + share * (options_.end_reach_m - start_reach), sums);
            hold_joint(out, sums);
            const Vector6 step = -sums.h.ldlt().solve(sums.g);
            if (!step.allFinite()) break;
            out = motion_about(layout_.joint(group_), step) * out;
        }
        return out;
    }

    /// visit(pixel, point, normal) of the group's readings, moved.
    template <class Visit>
    void each_reading(const WarpedView& view, const PulledView& seen, const Pose& move,
                      const Visit& visit) const {
        const Eigen::Isometry3f motion = move.cast<float>();
        const Window& camera = view.view.camera;
        for (int y = 0; y < camera.height; y += options_.stride)
            for (int x = 0; x < camera.width; x += options_.stride) {
                const std::size_t i = camera.at(x, y);
                if (!(seen.points[i].x() == seen.points[i].x()) ||
                    layout_.group(view.bindings[i]) != group_)
                    continue;
                visit(i, motion * seen.points[i], motion.linear() * seen.normals[i]);
            }
    }

    void add(const Vec3f& p, const Vec3f& m, const Vec3f& q, const Vec3f& n, float reach,
             Sums& sums) const {
        if ((p - q).squaredNorm() > reach * reach || n.dot(m) < std::cos(options_.angle)) return;
        constexpr double kHuber_m = 0.005;
        const Vec3f arm = p - layout_.joint(group_).cast<float>();
        sums.add(arm, n, static_cast<double>(n.dot(p - q)), 1.0, kHuber_m);
    }

    /// As some readings: a limb stays at its joint, and does not turn about itself for nothing.
    void hold_joint(const Pose& move, Sums& sums) const {
        constexpr double kReadings = 60.0, kTurnArm_m = 0.03;
        const Vec3d joint = layout_.joint(group_);
        const double weight = group_ == BodyGroup::trunk ? 1.0 : kReadings;
        sums.h.bottomRightCorner<3, 3>().diagonal().array() += weight;
        sums.g.tail<3>() += weight * (move * joint - joint);
        sums.h.topLeftCorner<3, 3>().diagonal().array() += kReadings * kTurnArm_m * kTurnArm_m;
    }

    const PartLayout& layout_;
    BodyGroup group_;
    const PartRegistrationOptions& options_;
};

/// A group's move takes along what hangs on it.
void carry(const PartLayout& layout, BodyGroup group, const Pose& move, WarpedView& view) {
    for (std::size_t n = 0; n < layout.node_groups().size(); ++n) {
        if (!PartLayout::hangs_on(layout.node_groups()[n], group)) continue;
        view.moved[n] = moved(move, view.moved[n]);
    }
    view.update_motions();
}

/// One pass over all groups.
class Pass {
  public:
    Pass(const PartLayout& layout, std::span<const ViewPair> pairs,
         const PartRegistrationOptions& options, std::vector<WarpedView>& views,
         const RowLoop& rows)
        : layout_(layout), options_(options), views_(views), rows_(rows), at_(views.size()),
          others_(paired(views.size(), pairs)) {
        prepare();
    }

    void run(BodyGroup group) {
        if (group != BodyGroup::trunk) report_.left_out += leave_out_hidden(group);
        const GroupMove move(layout_, group, options_);
        // From view to view: each is laid on the one before, which was placed already.
        std::size_t before = 0;
        for (std::size_t a = 1; a < views_.size(); ++a) {
            if (readings(group, views_[a]) == 0) continue;
            const std::array<std::size_t, 1> last{before};
            carry(layout_, group, move.find(views_[a], views_, at_, last, options_.start_reach_m),
                  views_[a]);
            at_[a] = prepared(views_[a]);
            before = a;
        }
        // Against several at once, all from where they stood.
        std::vector<Pose> found(views_.size(), Pose::Identity());
        rows_(static_cast<std::uint32_t>(views_.size()), 1,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t a = std::max(1u, begin); a < end; ++a)
                      found[a] = move.find(views_[a], views_, at_, others_[a],
                                           0.5f * options_.start_reach_m);
              });
        for (std::size_t a = 1; a < views_.size(); ++a)
            carry(layout_, group, found[a], views_[a]);
        if (group != BodyGroup::trunk) report_.left_out += leave_out_torn(group);
        prepare();
    }

    [[nodiscard]] const PartRegistrationReport& report() const { return report_; }

  private:
    void prepare() {
        rows_(static_cast<std::uint32_t>(views_.size()), 1,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t i = begin; i < end; ++i)
                      at_[i] = prepared(views_[i]);
              });
    }

    void unbind(BodyGroup group, WarpedView& view) const {
        for (NodeBinding& binding : view.bindings)
            if (binding.weights[0] > 0.0f && PartLayout::hangs_on(layout_.group(binding), group))
                binding.weights[0] = 0.0f;
    }

    [[nodiscard]] std::size_t readings(BodyGroup group, const WarpedView& view) const {
        return static_cast<std::size_t>(
            std::count_if(view.bindings.begin(), view.bindings.end(), [&](const NodeBinding& b) {
                return b.weights[0] > 0.0f && layout_.group(b) == group;
            }));
    }

    /// P4 2.3.2: views in which a part has far fewer readings than usual.
    std::size_t leave_out_hidden(BodyGroup group) {
        std::vector<std::size_t> counts;
        for (const WarpedView& view : views_)
            counts.push_back(readings(group, view));
        std::vector<std::size_t> sorted = counts;
        std::nth_element(sorted.begin(),
                         sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                         sorted.end());
        const double usual = static_cast<double>(sorted[sorted.size() / 2]);
        std::size_t out = 0;
        for (std::size_t i = 1; i < views_.size(); ++i)
            if (counts[i] > 0 && static_cast<double>(counts[i]) < options_.least_share * usual) {
                unbind(group, views_[i]);
                at_[i] = prepared(views_[i]);
                ++out;
            }
        return out;
    }

    /// P4 2.3.2: views in which a joint comes apart.
    std::size_t leave_out_torn(BodyGroup group) {
        const auto motion = [&](const WarpedView& view, BodyGroup of) {
            // The node of a group that is nearest to the joint tells.
            std::size_t best = view.moved.size();
            double nearest = 1e9;
            for (std::size_t n = 0; n < view.moved.size(); ++n) {
                if (layout_.node_groups()[n] != of) continue;
                const double way =
                    (layout_.node_places()[n].cast<double>() - layout_.joint(group)).norm();
                if (way < nearest) nearest = way, best = n;
            }
            return best < view.moved.size() ? Pose(view.moved[best] * view.base[best])
                                            : Pose::Identity();
        };
        std::size_t out = 0;
        for (std::size_t i = 1; i < views_.size(); ++i) {
            const Vec3d seen = motion(views_[i], parent_of(group)).inverse() * layout_.joint(group);
            const double apart = (motion(views_[i], group) * seen - layout_.joint(group)).norm();
            if (apart < options_.most_apart_m || readings(group, views_[i]) == 0) continue;
            unbind(group, views_[i]);
            ++out;
        }
        return out;
    }

    const PartLayout& layout_;
    const PartRegistrationOptions& options_;
    std::vector<WarpedView>& views_;
    const RowLoop& rows_;
    std::vector<PreparedView> at_;
    std::vector<std::vector<std::size_t>> others_;
    PartRegistrationReport report_;
};

} // namespace

BodyGroup parent_of(BodyGroup group) {
    switch (group) {
    case BodyGroup::left_lower_arm:
        return BodyGroup::left_upper_arm;
    case BodyGroup::right_lower_arm:
        return BodyGroup::right_upper_arm;
    case BodyGroup::left_lower_leg:
        return BodyGroup::left_upper_leg;
    case BodyGroup::right_lower_leg:
        return BodyGroup::right_upper_leg;
    default:
        return BodyGroup::trunk;
    }
}

bool PartLayout::hangs_on(BodyGroup group, BodyGroup on) {
    return group == on || parent_of(group) == on || on == BodyGroup::trunk;
}

PartLayout::PartLayout(const DeformationGraph& graph, const geometry::TriangleMesh& shape,
                       std::span<const BodyGroup> groups)
    : node_places_(graph.nodes().begin(), graph.nodes().end()) {
    if (groups.size() != shape.positions.size())
        throw Error("the body has parts for " + std::to_string(groups.size()) + " of " +
                    std::to_string(shape.positions.size()) + " vertices");
    for (const std::uint32_t v : graph.node_vertices())
        node_groups_.push_back(groups[v]);
    // A joint is the middle of the ring of triangles between two groups.
    std::array<Vec3d, kGroupCount> sums;
    std::array<double, kGroupCount> counts{};
    sums.fill(Vec3d::Zero());
    for (const Triangle& t : shape.triangles)
        for (std::size_t c = 0; c < 3; ++c) {
            const BodyGroup a = groups[t[c]], b = groups[t[(c + 1) % 3]];
            if (a == b) continue;
            const BodyGroup child = parent_of(a) == b ? a : b;
            if (parent_of(child) != (child == a ? b : a)) continue;
            sums[index(child)] +=
                0.5 * (shape.positions[t[c]] + shape.positions[t[(c + 1) % 3]]).cast<double>();
            counts[index(child)] += 1.0;
        }
    for (std::size_t g = 0; g < kGroupCount; ++g)
        joints_[g] = counts[g] > 0.0 ? Vec3d(sums[g] / counts[g]) : Vec3d::Zero();
}

PartRegistrationReport register_parts(const PartLayout& layout, std::span<const ViewPair> pairs,
                                      const PartRegistrationOptions& options,
                                      std::vector<WarpedView>& views, const RowLoop& rows) {
    Pass pass(layout, pairs, options, views, rows);
    for (std::size_t g = 0; g < kGroupCount; ++g)
        pass.run(static_cast<BodyGroup>(g));
    return pass.report();
}

void follow_parts(const DeformationGraph& graph, const PartLayout& layout,
                  const geometry::TriangleMesh& shape, const geometry::NearestSurface& surface,
                  const PartRegistrationOptions& options, std::vector<WarpedView>& views,
                  const RowLoop& rows) {
    rows(static_cast<std::uint32_t>(views.size()), 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = std::max(1u, begin); i < end; ++i)
            for (int round = 0; round < options.follow_rounds; ++round) {
                bind(graph, shape, {}, views[i], options.stride);
                const float reach = options.start_reach_m / static_cast<float>(round + 1);
                for (std::size_t g = 0; g < kGroupCount; ++g) {
                    const auto group = static_cast<BodyGroup>(g);
                    const Pose move =
                        GroupMove(layout, group, options).find(views[i], surface, reach);
                    carry(layout, group, move, views[i]);
                }
            }
    });
    for (WarpedView& view : views)
        view.settle();
}

std::size_t leave_out_astray(const PartLayout& layout, const geometry::NearestSurface& surface,
                             const AstrayOptions& options, std::vector<WarpedView>& views,
                             const RowLoop& rows) {
    std::vector<std::size_t> left_out(views.size(), 0);
    const auto one = [&](std::size_t v) {
        WarpedView& view = views[v];
        const PulledView seen = pulled(view);
        std::array<std::size_t, kGroupCount> count{}, near{};
        for (std::size_t i = 0; i < seen.points.size(); ++i) {
            if (!(seen.points[i].x() == seen.points[i].x())) continue;
            const std::size_t group = index(layout.group(view.bindings[i]));
            if (group == index(BodyGroup::head)) continue;
            const float off = surface.nearest(seen.points[i]).distance;
            if (group == index(BodyGroup::trunk)) {
                if (off > options.trunk_off_m) view.bindings[i].weights[0] = 0.0f;
                continue;
            }
            ++count[group];
            if (off < options.near_m) ++near[group];
            if (off > options.most_off_m) view.bindings[i].weights[0] = 0.0f;
        }
        for (std::size_t g = 0; g < kGroupCount; ++g) {
            if (static_cast<double>(near[g]) >= options.least_near * static_cast<double>(count[g]))
                continue;
            ++left_out[v];
            for (NodeBinding& binding : view.bindings)
                if (binding.weights[0] > 0.0f && index(layout.group(binding)) == g)
                    binding.weights[0] = 0.0f;
        }
    };
    rows(static_cast<std::uint32_t>(views.size()), 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t v = begin; v < end; ++v)
            one(v);
    });
    return std::accumulate(left_out.begin(), left_out.end(), std::size_t{0});
}

double residual(std::span<const WarpedView> views, std::span<const ViewPair> pairs, float reach_m,
                const RowLoop& rows) {
    constexpr int kStride = 4;
    constexpr float kLeastCosine = 0.5f;
    std::vector<PreparedView> at(views.size());
    rows(static_cast<std::uint32_t>(views.size()), 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i)
            at[i] = prepared(views[i]);
    });
    const auto others = paired(views.size(), pairs);
    std::vector<double> square(views.size(), 0.0), count(views.size(), 0.0);
    const auto add = [&](std::size_t a, std::size_t b) {
        const Window& camera = views[a].view.camera;
        for (int y = 0; y < camera.height; y += kStride)
            for (int x = 0; x < camera.width; x += kStride) {
                const std::size_t i = camera.at(x, y);
                const Vec3f& p = at[a].pulled.points[i];
                std::size_t j = 0;
                if (!(p.x() == p.x()) || !find_partner(views[a].bindings[i], p, views[b], at[b], j))
                    continue;
                const Vec3f &q = at[b].pulled.points[j], &n = at[b].pulled.normals[j];
                const bool pair = (p - q).squaredNorm() < reach_m * reach_m &&
                                  n.dot(at[a].pulled.normals[i]) > kLeastCosine;
                const auto off = static_cast<double>(pair ? n.dot(p - q) : reach_m);
                square[a] += off * off;
                count[a] += 1.0;
            }
    };
    rows(static_cast<std::uint32_t>(views.size()), 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t a = begin; a < end; ++a)
            for (const std::size_t b : others[a])
                add(a, b);
    });
    double sum = 0.0, all = 0.0;
    for (std::size_t a = 0; a < views.size(); ++a)
        sum += square[a], all += count[a];
    return all > 0.0 ? std::sqrt(sum / all) : 0.0;
}

} // namespace toile::scan
