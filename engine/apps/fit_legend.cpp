// The legend of a fit map.
#include "apps/fit_map.h"
#include "apps/fit_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace toile::apps {
namespace {

using garment::Verdict;

constexpr Color kInk{33, 33, 33}, kGrey{110, 110, 110};

/// Draws in units of a picture 640 pixels high.
class Sheet {
  public:
    explicit Sheet(int height)
        : scale_(std::clamp(static_cast<float>(height) / 640.0f, 0.5f, 1.6f)),
          picture_(blank(px(kWidth), height)) {}

    void words(float x, float y, float size, const std::string& text, const Color& color,
               LabelStyle::At at = LabelStyle::At::beginning) {
        LabelStyle style;
        style.size = std::max(8, px(size));
        style.color = color;
        style.at = at;
        label(picture_, px(x), px(y), text, style);
    }
    void box(float x, float y, float width, float height, const Color& color) {
        fill(picture_, px(x), px(y), std::max(1, px(x + width) - px(x)),
             std::max(1, px(y + height) - px(y)), color);
    }
    [[nodiscard]] float height() const { return static_cast<float>(picture_.height) / scale_; }
    [[nodiscard]] imaging::Image take() { return std::move(picture_); }

    static constexpr float kWidth = 300.0f, kLeft = 18.0f;

  private:
    [[nodiscard]] int px(float units) const {
        return static_cast<int>(std::lround(scale_ * units));
    }
    float scale_;
    imaging::Image picture_;
};

std::string number(float value) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%g", static_cast<double>(value));
    return text.data();
}

/// High values at the top. Gives where the bar ends.
float draw_scale(Sheet& sheet, const FitScale& scale) {
    constexpr float kTop = 88.0f, kBar = 26.0f;
    const float length = std::min(230.0f, sheet.height() - kTop - 40.0f);
    sheet.words(Sheet::kLeft, 34.0f, 22.0f, scale.title, kInk);
    sheet.words(Sheet::kLeft, 56.0f, 14.0f, std::string(scale.subtitle) + ", in " + scale.unit,
                kGrey);
    sheet.box(Sheet::kLeft - 1.0f, kTop - 1.0f, kBar + 2.0f, length + 2.0f, kGrey);
    constexpr int kSteps = 120;
    for (int i = 0; i < kSteps; ++i) {
        const float share = (static_cast<float>(i) + 0.5f) / kSteps;
        const float y = kTop + length * static_cast<float>(i) / kSteps;
        sheet.box(Sheet::kLeft, y, kBar, kTop + length - y, scale.color(1.0f - share));
    }
    for (int i = 0; i < scale.ticks; ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(scale.ticks - 1);
        const float y = kTop + (1.0f - share) * length;
        sheet.box(Sheet::kLeft + kBar, y - 0.5f, 6.0f, 1.0f, kGrey);
        std::string text = number(std::round(scale.in_print * scale.most * share * 10.0f) / 10.0f);
        if (i == 0) text += std::string("  ") + scale.lowest;
        if (i == scale.ticks - 1) text += std::string("  ") + scale.highest;
        sheet.words(Sheet::kLeft + kBar + 12.0f, y + 5.0f, 15.0f, text, kInk);
    }
    return kTop + length;
}

const char* in_words(Verdict verdict) {
    switch (verdict) {
    case Verdict::too_tight:
        return "too tight";
    case Verdict::tight:
        return "close";
    case Verdict::as_intended:
        return "as designed";
    case Verdict::loose:
        return "relaxed";
    case Verdict::too_loose:
        return "too wide";
    case Verdict::invalid:
        break;
    }
    return "";
}

std::string region_words(garment::FitRegion region) {
    std::string out(garment::name_of(region));
    std::replace(out.begin(), out.end(), '_', ' ');
    out[0] = static_cast<char>(out[0] - 'a' + 'A');
    return out;
}

std::string signed_cm(double metres) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%+.1f cm", 100.0 * metres);
    return text.data();
}

void draw_regions(Sheet& sheet, const garment::FitReport& fit, float y) {
    constexpr float kLine = 21.0f;
    for (const garment::GarmentFit& garment : fit.garments) {
        if (y + 2.0f * kLine > sheet.height()) return;
        sheet.words(Sheet::kLeft, y, 16.0f, garment.name + ", " + garment.size, kInk);
        y += kLine;
        for (const garment::RegionFit& region : garment.regions) {
            if (y + 6.0f > sheet.height()) return;
            sheet.words(Sheet::kLeft, y, 14.0f, region_words(region.region), kInk);
            sheet.words(Sheet::kLeft + 168.0f, y, 14.0f, signed_cm(region.ease_m), kInk,
                        LabelStyle::At::end);
            sheet.words(Sheet::kLeft + 180.0f, y, 14.0f, in_words(region.verdict), kGrey);
            y += kLine;
        }
        y += 8.0f;
    }
    if (y < sheet.height())
        sheet.words(Sheet::kLeft, y, 12.0f, "garment's girth less the body's", kGrey);
}

} // namespace

imaging::Image fit_legend(FitMapKind kind, int height, const garment::FitReport* fit) {
    Sheet sheet(height);
    const float end = draw_scale(sheet, FitScale::of(kind));
    if (fit != nullptr) draw_regions(sheet, *fit, end + 52.0f);
    return sheet.take();
}

} // namespace toile::apps
