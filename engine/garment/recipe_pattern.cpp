#include "garment/recipe_pattern.h"

#include "core/error.h"
#include "garment/panel_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::garment::block {
namespace {

// Metres that a corner may lie beside the outline; more where a piece is cut off straight.
constexpr double kOffOutline = 0.003;
constexpr double kOffCut = 0.05;

const PatternPiece& find_piece(const std::span<const PatternPiece> pieces, const std::string& name,
                               const std::string& panel) {
    std::string known;
    for (const PatternPiece& piece : pieces) {
        if (piece.name == name) {
            return piece;
        }
        known += (known.empty() ? "" : ", ") + piece.name;
    }
    throw Error("panel '" + panel + "': there is no piece '" + name + "'; there are " + known);
}

double body_level(const std::map<std::string, double>& levels, const std::string& name,
                  const std::string& panel) {
    const auto at = levels.find(name);
    if (at != levels.end()) {
        return at->second;
    }
    std::string known;
    for (const auto& [level, height] : levels) {
        known += (known.empty() ? "" : ", ") + level;
    }
    throw Error("panel '" + panel + "': '" + name + "' is no level of the body; there are " +
                known);
}

// The panel's border, counter-clockwise, from corners listed either way round. `backwards` tells
// that the listing ran clockwise, so that its edges are reversed.
std::vector<Curve> border_of(const PlacedPanel& panel, bool& backwards) {
    const PanelRecipe& recipe = *panel.recipe;
    const OutlineWalk walk(panel.piece->outline);
    std::vector<double> places;
    for (std::size_t i = 0; i < recipe.border.size(); ++i) {
        const RecipeCorner& corner = recipe.border[i];
        const RecipeCorner& before =
            recipe.border[(i + recipe.border.size() - 1) % recipe.border.size()];
        double off = 0.0;
        const Vec2d point = panel.point(corner.point);
        places.push_back(walk.project(point, off));
        if (off > (corner.straight || before.straight ? kOffCut : kOffOutline)) {
            throw Error("panel '" + recipe.name + "': point '" + corner.point + "' lies " +
                        std::to_string(std::lround(1e3 * off)) + " mm beside the outline");
        }
    }
    const std::size_t n = places.size();
    std::size_t descents = 0;
    for (std::size_t i = 0; i < n; ++i) {
        descents += places[(i + 1) % n] < places[i] ? 1 : 0;
    }
    backwards = descents != 1;
    if (backwards && descents != n - 1) {
        throw Error("panel '" + recipe.name +
                    "': its corners do not stand in order around the outline");
    }
    std::vector<Curve> border;
    for (std::size_t i = 0; i < n; ++i) {
        const double from = places[i];
        const double to = places[(i + 1) % n];
        Curve curve;
        curve.name = recipe.border[i].edge;
        if (recipe.border[i].straight) {
            curve.points = {walk.at(from), walk.at(to)};
        } else {
            curve.points = backwards ? reversed(walk.between(to, from)) : walk.between(from, to);
        }
        border.push_back(std::move(curve));
    }
    if (backwards) {
        std::reverse(border.begin(), border.end());
        for (Curve& curve : border) {
            std::reverse(curve.points.begin(), curve.points.end());
        }
    }
    return border;
}

std::vector<const Curve*> edges_named(const std::vector<Curve>& border,
                                      const std::vector<std::string>& names,
                                      const std::string& panel) {
    std::vector<const Curve*> edges;
    for (const std::string& name : names) {
        const auto at = std::find_if(border.begin(), border.end(),
                                     [&](const Curve& curve) { return curve.name == name; });
        if (at == border.end()) {
            throw Error("panel '" + panel + "': its wrap names no edge '" + name + "' of its own");
        }
        edges.push_back(&*at);
    }
    return edges;
}

// Does the flat panel's x run against what is seen from outside? By its normals where it lies.
bool faces_inwards(const HalfPanel& panel, const BodyProbe& body) {
    using body::Joint;
    std::vector<Vec2d> outline;
    Vec2d middle = Vec2d::Zero();
    for (const Curve& curve : panel.border) {
        for (const Vec2d& p : resample(curve.points, 8)) {
            outline.push_back(p);
            middle += p;
        }
    }
    middle /= static_cast<double>(outline.size());
    const std::array<std::pair<Joint, Joint>, 6> bones = {
        {{Joint::hips, Joint::neck},
         {Joint::neck, Joint::head},
         {Joint::left_upper_arm, Joint::left_lower_arm},
         {Joint::left_lower_arm, Joint::left_hand},
         {Joint::left_upper_leg, Joint::left_lower_leg},
         {Joint::left_lower_leg, Joint::left_foot}}};
    double sum = 0.0;
    for (const Vec2d& corner : outline) {
        const Vec2d flat = 0.4 * corner + 0.6 * middle;
        constexpr double kStep = 0.004;
        const Vec3d p = panel.place(flat);
        const Vec3d normal = (panel.place(flat + Vec2d(kStep, 0.0)) - p)
                                 .cross(panel.place(flat + Vec2d(0.0, kStep)) - p);
        Vec3d out = Vec3d::Zero();
        for (const auto& [a, b] : bones) {
            const Vec3d start = body.joint(a);
            const Vec3d along = body.joint(b) - start;
            const double t = std::clamp((p - start).dot(along) / along.squaredNorm(), 0.0, 1.0);
            const Vec3d d = p - start - t * along;
            out = out.isZero() || d.squaredNorm() < out.squaredNorm() ? d : out;
        }
        sum += normal.normalized().dot(out.normalized());
    }
    return sum < 0.0;
}

struct Builder {
    const Recipe& recipe;
    const BodyProbe& body;
    std::vector<PlacedPanel> placed;
    std::vector<bool> backwards; // of each panel's listing
    std::vector<std::vector<Curve>> borders;
    Pattern pattern;

