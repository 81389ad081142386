#include "apps/kiosk/painter.h"

#include "apps/kiosk/garment_cards.h"
#include "apps/kiosk/inks.h"

#include <algorithm>
#include <cmath>

namespace toile::apps::kiosk {
namespace {

using render::Align;
using render::Canvas;
using render::Ink;
using render::Rect;
using render::TextStyle;

constexpr Ink kButton{18, 24, 28, 208};
constexpr Ink kTop{35, 58, 66, 255};
constexpr Ink kBottom{12, 18, 22, 255};

class Painter {
  public:
    Painter(Canvas& canvas, const ScreenView& view, const Texts& texts)
        : canvas_(canvas), view_(view), texts_(texts),
          sizes_(measures(canvas.width(), canvas.height())), w_(static_cast<float>(canvas.width())),
          h_(static_cast<float>(canvas.height())) {}

    void paint() {
        if (!shows_picture(view_.screen)) canvas_.shade({0, 0, w_, h_}, kTop, kBottom);
        switch (view_.screen) {
        case ScreenName::attract:
            attract();
            break;
        case ScreenName::consent:
            consent();
            break;
        case ScreenName::measure:
            measure();
            break;
        case ScreenName::mirror:
        case ScreenName::frozen:
            mirror();
            break;
        case ScreenName::goodbye:
            sentence(Text::goodbye_title,
                     view_.declined ? Text::declined_line : Text::goodbye_line);
            break;
        case ScreenName::setup:
            setup();
            break;
        case ScreenName::safe:
            sentence(Text::safe_title, Text::safe_line);
            break;
        case ScreenName::invalid:
            break;
        }
        for (const Button& button : view_.buttons)
            draw_button(button);
        for (const Vec2f& hand : view_.hands)
            draw_hand(hand);
        operator_lines();
    }

  private:
    [[nodiscard]] TextStyle title() const { return {sizes_.title, kWhite, Align::middle, true}; }
    [[nodiscard]] TextStyle line() const { return {sizes_.text, kSoft, Align::middle, false}; }

    // Title and line about the middle.
    void sentence(Text head, Text words) {
        float y = 0.40f * h_;
        y += canvas_.paragraph({0.5f * w_, y}, sizes_.body.width, texts_[head], title());
        canvas_.paragraph({0.5f * w_, y + sizes_.text}, sizes_.body.width, texts_[words], line());
    }

    void attract() {
        const auto count = view_.carousel.size();
        const float tall = 0.34f * h_;
        const float wide = 0.75f * tall;
        const float gap = 0.25f * wide;
        const float row = 0.30f * h_;
        // Garments pass by, slowly.
        const auto moved = static_cast<float>(0.05 * view_.seconds) * h_;
        const float period = static_cast<float>(count) * (wide + gap);
        for (std::size_t i = 0; i < count && period > 0.0f; ++i) {
            float x = static_cast<float>(i) * (wide + gap) - std::fmod(moved, period) - period;
            for (; x < w_; x += period)
                if (x > -wide) draw_card(canvas_, view_.carousel[i], {x, row, wide, tall}, false);
        }
        canvas_.paragraph({0.5f * w_, 0.10f * h_}, sizes_.body.width, texts_[Text::attract_title],
                          title());
        const Text below = view_.far_away ? Text::come_closer : Text::attract_line;
        canvas_.paragraph({0.5f * w_, 0.74f * h_}, sizes_.body.width, texts_[below],
                          {1.2f * sizes_.text, kWhite, Align::middle, false});
        // Two feet on the mark.
        const Vec2f mark(0.5f * w_, 0.88f * h_);
        canvas_.ring(mark, 0.055f * h_, 1.0f, kAccent, 0.006f * h_);
        for (const float side : {-1.0f, 1.0f}) {
            const Vec2f foot = mark + Vec2f(side * 0.018f * h_, 0.0f);
            const std::array<Vec2f, 2> sole = {foot + Vec2f(0.0f, 0.018f * h_),
                                               foot - Vec2f(0.0f, 0.014f * h_)};
            canvas_.line(sole, kAccent, 0.018f * h_);
            for (const Vec2f& end : sole)
                canvas_.disc(end, 0.009f * h_, kAccent);
        }
    }

