#include "apps/catalogue_results.h"
#include "apps/contact_sheet.h"
#include "apps/label.h"
#include "core/error.h"

#include <algorithm>
#include <array>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kPictureHeight = 260, kCaption = 40, kGap = 10, kSheetWidth = 1800;
constexpr std::size_t kRows = 6;
constexpr int kLetter = 8; // about the width of one, pixels

/// Breaks at "_", "+" or a space where a line would be longer than `letters`.
std::vector<std::string> lines_of(const std::string& text, std::size_t letters) {
    std::vector<std::string> out;
    std::string rest = text;
    while (rest.size() > letters) {
        const std::size_t at = rest.find_last_of("_+ ", letters - 1);
        const std::size_t cut = at == std::string::npos || at == 0 ? letters : at + 1;
        out.push_back(rest.substr(0, cut));
        rest.erase(0, cut);
    }
    out.push_back(rest);
    return out;
}

void write_lines(imaging::Image& picture, int x, int y, int most,
                 const std::vector<std::string>& lines, const Color& color) {
    for (const std::string& text : lines) {
        if (most-- == 0) return;
        label(picture, x, y += 15, text, {.size = 13, .color = color});
    }
}

imaging::Image picture_of(const CataloguePlan& plan, const CatalogueItem& item, int width) {
    const ItemRecord record = read_record(plan, item);
    imaging::Image out = blank(width, kPictureHeight + kCaption);
    const auto letters = static_cast<std::size_t>(std::max(8, width / kLetter));
    if (record.state == ItemState::done) {
        std::vector<imaging::Image> views;
        for (const render::View& view : plan.views)
            views.push_back(shrunk(imaging::load_image(plan.out / item.id / (view.name + ".png")),
                                   kPictureHeight));
        paste(out, side_by_side(views), 0, 0);
    } else {
        fill(out, 0, 0, width, kPictureHeight, {228, 228, 228});
        write_lines(out, 8, 8, 12,
                    lines_of(record.state == ItemState::failed ? record.error : "not made yet",
                             letters - 2),
                    {150, 30, 30});
    }
    const bool beyond = !beyond_limits(plan, record).empty();
    write_lines(out, 2, kPictureHeight, 2, lines_of(item.id, letters),
                beyond ? Color{150, 30, 30} : Color{33, 33, 33});
    return out;
}

fs::path sheet_file(const CataloguePlan& plan, std::size_t number) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "sheet-%03zu.png", number);
    return plan.out / name.data();
}

} // namespace

void write_sheets(const CataloguePlan& plan, const std::vector<CatalogueItem>& items) {
    for (const fs::directory_entry& entry : fs::directory_iterator(plan.out)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("sheet-") && name.ends_with(".png")) fs::remove(entry.path());
    }
    const int width = static_cast<int>(plan.views.size()) *
                      std::max(1, plan.picture.width * kPictureHeight / plan.picture.height);
    const auto columns = static_cast<std::size_t>(std::max(1, kSheetWidth / (width + kGap)));
    const std::size_t on_one = columns * kRows;
    for (std::size_t first = 0; first < items.size(); first += on_one) {
        const std::size_t count = std::min(on_one, items.size() - first);
        const auto across = static_cast<int>(std::min(columns, count));
        const auto down = static_cast<int>((count + columns - 1) / columns);
        imaging::Image sheet =
            blank(across * (width + kGap) + kGap, down * (kPictureHeight + kCaption + kGap) + kGap);
        for (std::size_t i = 0; i < count; ++i)
            paste(sheet, picture_of(plan, items[first + i], width),
                  kGap + static_cast<int>(i % columns) * (width + kGap),
                  kGap + static_cast<int>(i / columns) * (kPictureHeight + kCaption + kGap));
        imaging::save_image(sheet, sheet_file(plan, first / on_one + 1));
    }
}

} // namespace toile::apps