    [[nodiscard]] std::size_t index(const std::string& name) const {
        for (std::size_t i = 0; i < recipe.panels.size(); ++i) {
            if (recipe.panels[i].name == name) {
                return i;
            }
        }
        throw Error("the recipe has no panel '" + name + "'");
    }

    [[nodiscard]] const Curve& edge(const std::string& panel, const std::string& name) const {
        return pattern.curve(panel, name);
    }

    void add_panel(const PanelRecipe& source, const std::shared_ptr<const GarmentWrap>& wrap) {
        const std::size_t i = index(source.name);
        const PlacedPanel& panel = placed[i];
        HalfPanel half;
        half.name = source.name;
        half.border = std::move(borders[i]);
        const std::string& seam = source.wrap.seam_of;
        const PlacedPanel& seam_of = seam.empty() ? panel : placed[index(seam)];
        // The panels live as long as the wrap that reads them.
        half.place = [wrap, f = wrap->place_of(panel, seam_of)](const Vec2d& p) { return f(p); };
        half.priority = source.wrap.on == WrapOn::arm ? 1 : 2;
        pattern.panels.push_back(std::move(half));
    }

    // One rectangle for each edge that the strip is sewn to.
    void add_strip(const StripRecipe& strip);
    void join_strip(const StripRecipe& strip, const std::vector<std::array<Vec3d, 2>>& ends);
    [[nodiscard]] std::function<Vec3d(const Vec2d&)>
    strip_place(const StripRecipe& strip, const HalfPanel& parent, const Curve& edge) const;
    [[nodiscard]] std::vector<Vec3d> waist_ring(const StripRecipe& strip,
                                                double& half_length) const;
    [[nodiscard]] static std::function<Vec3d(const Vec2d&)>
    waist_place(const std::vector<Vec3d>& ring, double from, double to, double wide);
    [[nodiscard]] bool runs_back(const EdgeUse& use) const;
    [[nodiscard]] std::vector<EdgeUse> part(const EdgeUse& whole, const std::vector<EdgeUse>& row);
    void add_seams();
};

// How a strip lies: as its neighbour goes on beyond the edge, or bent towards the neck.
std::function<Vec3d(const Vec2d&)>
Builder::strip_place(const StripRecipe& strip, const HalfPanel& parent, const Curve& edge) const {
    const std::vector<Vec2d> line = resample(edge.points, 64);
    const auto place = parent.place;
    const bool bend = strip.way == StripRecipe::Way::neck;
    const Vec3d neck = body.joint(body::Joint::neck);
    const double stretch = 1.0 / strip.ratio;
    const double total = length(edge.points);
    // Inside of the border lies on its left.
    return [=](const Vec2d& p) {
        const double at = std::clamp(p.x() * stretch / total, 0.0, 1.0) * 64.0;
        const auto i = std::min<std::size_t>(63, static_cast<std::size_t>(at));
        const Vec2d along = (line[i + 1] - line[i]).normalized();
        const Vec2d inwards(-along.y(), along.x());
        const Vec2d flat = line[i] + (at - static_cast<double>(i)) * (line[i + 1] - line[i]);
        const Vec3d q = place(flat);
        Vec3d direction = (q - place(flat + 0.01 * inwards)).normalized();
        if (bend) {
            const Vec3d in = Vec3d(neck.x() - q.x(), 0.0, neck.z() - q.z()).normalized();
            direction = (0.7 * Vec3d::UnitY() + 0.45 * in).normalized();
        }
        return Vec3d(q + p.y() * direction);
    };
}

// A level ring around the trunk at the mean height of the edges, from the centre front (0) to the
// centre back, as long as the strip where the body leaves room.
std::vector<Vec3d> Builder::waist_ring(const StripRecipe& strip, double& half_length) const {
    constexpr int kSamples = 256;
    double height = 0.0;
    half_length = 0.0;
    for (const std::string& name : strip.along) {
        const auto [panel, edge_name] = split_edge(name);
        const Curve& curve = edge(panel, edge_name);
        const auto& place = pattern.panels[pattern.panel_index(panel)].place;
        half_length += strip.ratio * length(curve.points);
        for (const Vec2d& p : resample(curve.points, 8)) {
            height += place(p).y() / (9.0 * static_cast<double>(strip.along.size()));
        }
    }
    // The body may widen within the strip's height.
    Ring ring = body.ring(height);
    for (const double up : {0.5, 1.0}) {
        const Ring higher = body.ring(height + up * strip.height_m);
        ring.hull.insert(ring.hull.end(), higher.hull.begin(), higher.hull.end());
    }
    ring.hull = convex_hull(std::move(ring.hull));
    const double ease =
        std::max(0.004, (2.0 * half_length - ring.girth()) / (2.0 * std::numbers::pi));
    std::vector<Vec3d> points;
    for (int k = 0; k <= kSamples; ++k) {
        points.push_back(ring.at(static_cast<double>(k) / kSamples, ease));
    }
    return points;
}

std::function<Vec3d(const Vec2d&)> Builder::waist_place(const std::vector<Vec3d>& ring,
                                                        const double from, const double to,
                                                        const double wide) {
    std::vector<double> sums{0.0};
    for (std::size_t i = 1; i < ring.size(); ++i) {
        sums.push_back(sums.back() + (ring[i] - ring[i - 1]).norm());
    }
    return [=](const Vec2d& p) {
        const double s = (from + (to - from) * p.x() / wide) * sums.back();
        const auto next = std::upper_bound(sums.begin() + 1, sums.end() - 1, s);
        const auto i = static_cast<std::size_t>(next - sums.begin());
        const double t = std::clamp((s - sums[i - 1]) / (sums[i] - sums[i - 1]), 0.0, 1.0);
        return Vec3d(ring[i - 1] + t * (ring[i] - ring[i - 1]) + p.y() * Vec3d::UnitY());
    };
}

void Builder::add_strip(const StripRecipe& strip) {
    std::vector<std::array<Vec3d, 2>> ends;
    const bool waist = strip.way == StripRecipe::Way::waist;
    double half = 0.0;
    const std::vector<Vec3d> ring = waist ? waist_ring(strip, half) : std::vector<Vec3d>{};
    double done = 0.0;
    for (const std::string& name : strip.along) {
        const auto [panel, edge_name] = split_edge(name);
        const Curve curve = edge(panel, edge_name);
        const HalfPanel parent = pattern.panels[pattern.panel_index(panel)];
        const double wide = strip.ratio * length(curve.points);
        const double high = strip.height_m;
        HalfPanel band;
        band.name = strip.name + "_" + panel + "_" + edge_name;
        band.border = {{"low", {{0.0, 0.0}, {wide, 0.0}}},
                       {"end", {{wide, 0.0}, {wide, high}}},
                       {"high", {{wide, high}, {0.0, high}}},
                       {"start", {{0.0, high}, {0.0, 0.0}}}};
        if (waist) {
            // Edges that run from the back to the front lie on the ring the other way round.
            const bool onwards =
                parent.place(curve.points.front()).z() > parent.place(curve.points.back()).z();
            const double from = done / half;
            const double to = (done + wide) / half;
            band.place = waist_place(ring, onwards ? from : to, onwards ? to : from, wide);
            band.priority = 3;
            done += wide;
        } else {
            band.place = strip_place(strip, parent, curve);
        }
        ends.push_back({band.place({0.0, 0.0}), band.place({wide, 0.0})});
        pattern.seams.push_back({panel, edge_name, band.name, "low", false});
        pattern.panels.push_back(std::move(band));
    }
    join_strip(strip, ends);
}

// Ends of bands that meet are sewn together; ends on the centre to their mirror image.
void Builder::join_strip(const StripRecipe& strip, const std::vector<std::array<Vec3d, 2>>& ends) {
    constexpr double kOnCentre = 0.004;
    const std::size_t first = pattern.panels.size() - ends.size();
    const auto name = [&](const std::size_t i) { return pattern.panels[first + i].name; };
    if (ends.size() == 1 && std::abs(ends[0][0].x()) > kOnCentre) {
        pattern.seams.push_back({name(0), "start", name(0), "end", true});
        return;
    }
    std::vector<std::array<bool, 2>> joined(ends.size(), {false, false});
    const auto edge_name = [](const std::size_t k) { return k == 0 ? "start" : "end"; };
    for (std::size_t i = 0; i < ends.size(); ++i) {
        for (std::size_t k = 0; k < 2; ++k) {
            if (std::abs(ends[i][k].x()) < kOnCentre) {
                pattern.centres.push_back({name(i), edge_name(k)});
                joined[i][k] = true;
            }
        }
    }
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        std::size_t best_a = 0;
        std::size_t best_b = 0;
        double best = 1e9;
        for (std::size_t a = 0; a < 2; ++a) {
            for (std::size_t b = 0; b < 2; ++b) {
                const double d = (ends[i][a] - ends[i + 1][b]).norm();
                if (!joined[i][a] && !joined[i + 1][b] && d < best) {
                    best = d, best_a = a, best_b = b;
                }
            }
        }
        if (best > 0.12) {
            throw Error("strip '" + strip.name + "': " + strip.along[i] + " and " +
                        strip.along[i + 1] + " do not meet");
        }
        joined[i][best_a] = joined[i + 1][best_b] = true;
        // start runs downwards, end upwards
        pattern.seams.push_back(
            {name(i), edge_name(best_a), name(i + 1), edge_name(best_b), best_a != best_b});
    }
}