    // Sentences above the buttons where there is room, else below: hands decide where those are.
    [[nodiscard]] float beside_buttons(float needed) const {
        float top = h_;
        float bottom = 0.0f;
        for (const Button& button : view_.buttons) {
            top = std::min(top, button.rect.y);
            bottom = std::max(bottom, button.rect.y + button.rect.height);
        }
        const float above = top - sizes_.text - needed;
        if (above >= sizes_.margin) return std::min(above, 0.07f * h_);
        return std::min(bottom + sizes_.text, h_ - sizes_.margin - needed);
    }

    void consent() {
        const std::array<Text, 4> asked = {Text::consent_camera, Text::consent_measure,
                                           Text::consent_kept, Text::consent_network};
        const float wide = 0.94f * sizes_.body.width;
        float needed = paragraph_height(texts_[Text::consent_title], sizes_.body.width, title()) +
                       1.8f * sizes_.text;
        for (const Text words : asked)
            needed += paragraph_height(texts_[words], wide, line()) + 0.4f * sizes_.text;
        float y = beside_buttons(needed);
        y += canvas_.paragraph({0.5f * w_, y}, sizes_.body.width, texts_[Text::consent_title],
                               title());
        y += 0.3f * sizes_.text;
        for (const Text words : asked)
            y +=
                canvas_.paragraph({0.5f * w_, y}, wide, texts_[words], line()) + 0.4f * sizes_.text;
        hint(y);
    }

    [[nodiscard]] float paragraph_height(const std::string& words, float width,
                                         TextStyle style) const {
        return canvas_.paragraph_height(width, words, style);
    }

    void hint(float y) {
        canvas_.paragraph({0.5f * w_, y}, sizes_.body.width, texts_[Text::hand_hint],
                          {sizes_.text, kAccent, Align::middle, false});
    }

    void measure() {
        if (view_.measuring == Measuring::working || view_.measuring == Measuring::done) {
            working();
            return;
        }
        float y = sizes_.margin;
        y += canvas_.paragraph({0.5f * w_, y}, sizes_.body.width, texts_[Text::measure_title],
                               title());
        const bool failed = view_.measuring == Measuring::failed;
        const std::array<Text, 4> asked = {Text::measure_front, Text::measure_left,
                                           Text::measure_back, Text::measure_right};
        const auto at = static_cast<std::size_t>(view_.wanted);
        const Text words = failed ? Text::measure_failed : asked.at(at > 0 ? at - 1 : 0);
        y += canvas_.paragraph({0.5f * w_, y}, sizes_.body.width, texts_[words], line());
        const float bottom = h_ - 0.14f * h_;
        const float tall = bottom - y - sizes_.text;
        draw_guide(canvas_, {0.5f * w_ - 0.4f * tall, y + 0.5f * sizes_.text, 0.8f * tall, tall},
                   view_.wanted, view_.seconds);
        for (std::size_t i = 0; i < view_.turned.size(); ++i) {
            const Vec2f spot(0.5f * w_ + (static_cast<float>(i) - 1.5f) * 0.07f * h_, 0.92f * h_);
            canvas_.ring(spot, 0.018f * h_, 1.0f, kSoft, 0.004f * h_);
            if (view_.turned[i]) canvas_.disc(spot, 0.012f * h_, kAccent);
        }
    }

    void working() {
        const Vec2f centre(0.5f * w_, 0.45f * h_);
        const bool done = view_.measuring == Measuring::done;
        const float radius = 0.09f * h_;
        canvas_.ring(centre, radius, 1.0f, {255, 255, 255, 60}, 0.012f * h_);
        canvas_.ring(centre, radius, done ? 1.0f : static_cast<float>(view_.measured), kAccent,
                     0.012f * h_);
        canvas_.paragraph({0.5f * w_, 0.62f * h_}, sizes_.body.width,
                          texts_[done ? Text::measure_done : Text::measure_working], title());
    }

