#include "apps/kiosk/preview.h"

#include "apps/kiosk/catalogue.h"
#include "apps/kiosk/display.h"
#include "apps/kiosk/painter.h"
#include "core/error.h"
#include "garment/manifest.h"

namespace toile::apps::kiosk {

void preview(const KioskConfig& config, const std::string& screen,
             const std::filesystem::path& file) {
    ScreenView view;
    view.screen = screen_from_name(screen);
    if (view.screen == ScreenName::invalid) {
        std::string known;
        for (int i = 1; i <= static_cast<int>(ScreenName::safe); ++i)
            known += (i > 1 ? ", " : "") + std::string(screen_name(static_cast<ScreenName>(i)));
        throw UsageError("--preview '" + screen + "': the screens are " + known);
    }
    const Texts texts = Texts::load(config.language);
    Display display(config, true);
    for (const auto& source : garment_sources(config.garments, config.garments_folder)) {
        const Article article = read_article_head(source);
        CarouselItem item{render::PictureId::none, article.name};
        if (!article.thumbnail.empty())
            item.thumbnail = display.screen().add_picture(imaging::load_image(article.thumbnail));
        view.carousel.push_back(item);
    }
    // A visit in the middle of it.
    Screens visit({}, true, view.screen == ScreenName::safe);
    std::vector<Action> offers;
    for (int i = 0; i < 10; ++i)
        visit.tick({0.1, 1, Measuring::not_begun});
    if (view.screen == ScreenName::consent) offers = visit.offers();
    visit.act(Action::agree);
    if (view.screen == ScreenName::measure) offers = visit.offers();
    visit.act(Action::skip);
    if (view.screen == ScreenName::mirror) offers = visit.offers();
    visit.act(Action::freeze);
    if (view.screen == ScreenName::frozen) offers = visit.offers();
    visit.act(Action::open_setup);
    if (view.screen == ScreenName::setup) offers = visit.offers();
    if (config.snapshots.empty()) std::erase(offers, Action::snapshot);
    view.buttons = lay_out(offers, config.width, config.height, {});
    view.seconds = 2.6;
    view.wanted = Side::left;
    view.turned = {true, false, false, false};
    view.measuring = Measuring::looking;
    view.size_buttons[0] = texts.with(Text::size, {{"size", "M"}});
    if (view.screen == ScreenName::mirror || view.screen == ScreenName::frozen) {
        const Measures sizes = measures(config.width, config.height);
        const float wide = 0.34f * static_cast<float>(config.width);
        view.captions.push_back({{sizes.edge, sizes.margin, wide, 0.0f},
                                 render::Align::start,
                                 view.carousel.empty() ? "" : view.carousel.front().name,
                                 texts.with(Text::fits, {{"size", "M"}})});
    }
    for (const Text words : {Text::setup_no_sensor, Text::setup_no_floor, Text::setup_keys})
        view.setup.push_back(texts[words]);
    render::Canvas& canvas = display.canvas();
    canvas.begin(config.width, config.height);
    paint(canvas, view, texts);
    display.screen().clear({96, 104, 108, 255});
    display.screen().draw(canvas);
    imaging::Image picture;
    display.screen().read(picture);
    imaging::save_image(picture, file);
}

} // namespace toile::apps::kiosk