// Does the edge as it is used run against the border as it is stored?
bool Builder::runs_back(const EdgeUse& use) const {
    for (std::size_t i = 0; i < recipe.panels.size(); ++i) {
        if (recipe.panels[i].name == use.panel) {
            return use.reversed != backwards[i];
        }
    }
    return use.reversed;
}

// Parts one edge by the lengths of the row that it is sewn to.
std::vector<EdgeUse> Builder::part(const EdgeUse& whole, const std::vector<EdgeUse>& row) {
    std::vector<double> shares;
    double total = 0.0;
    for (const EdgeUse& use : row) {
        total += length(edge(use.panel, use.edge).points);
    }
    for (const EdgeUse& use : row) {
        shares.push_back(length(edge(use.panel, use.edge).points) / total);
    }
    const bool back = runs_back(whole);
    if (back) {
        std::reverse(shares.begin(), shares.end());
    }
    std::vector<Curve>& border = pattern.panels[pattern.panel_index(whole.panel)].border;
    const auto at = std::find_if(border.begin(), border.end(),
                                 [&](const Curve& curve) { return curve.name == whole.edge; });
    constexpr std::size_t kPieces = 512;
    const std::vector<Vec2d> fine = resample(at->points, kPieces);
    std::vector<Curve> parts;
    std::vector<EdgeUse> uses;
    double done = 0.0;
    std::size_t from = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        done += shares[i];
        const std::size_t to = i + 1 == shares.size()
                                   ? kPieces
                                   : static_cast<std::size_t>(std::lround(done * kPieces));
        parts.push_back({whole.edge + "/" + std::to_string(i),
                         {fine.begin() + static_cast<std::ptrdiff_t>(from),
                          fine.begin() + static_cast<std::ptrdiff_t>(to) + 1}});
        uses.push_back({whole.panel, parts.back().name, whole.reversed});
        from = to;
    }
    border.insert(border.erase(at), parts.begin(), parts.end());
    if (back) {
        std::reverse(uses.begin(), uses.end());
    }
    return uses;
}

