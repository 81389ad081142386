#include "apps/tape_picture.h"

#include "apps/contact_sheet.h"
#include "apps/tape_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace toile::apps {
namespace {

constexpr float kRadius = 0.005f; // metres: half a tape's thickness as drawn
constexpr float kBadge = 10.0f;   // pixels: a number's disc

// Colours that stand apart from skin and from each other.
constexpr std::array<Color, 12> kColors{{{{200, 30, 40}},
                                         {{20, 90, 180}},
                                         {{20, 130, 60}},
                                         {{225, 115, 0}},
                                         {{120, 50, 150}},
                                         {{0, 140, 150}},
                                         {{190, 50, 120}},
                                         {{110, 80, 30}},
                                         {{60, 60, 60}},
                                         {{125, 125, 0}},
                                         {{80, 100, 220}},
                                         {{150, 60, 40}}}};

const Color& color_of(std::size_t i) {
    return kColors[i % kColors.size()];
}

/// "under_bust_girth" -> "Under bust girth".
std::string in_words(std::string_view name) {
    std::string out(name);
    std::replace(out.begin(), out.end(), '_', ' ');
    out[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(out[0])));
    return out;
}

std::string centimetres(double metres) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f cm", 100.0 * metres);
    return text.data();
}

/// Where a tape's number belongs in a view: outside of the visible end that lies farthest to the
/// left; upright tapes carry it in their middle. Nothing where the tape is out of sight.
std::optional<Vec2f> badge_place(const TapeScene& scene, const body::LaidMeasurement& measurement,
                                 const render::Camera& camera) {
    std::vector<Vec2f> visible;
    for (const geometry::Loop& tape : measurement.reading.tapes)
        for (const SeenPoint& point : scene.seen(tape, camera))
            if (point.visible) visible.push_back(point.pixel);
    if (visible.size() < 4) return std::nullopt;
    const auto leftmost =
        std::min_element(visible.begin(), visible.end(),
                         [](const Vec2f& a, const Vec2f& b) { return a.x() < b.x(); });
    const auto [low, high] =
        std::minmax_element(visible.begin(), visible.end(),
                            [](const Vec2f& a, const Vec2f& b) { return a.y() < b.y(); });
    const auto [least, most] =
        std::minmax_element(visible.begin(), visible.end(),
                            [](const Vec2f& a, const Vec2f& b) { return a.x() < b.x(); });
    const bool upright = high->y() - low->y() > 2.0f * (most->x() - least->x());
    return upright ? visible[visible.size() / 2] : Vec2f(leftmost->x() - kBadge, leftmost->y());
}

void put_badge(imaging::Image& picture, const Vec2f& at, std::size_t number) {
    disc(picture, at.x(), at.y(), kBadge + 1.5f, {255, 255, 255});
    disc(picture, at.x(), at.y(), kBadge, color_of(number - 1));
    LabelStyle style;
    style.size = 12;
    style.at = LabelStyle::At::middle;
    style.color = {255, 255, 255};
    label(picture, static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())) + 4,
          std::to_string(number), style);
}

/// Numbers that would lie on each other move down.
void spread(std::vector<std::pair<Vec2f, std::size_t>>& badges) {
    std::sort(badges.begin(), badges.end(),
              [](const auto& a, const auto& b) { return a.first.y() < b.first.y(); });
    constexpr float kApart = 2.0f * kBadge + 2.0f;
    for (std::size_t i = 1; i < badges.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const Vec2f between = badges[i].first - badges[j].first;
            if (between.norm() < kApart)
                badges[i].first.y() =
                    badges[j].first.y() + std::sqrt(kApart * kApart - between.x() * between.x());
        }
}

imaging::Image legend(std::span<const body::LaidMeasurement> measurements, const std::string& title,
                      int height) {
    constexpr int kWidth = 360, kMargin = 24, kTop = 56;
    const int most = static_cast<int>(measurements.size()) + 1;
    const int line = std::clamp((height - kTop) / most, 18, 36);
    imaging::Image out = blank(kWidth, height);
    LabelStyle heading;
    heading.size = 20;
    label(out, kMargin, kTop - 16, title, heading);
    LabelStyle value;
    value.at = LabelStyle::At::end;
    int y = kTop + line;
    for (std::size_t i = 0; i < measurements.size() && y < height; ++i, y += line) {
        put_badge(out, {static_cast<float>(kMargin) + kBadge, static_cast<float>(y - 5)}, i + 1);
        label(out, kMargin + 32, y, in_words(measurements[i].definition->name));
        label(out, kWidth - kMargin, y, centimetres(measurements[i].reading.value_m), value);
    }
    return out;
}

} // namespace

imaging::Image draw_tapes(const body::BodyModel& model,
                          std::span<const body::LaidMeasurement> measurements,
                          const TapePictureOptions& options) {
    TapeScene scene(model, options.width, options.height, TapeScene::Backdrop::studio);
    for (std::size_t i = 0; i < measurements.size(); ++i)
        scene.lay(measurements[i].reading.tapes, color_of(i), kRadius);
    std::vector<imaging::Image> pictures;
    for (const render::View& view : render::views_from_names(options.views)) {
        const render::Camera camera = render::frame_view(
            view, scene.bounds().low, scene.bounds().high, options.width, options.height);
        pictures.push_back(scene.draw(camera));
        std::vector<std::pair<Vec2f, std::size_t>> badges;
        for (std::size_t i = 0; i < measurements.size(); ++i)
            if (const auto place = badge_place(scene, measurements[i], camera))
                badges.emplace_back(*place, i + 1);
        spread(badges);
        for (const auto& [place, number] : badges)
            put_badge(pictures.back(), place, number);
    }
    pictures.push_back(legend(measurements, options.title, options.height));
    return side_by_side(pictures);
}

} // namespace toile::apps
