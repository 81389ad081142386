#include "apps/tape_sheet.h"

#include "apps/contact_sheet.h"
#include "apps/tape_scene.h"

#include <algorithm>

namespace toile::apps {
namespace {

constexpr Color kTape{200, 30, 40};
constexpr Color kFrame{225, 225, 225};
constexpr int kCaption = 26; // pixels

/// Near enough to see the tapes, far enough to see where on the body they are.
render::Box box_round(std::span<const geometry::Loop> tapes) {
    constexpr float kAround = 0.12f, kLeast = 0.22f; // metres, half widths
    render::Box tight;
    for (const geometry::Loop& tape : tapes)
        for (const Vec3f& p : tape.points)
            tight.add(p);
    const Vec3f middle = 0.5f * (tight.low + tight.high);
    const Vec3f half = (0.5f * (tight.high - tight.low) + Vec3f::Constant(kAround))
                           .cwiseMax(Vec3f(kLeast, kLeast, 0.0f));
    render::Box out;
    out.low = middle - half;
    out.high = middle + half;
    return out;
}

/// The tapes of one measurement as one camera sees them.
struct Sight {
    double preference = 1.0;
    render::Camera camera;
    std::vector<std::vector<SeenPoint>> tapes; ///< the same points for every camera

    [[nodiscard]] bool visible(std::size_t tape, std::size_t point) const {
        return tapes[tape][point].visible;
    }
    /// Pixels of the steps along the tapes that end at a point which `counts(tape, point)`.
    template <class Counts>
    [[nodiscard]] double pixels(const Counts& counts) const {
        double sum = 0.0;
        for (std::size_t t = 0; t < tapes.size(); ++t)
            for (std::size_t i = 1; i < tapes[t].size(); ++i)
                if (counts(t, i))
                    sum += static_cast<double>((tapes[t][i].pixel - tapes[t][i - 1].pixel).norm());
        return sum;
    }
    [[nodiscard]] double all() const {
        return pixels([](std::size_t, std::size_t) { return true; });
    }
    /// How much there is to see; what shines through counts less.
    [[nodiscard]] double worth() const {
        constexpr double kHidden = 0.3;
        const double seen = pixels([this](std::size_t t, std::size_t i) { return visible(t, i); });
        return preference * (seen + kHidden * (all() - seen));
    }
};

/// The front first, and preferred. Level, but for girths from a little above, so that a level tape
/// shows as a ring.
std::vector<Sight> sights_of(const TapeScene& scene, const body::LaidMeasurement& measurement,
                             const TapeSheetOptions& options) {
    constexpr float kAbove = 12.0f; // degrees
    constexpr double kFront = 1.3;
    const render::Box box = box_round(measurement.reading.tapes);
    std::vector<Sight> out;
    for (const char* name : {"front", "back", "right", "three_quarter", "left"}) {
        render::View view = render::view_from_name(name);
        if (measurement.definition->kind == body::MeasurementKind::girth) view.height_deg = kAbove;
        Sight sight;
        sight.preference = out.empty() ? kFront : 1.0;
        sight.camera = render::frame_view(view, box.low, box.high, options.width, options.height);
        for (const geometry::Loop& tape : measurement.reading.tapes)
            sight.tapes.push_back(scene.seen(tape, sight.camera));
        out.push_back(std::move(sight));
    }
    return out;
}

const Sight& best_of(const std::vector<Sight>& sights) {
    return *std::max_element(sights.begin(), sights.end(),
                             [](const Sight& a, const Sight& b) { return a.worth() < b.worth(); });
}

/// From where most is seen of what `first` does not see; null when it sees enough, and when most of
/// the rest runs through the body and can be seen from nowhere.
const Sight* complement_of(const Sight& first, const std::vector<Sight>& sights) {
    constexpr double kEnough = 0.8, kMost = 0.5; // shares
    const auto hidden = [&](std::size_t t, std::size_t i) { return !first.visible(t, i); };
    if (first.pixels(hidden) < (1.0 - kEnough) * first.all()) return nullptr;
    const Sight* best = nullptr;
    double most = 0.0;
    for (const Sight& sight : sights) {
        const double shown = sight.pixels(
            [&](std::size_t t, std::size_t i) { return hidden(t, i) && sight.visible(t, i); });
        if (shown <= most || shown < kMost * sight.pixels(hidden)) continue;
        most = shown;
        best = &sight;
    }
    return best;
}

/// One or two pictures next to each other, their name below.
imaging::Image draw_cell(TapeScene& scene, const body::LaidMeasurement& measurement,
                         const TapeSheetOptions& options) {
    const std::span<const geometry::Loop> tapes = measurement.reading.tapes;
    std::vector<imaging::Image> pictures;
    if (tapes.empty()) {
        pictures.push_back(blank(options.width, options.height));
    } else {
        const render::Box box = box_round(tapes);
        scene.lay(tapes, kTape, 0.008f * (box.high.y() - box.low.y()));
        const std::vector<Sight> sights = sights_of(scene, measurement, options);
        const Sight& first = best_of(sights);
        pictures.push_back(scene.draw(first.camera));
        if (const Sight* second = complement_of(first, sights))
            pictures.push_back(scene.draw(second->camera));
        scene.take_off();
    }
    const imaging::Image row = side_by_side(pictures);
    imaging::Image out = blank(row.width, row.height + kCaption);
    paste(out, row, 0, 0);
    for (int x = options.width; x < row.width; x += options.width)
        fill(out, x - 1, 0, 1, row.height, kFrame);
    fill(out, row.width - 1, 0, 1, out.height, kFrame);
    fill(out, 0, out.height - 1, row.width, 1, kFrame);
    LabelStyle caption;
    caption.size = 11;
    caption.at = LabelStyle::At::middle;
    label(out, row.width / 2, out.height - 9, std::string(measurement.definition->name), caption);
    return out;
}

} // namespace

imaging::Image draw_tape_sheet(const body::BodyModel& model,
                               std::span<const body::LaidMeasurement> measurements,
                               const TapeSheetOptions& options) {
    TapeScene scene(model, options.width, options.height, TapeScene::Backdrop::white);
    const int sheet_width = options.columns * options.width;
    const int cell_height = options.height + kCaption;
    std::vector<std::pair<imaging::Image, Eigen::Vector2i>> cells;
    Eigen::Vector2i at(0, 0);
    for (const body::LaidMeasurement& measurement : measurements) {
        imaging::Image cell = draw_cell(scene, measurement, options);
        if (at.x() + cell.width > sheet_width) at = Eigen::Vector2i(0, at.y() + cell_height);
        const int width = cell.width;
        cells.emplace_back(std::move(cell), at);
        at.x() += width;
    }
    imaging::Image out = blank(sheet_width, at.y() + cell_height);
    for (const auto& [cell, place] : cells)
        paste(out, cell, place.x(), place.y());
    return out;
}

} // namespace toile::apps