void Builder::add_seams() {
    for (const RecipeSeam& seam : recipe.seams) {
        for (const auto* row : {&seam.a, &seam.b}) {
            for (const EdgeUse& use : *row) {
                (void)edge(use.panel, use.edge);
            }
        }
        const bool part_a = seam.a.size() < seam.b.size();
        const bool part_b = seam.b.size() < seam.a.size();
        const std::vector<EdgeUse> a = part_a ? part(seam.a.front(), seam.b) : seam.a;
        const std::vector<EdgeUse> b = part_b ? part(seam.b.front(), seam.a) : seam.b;
        for (std::size_t i = 0; i < a.size(); ++i) {
            pattern.seams.push_back(
                {a[i].panel, a[i].edge, b[i].panel, b[i].edge, runs_back(a[i]) != runs_back(b[i])});
        }
    }
    for (const std::string& centre : recipe.centres) {
        const auto [panel, edge_name] = split_edge(centre);
        (void)edge(panel, edge_name);
        pattern.centres.push_back({panel, edge_name});
    }
}

// Charts lie side by side, the right side's beside the left one's.
void lay_charts(Pattern& pattern) {
    double x = 0.0;
    for (HalfPanel& panel : pattern.panels) {
        double low = 1e9;
        double high = -1e9;
        for (const Curve& curve : panel.border) {
            for (const Vec2d& p : curve.points) {
                low = std::min(low, panel.mirrored ? -p.x() : p.x());
                high = std::max(high, panel.mirrored ? -p.x() : p.x());
            }
        }
        const double wide = high - low + 0.02;
        // Halves that are one cloth with their mirror image keep a common centre line.
        const bool on_fold = std::any_of(
            pattern.centres.begin(), pattern.centres.end(), [&](const CentreSeam& centre) {
                const auto& points = pattern.curve(centre.panel, centre.curve).points;
                return centre.panel == panel.name &&
                       std::all_of(points.begin(), points.end(),
                                   [](const Vec2d& p) { return std::abs(p.x()) < 0.001; });
            });
        panel.chart_offset = Vec2d(x + (on_fold ? wide : -low), 0.0);
        panel.right_chart_shift = on_fold ? 0.0 : wide + low + high;
        x += 2.0 * wide;
    }
}

} // namespace

