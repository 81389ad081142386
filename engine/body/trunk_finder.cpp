#include "body/trunk_finder.h"

#include "core/error.h"
#include "geometry/tape.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::body {
namespace {

constexpr int kLevels = 250; // over the stature

// Trust in what a feature of the surface tells (a crease, a narrowest level), in what stands a
// little off such a feature, and in what is only placed between others.
constexpr double kFeature = 0.8, kNearFeature = 0.6, kPlaced = 0.4, kGuess = 0.2;

constexpr float sign(std::size_t side) {
    return side == 0 ? 1.0f : -1.0f;
}

/// Sections of the trunk from the crotch up, and what is measured on them.
class TrunkFinder {
  public:
    TrunkFinder(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                const Sections& sections, const FoundLegs& legs)
        : positions_(positions), triangles_(triangles), sections_(sections), legs_(legs),
          step_(sections.stature() / kLevels) {}

    FoundTrunk run() {
        find_neck();
        climb();
        find_armpits();
        find_collar();
        find_shoulders();
        find_scyes();
        find_chest();
        find_waist();
        find_hips();
        return out_;
    }

  private:
    struct Level {
        float y;
        Outline outline;
    };

    [[nodiscard]] float share(float of_stature) const { return of_stature * sections_.stature(); }

    /// The middle of the body at a height: between the seat's and the neck's.
    [[nodiscard]] float middle_x(float y) const {
        const float low = legs_.crotch.y();
        const float t = std::clamp((y - low) / (out_.neck - low), 0.0f, 1.0f);
        return legs_.seat.centroid.x() + t * (neck_.centroid.x() - legs_.seat.centroid.x());
    }

    /// Foremost or rearmost point of an outline where x is given.
    static Vec3f crossing(const Outline& o, float x, bool front) {
        Vec3f best = Vec3f::Zero();
        float most = -std::numeric_limits<float>::max();
        for (std::size_t i = 0; i < o.points.size(); ++i) {
            const Vec3f& a = o.points[i];
            const Vec3f& b = o.points[(i + 1) % o.points.size()];
            if ((a.x() < x) == (b.x() < x)) continue;
            const Vec3f p = a + (x - a.x()) / (b.x() - a.x()) * (b - a);
            const float reach = front ? p.z() : -p.z();
            if (reach <= most) continue;
            most = reach;
            best = p;
        }
        return best;
    }

    static Vec3f outermost(const Outline& o, std::size_t side) {
        return *std::max_element(o.points.begin(), o.points.end(),
                                 [side](const Vec3f& a, const Vec3f& b) {
                                     return sign(side) * a.x() < sign(side) * b.x();
                                 });
    }

    [[nodiscard]] const Outline& trunk_at(float y) const {
        const auto nearer = [y](const Level& a, const Level& b) {
            return std::abs(a.y - y) < std::abs(b.y - y);
        };
        return std::min_element(levels_.begin(), levels_.end(), nearer)->outline;
    }

    /// From the crown down: the head is the first thick level, the neck the thinnest before the
    /// shoulders.
    void find_neck() {
        constexpr float kShoulders = 1.5f; // times the head's girth
        std::vector<Outline> head;
        Profile girth;
        float y = sections_.top() - step_;
        Outline outline = top_outline(y);
        float thickest = 0.0f;
        while (y > legs_.crotch.y()) {
            girth.add(y, static_cast<float>(outline.girth()));
            head.push_back(outline);
            if (girth.size() > 8 && girth.value.back() > kShoulders * thickest &&
                girth.value.back() > 1.2f * girth.value[girth.size() - 5])
                break;
            const auto peak = girth.first_peak(0.02f);
            thickest = peak ? girth.value[*peak] : std::numeric_limits<float>::max();
            y -= step_;
            outline = sections_.follow(outline, y);
        }
        const auto peak = girth.first_peak(0.02f);
        if (!peak || y <= legs_.crotch.y())
            throw Error("no neck was found below the top of the body: it must stand upright, head "
                        "up, with the neck free");
        const Profile below = girth.between(girth.at[*peak], girth.at.back());
        const std::size_t thin = *peak + below.smallest();
        out_.neck = girth.at[thin];
        neck_ = head[thin];

        // Its axis: from the level below where it begins to widen.
        std::size_t low = thin;
        while (low + 1 < head.size() && girth.value[low + 1] < 1.25f * girth.value[thin])
            ++low;
        const Vec2f lean = neck_.centroid - head[low].centroid;
        out_.neck_up = Vec3f(lean.x(), girth.at[thin] - girth.at[low], lean.y()).normalized();
        const Outline& widest = head[*peak];
        out_.brow = {crossing(widest, widest.centroid.x(), true), kFeature};
        out_.head_back = {crossing(widest, widest.centroid.x(), false), kFeature};
    }

