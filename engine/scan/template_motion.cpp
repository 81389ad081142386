#include "scan/template_motion.h"

#include "core/error.h"

#include <iterator>
#include <string>

namespace toile::scan {
namespace {

/// A motion between two, by a share; `about` (in what they lead to) goes straight.
Pose between(const Pose& a, const Pose& b, double share, const Vec3d& about) {
    const Eigen::Quaterniond from(a.linear()), to(b.linear());
    const Vec3d start = a.inverse() * about, end = b.inverse() * about;
    Pose out = Pose::Identity();
    out.linear() = from.slerp(share, to).toRotationMatrix();
    out.translation() = about - out.linear() * (start + share * (end - start));
    return out;
}

} // namespace

Pose turned_evenly(const WholeMotion& known, std::uint32_t number, const Vec3d& about) {
    const auto after = known.lower_bound(number);
    if (after == known.end()) return std::prev(after)->second;
    if (after->first == number || after == known.begin()) return after->second;
    const auto before = std::prev(after);
    return between(before->second, after->second,
                   static_cast<double>(number - before->first) /
                       static_cast<double>(after->first - before->first),
                   about);
}

Pose whole_motion(std::span<const Vec3f> from, std::span<const Vec3f> to) {
    constexpr int kRounds = 4;
    constexpr double kNear_m = 0.03;
    std::vector<float> weights(from.size(), 1.0f);
    Pose out = Pose::Identity();
    for (int round = 0; round < kRounds; ++round) {
        out = best_rigid(from, to, weights);
        for (std::size_t v = 0; v < from.size(); ++v) {
            const double off = (out * from[v].cast<double>() - to[v].cast<double>()).norm();
            weights[v] = static_cast<float>(1.0 / (1.0 + off * off / (kNear_m * kNear_m)));
        }
    }
    return out;
}

TemplateMotion::TemplateMotion(const DeformationGraph& graph, const TemplatePoses& poses,
                               WholeMotion whole)
    : graph_(graph), whole_(std::move(whole)) {
    if (poses.empty()) throw Error("the template stands nowhere");
    const std::vector<Vec3f>& first = poses.begin()->second;
    if (first.size() != graph.bindings().size())
        throw Error("the template has " + std::to_string(graph.bindings().size()) +
                    " vertices, its first place " + std::to_string(first.size()));
    for (const Vec3f& p : first)
        middle_ += p.cast<double>() / static_cast<double>(first.size());
    for (const auto& [number, positions] : poses) {
        if (positions.size() != first.size())
            throw Error("the template's places have different numbers of vertices");
        Instant instant;
        const auto known = whole_.find(number);
        instant.whole = known != whole_.end() ? known->second : whole_motion(positions, first);
        at_instants_[number] = instant.whole;
        const Pose back = instant.whole.inverse();
        for (const Pose& node : node_motions(graph, positions, first))
            instant.nodes.push_back(node * back);
        instants_.emplace(number, std::move(instant));
    }
}

Pose TemplateMotion::whole_at(std::uint32_t number) const {
    if (const auto known = whole_.find(number); known != whole_.end()) return known->second;
    return turned_evenly(at_instants_, number, middle_);
}

std::vector<Pose> TemplateMotion::at(std::uint32_t number) const {
    const Pose whole = whole_at(number);
    const auto after = instants_.lower_bound(number);
    std::vector<Pose> out;
    if (after == instants_.end() || after->first == number || after == instants_.begin()) {
        const Instant& only = after == instants_.end() ? std::prev(after)->second : after->second;
        for (const Pose& node : only.nodes)
            out.push_back(node * whole);
        return out;
    }
    const auto before = std::prev(after);
    const double share = static_cast<double>(number - before->first) /
                         static_cast<double>(after->first - before->first);
    for (std::size_t n = 0; n < graph_.nodes().size(); ++n)
        out.push_back(between(before->second.nodes[n], after->second.nodes[n], share,
                              graph_.nodes()[n].cast<double>()) *
                      whole);
    return out;
}

} // namespace toile::scan