Pattern pattern_of(const Recipe& recipe, const std::span<const PatternPiece> pieces,
                   const BodyProbe& body) {
    Builder builder{recipe, body, {}, {}, {}, {}};
    const auto owned = std::make_shared<std::vector<PatternPiece>>(pieces.begin(), pieces.end());
    const std::map<std::string, double> levels = body_levels(body);
    for (const PanelRecipe& source : recipe.panels) {
        PlacedPanel& panel = builder.placed.emplace_back();
        panel.recipe = &source;
        panel.piece = &find_piece(*owned, source.piece, source.name);
        bool turned = false;
        builder.borders.push_back(border_of(panel, turned));
        builder.backwards.push_back(turned);
        std::vector<Vec2d> outline;
        for (const Curve& curve : builder.borders.back()) {
            outline.insert(outline.end(), curve.points.begin(), curve.points.end() - 1);
        }
        panel.widths = std::make_shared<const PanelWidths>(
            outline, edges_named(builder.borders.back(), source.wrap.inner, source.name),
            edges_named(builder.borders.back(), source.wrap.outer, source.name));
        for (const auto& [point, level] : source.wrap.levels) {
            panel.heights.emplace_back(panel.point(point).y(),
                                       body_level(levels, level, source.name));
        }
        std::sort(panel.heights.begin(), panel.heights.end());
        if (panel.heights.empty() && source.wrap.on != WrapOn::arm) {
            throw Error("panel '" + source.name + "': its wrap names no level of the body");
        }
    }
    struct Kept {
        std::shared_ptr<std::vector<PatternPiece>> pieces;
        GarmentWrap wrap;
    };
    const auto kept = std::make_shared<const Kept>(
        Kept{owned, GarmentWrap(body, builder.placed, recipe.clearance_m)});
    const std::shared_ptr<const GarmentWrap> wrap(kept, &kept->wrap);
    for (const PanelRecipe& source : recipe.panels) {
        builder.add_panel(source, wrap);
    }
    for (const StripRecipe& strip : recipe.strips) {
        builder.add_strip(strip);
    }
    builder.add_seams();
    for (HalfPanel& panel : builder.pattern.panels) {
        panel.mirrored = faces_inwards(panel, body);
    }
    lay_charts(builder.pattern);
    return std::move(builder.pattern);
}

} // namespace toile::garment::block