    [[nodiscard]] Outline top_outline(float& y) const {
        for (; y > legs_.crotch.y(); y -= step_) {
            std::vector<Outline> outlines = sections_.at(y);
            if (!outlines.empty()) return std::move(outlines.front());
        }
        throw Error("the body has no head");
    }

    /// Sections from the crotch up to the neck.
    void climb() {
        Outline outline = legs_.seat;
        for (float y = legs_.crotch.y() + 0.5f * step_; y < out_.neck; y += step_) {
            outline = sections_.follow(outline, y);
            levels_.push_back({y, outline});
        }
        if (levels_.size() < 20) throw Error("the trunk is too short to be measured");
    }

    /// Where the trunk suddenly becomes wider it takes in an arm.
    void find_armpits() {
        const float jump = share(0.012f);
        for (std::size_t side = 0; side < 2; ++side) {
            out_.armpit[side] = {Vec3f::Zero(), 0.0};
            for (std::size_t k = 1; k < levels_.size() && !out_.has_arm[side]; ++k) {
                const Outline& below = levels_[k - 1].outline;
                const auto reach = [side](const Outline& o) {
                    return side == 0 ? o.high.x() : -o.low.x();
                };
                const float wider = reach(levels_[k].outline) - reach(below);
                if (wider < jump) continue;
                out_.has_arm[side] = true;
                const float level = join_level(
                    levels_[k - 1].y, levels_[k].y, 2e-4f * sections_.stature(), [&](float y) {
                        return reach(sections_.follow(below, y)) > reach(below) + 0.5f * wider;
                    });
                out_.armpit[side] = {armpit_point(below, level, side), kFeature};
            }
        }
        // A body without arms: the armpits are where its trunk is widest below the neck.
        for (std::size_t side = 0; side < 2; ++side) {
            if (out_.has_arm[side]) continue;
            const float half = 0.5f * (legs_.crotch.y() + out_.neck);
            Profile breadth;
            for (const Level& l : levels_)
                if (l.y > half) breadth.add(l.y, l.outline.high.x() - l.outline.low.x());
            const std::size_t widest = breadth.largest();
            out_.armpit[side] = {outermost(trunk_at(breadth.at[widest]), side), kGuess};
        }
        armpit_y_ = 0.5f * (out_.armpit[0].point.y() + out_.armpit[1].point.y());
    }

    [[nodiscard]] Vec3f armpit_point(const Outline& below, float level, std::size_t side) const {
        const float y = level - 4e-4f * sections_.stature();
        const Outline trunk = sections_.follow(below, y);
        const Outline* arm = nullptr;
        const std::vector<Outline> outlines = sections_.at(y);
        for (const Outline& o : outlines) {
            const float beside = sign(side) * (o.centroid.x() - trunk.centroid.x());
            if (beside <= 0.0f || trunk.contains(o.centroid)) continue;
            if (arm == nullptr || sign(side) * o.centroid.x() < sign(side) * arm->centroid.x())
                arm = &o;
        }
        Vec3f point = outermost(trunk, side);
        if (arm != nullptr) {
            const auto [a, b] = nearest_points(trunk, *arm);
            point = 0.5f * (a + b);
        }
        point.y() = level;
        return point;
    }

    /// In the middle: the pit of the throat lies farthest back in front, the neck's back point
    /// a little above, where the back bends most steeply into the neck.
    void find_collar() {
        constexpr float kLeastRise = 0.012f, kMostRise = 0.04f; // of the stature
        Profile front, back;
        for (const Level& l : levels_)
            if (l.y > armpit_y_) front.add(l.y, crossing(l.outline, middle_x(l.y), true).z());
        const float throat = front.at[front.smallest()];
        out_.neck_front = {crossing(trunk_at(throat), middle_x(throat), true), kFeature};
        for (const Level& l : levels_)
            if (l.y > throat + share(kLeastRise) && l.y < throat + share(kMostRise))
                back.add(l.y, crossing(l.outline, middle_x(l.y), false).z());
        const float nape = back.size() > 2 ? back.at[back.steepest(1)] : throat;
        out_.neck_back = {crossing(trunk_at(nape), middle_x(nape), false), kNearFeature};
        find_larynx();
    }

