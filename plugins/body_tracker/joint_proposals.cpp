#include "body_tracker/joint_proposals.h"

#include <algorithm>

namespace toile::body_tracker {
namespace {

constexpr std::size_t kStarts = 12;
constexpr int kSteps = 20;
constexpr float kStill_m = 0.0005f;

/// Keeps the largest modes; one within `radius` of another is the same mode.
void keep(const JointProposal& mode, float radius, PartProposals& out) {
    for (const JointProposal& other : out)
        if (other.area_m2 > 0.0f && (other.position - mode.position).norm() < radius) return;
    if (mode.area_m2 <= out.back().area_m2) return;
    out.back() = mode;
    for (std::size_t i = out.size() - 1; i > 0 && out[i].area_m2 > out[i - 1].area_m2; --i)
        std::swap(out[i], out[i - 1]);
}

} // namespace

ProposalOptions proposal_options(const Forest& forest) {
    ProposalOptions out;
    const std::size_t known = std::min(forest.push_back_mm.size(), out.push_back_m.size());
    for (std::size_t p = 0; p < known; ++p)
        out.push_back_m[p] = 0.001f * static_cast<float>(forest.push_back_mm[p]);
    return out;
}

JointProposer::JointProposer(const ProposalOptions& options)
    : options_(options), parts_(kPartCount) {}

const std::array<PartProposals, kPartCount>&
JointProposer::propose(const DepthView& view, const ImageCentre& centre,
                       const LabelPicture& labels) noexcept {
    collect(view, centre, labels);
    for (std::size_t p = 0; p < parts_.size(); ++p)
        find_modes(parts_[p], options_.push_back_m[p], proposals_[p]);
    return proposals_;
}

bool JointProposer::used(const LabelPicture& labels, std::size_t at) const noexcept {
    return labels.labels[at] > 0 && labels.labels[at] <= kPartCount &&
           labels.shares[at] >= options_.least_share;
}

void JointProposer::collect(const DepthView& view, const ImageCentre& centre,
                            const LabelPicture& labels) noexcept {
    for (PartPoints& part : parts_)
        part.pixels = part.seen = part.count = 0;
    const int columns = (view.width + labels.step - 1) / labels.step;
    const int rows = (view.height + labels.step - 1) / labels.step;
    for (std::size_t at = 0;
         at < static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); ++at)
        if (used(labels, at)) ++parts_[labels.labels[at] - 1u].pixels;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const auto at = static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) +
                            static_cast<std::size_t>(c);
            if (!used(labels, at)) continue;
            PartPoints& part = parts_[labels.labels[at] - 1u];
            const std::size_t kept = std::min(kPoints, part.pixels);
            // The k-th of `kept` is pixel k * pixels / kept; each stands for pixels / kept.
            if (part.seen++ != part.count * part.pixels / kept || part.count == kept) continue;
            const int x = c * labels.step, y = r * labels.step;
            const float z = 0.001f * view.mm[y * view.width + x];
            const float side = z * static_cast<float>(labels.step) / view.focal_px;
            const float share = static_cast<float>(labels.shares[at]) / 255.0f;
            part.points[part.count++] = {
                Vec3f((static_cast<float>(x) - centre.x_px) * z / view.focal_px,
                      (centre.y_px - static_cast<float>(y)) * z / view.focal_px, -z),
                side * side * share * static_cast<float>(part.pixels) / static_cast<float>(kept)};
        }
}

JointProposal JointProposer::climb(const PartPoints& part, Vec3f at) const noexcept {
    JointProposal mode;
    const float limit = options_.radius_m * options_.radius_m;
    for (int step = 0; step < kSteps; ++step) {
        Vec3f sum = Vec3f::Zero();
        float area = 0.0f;
        for (std::size_t i = 0; i < part.count; ++i) {
            const Point& point = part.points[i];
            if ((point.position - at).squaredNorm() > limit) continue;
            sum += point.area_m2 * point.position;
            area += point.area_m2;
        }
        if (area <= 0.0f) break;
        mode.position = sum / area;
        mode.area_m2 = area;
        if ((mode.position - at).norm() < kStill_m) break;
        at = mode.position;
    }
    return mode;
}

void JointProposer::find_modes(const PartPoints& part, float push_back_m,
                               PartProposals& out) const noexcept {
    out = {};
    const std::size_t starts = std::min(kStarts, part.count);
    for (std::size_t s = 0; s < starts; ++s)
        keep(climb(part, part.points[s * part.count / starts].position), options_.radius_m, out);
    for (JointProposal& mode : out) {
        if (mode.area_m2 <= 0.0f) continue;
        mode.confidence = mode.area_m2 / (mode.area_m2 + options_.half_area_m2);
        mode.position *= 1.0f + push_back_m / mode.position.norm();
    }
}

} // namespace toile::body_tracker