    void mirror() {
        const Stage stage = stage_of(view_.arrangement, canvas_.width(), canvas_.height());
        if (stage.panel) canvas_.shade(*stage.panel, kTop, kBottom);
        if (view_.screen == ScreenName::frozen) {
            heading(texts_[Text::frozen_title], sizes_.margin);
        } else if (view_.arrangement == Arrangement::two_looks) {
            const float x = 0.5f * w_;
            const Rect& picture = stage.pictures[0];
            if (h_ > w_)
                canvas_.fill({x - 2.0f, 0.0f, 4.0f, picture.y + picture.height},
                             {255, 255, 255, 160});
            draw_carousel(canvas_, view_, stage.carousel);
        } else if (view_.arrangement == Arrangement::one) {
            draw_neighbours(canvas_, view_);
        }
        for (const Caption& caption : view_.captions)
            draw_caption(canvas_, caption);
        if (!view_.note.empty()) heading(view_.note, h_ - sizes_.margin - 1.9f * sizes_.text);
    }

    // One line on a panel, centred.
    void heading(const std::string& words, float y) {
        TextStyle style{sizes_.text, kWhite, Align::middle, true};
        style.size = canvas_.fitting_size(words, style, sizes_.body.width - 2.0f * sizes_.text);
        style.size = std::max(style.size, sizes_.text);
        const float wide =
            std::min(canvas_.text_width(words, style), sizes_.body.width) + sizes_.text;
        const bool one = canvas_.text_width(words, style) <= sizes_.body.width;
        if (one)
            canvas_.fill({0.5f * (w_ - wide), y, wide, 1.5f * sizes_.text}, kPanel,
                         0.75f * sizes_.text);
        canvas_.paragraph({0.5f * w_, y + 0.22f * sizes_.text}, sizes_.body.width, words, style);
    }

    void setup() {
        const float wide = w_ - 4.0f * sizes_.margin;
        const TextStyle style{sizes_.text, kWhite, Align::start, false};
        float tall = 1.8f * sizes_.title + sizes_.margin;
        for (const std::string& words : view_.setup)
            tall += canvas_.paragraph_height(wide, words, style);
        canvas_.fill({sizes_.margin, sizes_.margin, w_ - 2.0f * sizes_.margin, tall}, kPanel,
                     0.5f * sizes_.text);
        float y = 1.5f * sizes_.margin;
        canvas_.text({0.5f * w_, y}, texts_[Text::setup_title], title());
        y += 1.5f * sizes_.title;
        for (const std::string& words : view_.setup)
            y += canvas_.paragraph({2.0f * sizes_.margin, y}, wide, words, style);
        // Where a person on the mark stands.
        const std::array<Vec2f, 2> upright = {Vec2f(0.5f * w_, 0.1f * h_),
                                              Vec2f(0.5f * w_, 0.97f * h_)};
        canvas_.line(upright, {244, 186, 96, 130}, 0.002f * h_);
        canvas_.ring({0.5f * w_, 0.93f * h_}, 0.04f * h_, 1.0f, kAccent, 0.003f * h_);
    }

    [[nodiscard]] std::string words_of(const Button& button) const {
        switch (button.action) {
        case Action::agree:
            return texts_[Text::agree];
        case Action::decline:
            return texts_[Text::decline];
        case Action::skip:
            return texts_[Text::skip];
        case Action::try_again:
            return texts_[Text::try_again];
        case Action::next_garment:
            return texts_[Text::next_garment];
        case Action::previous_garment:
            return texts_[Text::previous_garment];
        case Action::next_size:
            return view_.size_buttons.contains(button.person) ? view_.size_buttons.at(button.person)
                                                              : std::string();
        case Action::next_colour:
            return texts_[Text::colour];
        case Action::freeze:
            return texts_[Text::freeze];
        case Action::turn:
            return texts_[Text::turn];
        case Action::live:
        case Action::close_setup:
            return texts_[Text::live];
        case Action::compare:
            return texts_[view_.arrangement == Arrangement::two_looks ? Text::compare_done
                                                                      : Text::compare];
        case Action::snapshot:
            return texts_[Text::snapshot];
        case Action::finish:
            return texts_[Text::finish];
        default:
            return {};
        }
    }