    /// In front on the neck's thinnest cut across its axis, between collar and chin.
    void find_larynx() {
        std::vector<Triangle> around;
        const float reach = 0.6f * (neck_.high.x() - neck_.low.x());
        for (const Triangle& t : triangles_) {
            const Vec3f& p = positions_[t[0]];
            if (p.y() > out_.neck_front.point.y() && p.y() < out_.brow.point.y() &&
                std::abs(p.x() - neck_.centroid.x()) < reach)
                around.push_back(t);
        }
        const geometry::SurfacePart part(std::move(around));
        const geometry::GirthCutter cutter(positions_, part, out_.neck_up);
        const Vec3f top(neck_.centroid.x(), out_.neck, neck_.centroid.y());
        Profile girth;
        for (float off = -share(0.05f); off < share(0.01f); off += 0.5f * step_)
            girth.add(off, static_cast<float>(cutter.girth(cutter.offset(top) + off)));
        const float thin = girth.at[girth.smallest()];
        Vec3f front = top;
        for (const Vec3f& p : cutter.tape(cutter.offset(top) + thin).points)
            if (p.z() > front.z()) front = p;
        out_.larynx = {front, kFeature};
    }

    /// The highest points below the neck on upright cuts beside it: the shoulder line bends inwards
    /// at the neck's side and outwards at the shoulder point.
    void find_shoulders() {
        for (std::size_t side = 0; side < 2; ++side) {
            const float start = outermost(neck_, side).x();
            const float arm = out_.armpit[side].point.x();
            const float end = arm + sign(side) * (out_.has_arm[side] ? share(0.04f) : 0.0f);
            constexpr int kCuts = 48;
            std::vector<Vec3f> line;
            Profile slope;
            for (int k = 1; k <= kCuts; ++k) {
                const float x = start + (end - start) * static_cast<float>(k) / kCuts;
                const Vec3f top = top_below_neck(x);
                if (top.y() <= armpit_y_) continue;
                line.push_back(top);
                slope.add(std::abs(x - start), top.y());
            }
            if (slope.size() < 8) throw Error("no shoulder was found beside the neck");
            const std::size_t out = shoulder_corner(slope, std::abs(arm - start));
            out_.shoulder[side] = {line[out], out_.has_arm[side] ? kNearFeature : kGuess};
            out_.neck_side[side] = {line[neck_corner(slope, out)], kNearFeature};
        }
    }

    /// Where the neck's side, going outwards, becomes flatter than 45 degrees.
    static std::size_t neck_corner(const Profile& slope, std::size_t shoulder) {
        for (std::size_t i = 0; i + 1 < shoulder; ++i)
            if (slope.value[i] - slope.value[i + 1] < slope.at[i + 1] - slope.at[i]) return i;
        return 0;
    }

    [[nodiscard]] std::size_t shoulder_corner(const Profile& slope, float arm) const {
        const Profile outer =
            slope.between(std::max(0.5f * arm, arm - share(0.04f)), slope.at.back());
        const std::size_t first = slope.size() - outer.size();
        return first + outer.corner_above();
    }

    [[nodiscard]] Vec3f top_below_neck(float x) const {
        Vec3f best(x, -std::numeric_limits<float>::max(), 0.0f);
        for (const geometry::Loop& loop :
             geometry::slice(positions_, triangles_, {Vec3f::UnitX(), x}))
            for (const Vec3f& p : loop.points)
                if (p.y() <= out_.neck && p.y() > best.y()) best = p;
        return best;
    }

    void find_scyes() {
        for (std::size_t side = 0; side < 2; ++side) {
            const Vec3f& armpit = out_.armpit[side].point;
            const Vec3f& shoulder = out_.shoulder[side].point;
            const float y = 0.5f * (armpit.y() + shoulder.y());
            const float middle = middle_x(y);
            const float x = middle + 0.95f * (armpit.x() - middle); // the folds lie inside
            const double trust = out_.has_arm[side] ? kPlaced : kGuess;
            out_.scye_front[side] = {crossing(trunk_at(y), x, true), trust};
            out_.scye_back[side] = {crossing(trunk_at(y), x, false), trust};
        }
    }

    /// The middle of what stands out most in front between two x.
    [[nodiscard]] Vec3f foremost(const Outline& o, float from, float to) const {
        std::vector<Vec3f> between;
        float most = -std::numeric_limits<float>::max();
        for (const Vec3f& p : o.points) {
            if ((p.x() < from) == (p.x() < to)) continue;
            between.push_back(p);
            most = std::max(most, p.z());
        }
        float sum = 0.0f, count = 0.0f;
        for (const Vec3f& p : between)
            if (p.z() > most - share(0.0015f)) {
                sum += p.x();
                count += 1.0f;
            }
        const float x = count > 0.0f ? sum / count : 0.5f * (from + to);
        return crossing(o, x, true);
    }

    /// On each side of the breast bone: the first prominence below the armpit, and the crease
    /// beneath it.
    void find_chest() {
        for (std::size_t side = 0; side < 2; ++side) {
            const float half = 0.5f * (out_.armpit[0].point.x() - out_.armpit[1].point.x());
            std::vector<Vec3f> points;
            Profile front;
            for (auto l = levels_.rbegin(); l != levels_.rend(); ++l) {
                if (l->y > armpit_y_) continue;
                const float mid = middle_x(l->y);
                points.push_back(foremost(l->outline, mid + sign(side) * 0.45f * half,
                                          mid + sign(side) * 0.85f * half));
                front.add(l->y, points.back().z() - neck_.centroid.y());
            }
            const std::size_t half_way = front.size() / 2;
            std::size_t bust = half_way / 2;
            double trust = kGuess;
            if (const auto peak = front.first_peak(0.02f); peak && *peak < half_way) {
                bust = *peak;
                trust = kFeature;
            }
            out_.bust_point[side] = {points[bust], trust};
            const Profile beneath = front.between(front.at[bust], front.at[bust] - share(0.06f));
            const std::size_t crease = bust + beneath.corner_below();
            out_.under_bust[side] = {points[crease], std::min(trust, kNearFeature)};
        }
    }

    /// The narrowest level between the chest and the hips.
    void find_waist() {
        constexpr float kAboveRib = 0.015f, kBelowWaist = 0.03f; // of the stature
        const float top = 0.5f * (out_.under_bust[0].point.y() + out_.under_bust[1].point.y());
        const float low = legs_.crotch.y() + 0.35f * (armpit_y_ - legs_.crotch.y());
        Profile girth;
        for (const Level& l : levels_)
            if (l.y > low && l.y < top) girth.add(l.y, static_cast<float>(l.outline.girth()));
        const std::size_t thin = girth.smallest();
        const bool inside = thin > 1 && thin + 2 < girth.size();
        waist_y_ = girth.at[thin];
        const double trust = inside ? kFeature : kPlaced;
        for (std::size_t side = 0; side < 2; ++side) {
            const float rib = waist_y_ + share(kAboveRib), crest = waist_y_ - share(kBelowWaist);
            out_.lowest_rib[side] = {outermost(trunk_at(rib), side), trust};
            out_.iliac_crest[side] = {outermost(trunk_at(crest), side), trust};
        }
        const float crest = waist_y_ - share(kBelowWaist);
        out_.navel = {crossing(trunk_at(crest), middle_x(crest), true), kGuess};
    }

    /// The buttocks' level, and the fold beneath them.
    void find_hips() {
        const float crest = out_.iliac_crest[0].point.y();
        Profile back;
        for (const Level& l : levels_)
            if (l.y < crest) back.add(l.y, -l.outline.low.y());
        const std::size_t most = back.largest();
        const float hip = back.at[most];
        const double trust = most + 2 < back.size() ? kFeature : kPlaced;
        const float spine = hip + 0.4f * (waist_y_ - hip);
        const float thigh_bone = hip + share(0.007f);
        for (std::size_t side = 0; side < 2; ++side) {
            out_.trochanter[side] = {outermost(trunk_at(thigh_bone), side), kNearFeature};
            const float x =
                middle_x(spine) + 0.5f * (outermost(trunk_at(spine), side).x() - middle_x(spine));
            out_.iliac_spine[side] = {crossing(trunk_at(spine), x, true), kPlaced};

            const FoundLeg& leg = legs_.legs[side];
            Profile behind;
            for (std::size_t i = 0; i < leg.heights.size(); ++i)
                if (leg.heights[i] > legs_.crotch.y() - share(0.06f))
                    behind.add(leg.heights[i], leg.sections[i].low.y());
            const std::size_t fold =
                std::min(std::max<std::size_t>(behind.corner_above(), 1), behind.size() - 1);
            const float y = std::max(behind.at[fold], legs_.crotch.y() - share(0.017f));
            const Outline& section = leg.near(y);
            out_.gluteal_fold[side] = {crossing(section, section.centroid.x(), false),
                                       std::min(trust, kNearFeature)};
        }
    }

    std::span<const Vec3f> positions_;
    std::span<const Triangle> triangles_;
    const Sections& sections_;
    const FoundLegs& legs_;
    float step_;
    Outline neck_;
    std::vector<Level> levels_;
    float armpit_y_ = 0.0f, waist_y_ = 0.0f;
    FoundTrunk out_;
};

} // namespace

FoundTrunk find_trunk(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                      const Sections& sections, const FoundLegs& legs) {
    return TrunkFinder(positions, triangles, sections, legs).run();
}

} // namespace toile::body