    void draw_button(const Button& button) {
        const Rect& r = button.rect;
        const Target target{button.action, button.person};
        const auto rest = std::find_if(view_.rests.begin(), view_.rests.end(),
                                       [&](const Rest& one) { return one.target == target; });
        const bool rested = rest != view_.rests.end();
        const bool focused = view_.focus && *view_.focus == target;
        const float round = 0.5f * r.height;
        // Over the picture buttons step back until a hand is raised.
        const bool over = shows_picture(view_.screen) &&
                          !stage_of(view_.arrangement, canvas_.width(), canvas_.height()).panel;
        const float shown = over ? 0.35f + 0.65f * view_.attention : 1.0f;
        const auto faded = [&](Ink ink) {
            ink.alpha = static_cast<std::uint8_t>(shown * static_cast<float>(ink.alpha));
            return ink;
        };
        canvas_.fill(r, faded(button.action == Action::agree ? Ink{38, 92, 70, 232} : kButton),
                     round);
        if (rested && rest->progress > 0.0f) {
            const float filled = std::max(r.height, rest->progress * r.width);
            canvas_.fill({r.x, r.y, filled, r.height}, {244, 186, 96, 150}, round);
        }
        canvas_.outline(r, rested || focused ? kAccent : faded({255, 255, 255, 110}),
                        (rested || focused ? 0.05f : 0.025f) * r.height, round);
        TextStyle style{sizes_.text, kWhite, Align::middle, true};
        const std::string words = words_of(button);
        if (canvas_.text_width(words, style) <= r.width - 0.35f * r.height ||
            words.find(' ') == std::string::npos) {
            canvas_.text({r.centre().x(), r.centre().y() - 0.56f * style.size}, words, style);
            return;
        }
        // Two lines: words never get smaller than what can be read.
        style.size = std::min(style.size, 0.40f * r.height);
        canvas_.paragraph({r.centre().x(), r.centre().y() - 1.18f * style.size},
                          r.width - 0.35f * r.height, words, style);
    }

    void draw_hand(const Vec2f& hand) {
        canvas_.ring(hand, 0.020f * h_, 1.0f, {255, 255, 255, 220}, 0.004f * h_);
        for (const Rest& rest : view_.rests)
            for (const Button& button : view_.buttons)
                if (Target{button.action, button.person} == rest.target && rest.progress > 0.0f &&
                    button.rect.inset(-0.25f * button.rect.height).contains(hand))
                    canvas_.ring(hand, 0.026f * h_, rest.progress, kAccent, 0.008f * h_);
        canvas_.disc(hand, 0.007f * h_, kAccent);
    }

    void operator_lines() {
        constexpr float kSmall = 0.62f; // for those who stand right before it
        const float size = kSmall * sizes_.text;
        float y = h_ - 0.35f * size;
        for (auto one = view_.operator_lines.rbegin(); one != view_.operator_lines.rend(); ++one) {
            y -= 1.35f * size;
            std::string words = *one;
            const TextStyle style{size, {255, 214, 150, 255}, Align::start, false};
            while (words.size() > 8 && canvas_.text_width(words, style) > w_ - 2.0f * size)
                words = shortened(words);
            canvas_.fill({0, y - 0.15f * size, w_, 1.35f * size}, {0, 0, 0, 190});
            canvas_.text({size, y}, words, style);
        }
    }

    Canvas& canvas_;
    const ScreenView& view_;
    const Texts& texts_;
    Measures sizes_;
    float w_;
    float h_;
};

} // namespace

bool shows_picture(ScreenName screen) {
    return screen == ScreenName::mirror || screen == ScreenName::frozen ||
           screen == ScreenName::setup;
}

void paint(render::Canvas& canvas, const ScreenView& view, const Texts& texts) {
    Painter(canvas, view, texts).paint();
}

} // namespace toile::apps::kiosk
