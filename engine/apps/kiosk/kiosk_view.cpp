#include "apps/kiosk/kiosk.h"
#include "apps/kiosk/room.h"
#include "core/error.h"
#include "core/log.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace toile::apps::kiosk {
namespace {

constexpr double kSettled_s = 1.2; // into the quiet pose that a frozen avatar takes

std::string number(double value, int digits) {
    std::array<char, 32> out{};
    std::snprintf(out.data(), out.size(), "%.*f", digits, value);
    return out.data();
}

// "capture:/somewhere/long/room" as "capture:room".
std::string short_name(const std::string& uri) {
    const std::size_t scheme = uri.find(':');
    const std::size_t slash = uri.rfind('/');
    if (scheme == std::string::npos || slash == std::string::npos || slash < scheme) return uri;
    return uri.substr(0, scheme + 1) + uri.substr(slash + 1);
}

render::Rect whole(const render::Screen& screen) {
    return {0.0f, 0.0f, static_cast<float>(screen.width()), static_cast<float>(screen.height())};
}

} // namespace

void Kiosk::load_thumbnails() {
    for (const CarouselItem& item : carousel_)
        display_->screen().remove_picture(item.thumbnail);
    carousel_.clear();
    for (const Article& article : articles_) {
        CarouselItem item{render::PictureId::none, article.name};
        try {
            if (!article.thumbnail.empty())
                item.thumbnail =
                    display_->screen().add_picture(imaging::load_image(article.thumbnail));
        } catch (const Error& e) {
            log::warning(e.what()); // its name is shown without a picture
        }
        carousel_.push_back(item);
    }
}

void Kiosk::rebuild_display(const std::string& why) {
    beat(LifeSign::patience);
    for (Shopper& shopper : visitors_.all())
        for (std::optional<WornLook>& look : shopper.looks)
            if (look) look->meshes.reset();
    display_.reset();
    display_ = std::make_unique<Display>(run_.config, run_.headless);
    display_->picture().spoil(run_.spoil);
    carousel_.clear();
    load_thumbnails();
    for (Shopper& shopper : visitors_.all())
        for (std::optional<WornLook>& look : shopper.looks)
            if (look)
                look->meshes = std::make_unique<WornMeshes>(
                    display_->picture().renderer(), *look->person, look->choice.colour, look->bare);
    if (feed_.up() && camera_frames_ > 0)
        display_->picture().set_camera(feed_.pictures(), feed_.stream());
    note_fault(Fault::picture, texts_.with(Text::picture_lost, {{"why", why}}));
}

render::Placement Kiosk::placement(const render::Rect& to) const {
    render::Placement out;
    out.to = to;
    out.mirrored = true;
    out.scale = static_cast<float>(run_.config.mirror.scale);
    out.offset = Vec2f(static_cast<float>(run_.config.mirror.offset_x),
                       static_cast<float>(run_.config.mirror.offset_y));
    return out;
}

std::optional<Vec2f> Kiosk::on_screen(const Vec3f& world) const {
    const LivePicture& picture = display_->picture();
    if (picture.empty()) return std::nullopt;
    const auto pixel = picture.pixel_of(world);
    if (!pixel) return std::nullopt;
    const render::Placement place = placement(whole(display_->screen()));
    const render::Rect part =
        render::shown_part(picture.camera_width(), picture.camera_height(), place);
    const float across = (pixel->x() + 0.5f - part.x) / part.width;
    return Vec2f((1.0f - across) * place.to.width,
                 (pixel->y() + 0.5f - part.y) / part.height * place.to.height);
}

std::string Kiosk::advice_line(const Shopper& shopper, std::size_t which) const {
    const std::optional<WornLook>& look = shopper.looks[which];
    if (!look || look->choice != shopper.wanted[which]) return texts_[Text::dressing];
    const SizeAdvice& advice = look->advice;
    if (!advice.measured) return texts_.with(Text::not_measured, {{"size", advice.size}});
    if (advice.chosen) return texts_.with(Text::size, {{"size", advice.size}});
    if (!advice.other.empty())
        return texts_.with(Text::between_sizes, {{"size", advice.size}, {"other", advice.other}});
    return texts_.with(Text::fits, {{"size", advice.size}});
}

std::vector<std::string> Kiosk::setup_lines() {
    std::vector<std::string> out;
    const PictureTone& tone = display_->picture().tone();
    if (feed_.up()) {
        const imaging::Intrinsics& camera = feed_.stream().depth;
        out.push_back(texts_.with(
            Text::setup_sensor,
            {{"name", short_name(feed_.uri())},
             {"size", std::to_string(camera.width) + " x " + std::to_string(camera.height)}}));
    } else {
        out.push_back(texts_[Text::setup_no_sensor]);
    }
    out.push_back(floor_ ? texts_.with(Text::setup_floor, {{"height", number(floor_->height_m, 2)},
                                                           {"tilt", number(floor_->tilt_deg, 1)}})
                         : texts_[Text::setup_no_floor]);
    out.push_back(
        texts_.with(Text::setup_camera, {{"height", number(run_.config.camera.height_m, 2)},
                                         {"tilt", number(run_.config.camera.tilt_deg, 1)}}));
    const MirrorSettings& mirror = run_.config.mirror;
    out.push_back(texts_.with(Text::setup_mirror, {{"scale", number(mirror.scale, 2)},
                                                   {"x", number(mirror.offset_x, 2)},
                                                   {"y", number(mirror.offset_y, 2)}}));
    const LightVerdict light = judge_light(tone.level, tone.clipped);
    const Text verdict = light == LightVerdict::dark     ? Text::setup_light_dark
                         : light == LightVerdict::bright ? Text::setup_light_bright
                                                         : Text::setup_light_good;
    out.push_back(texts_.with(Text::setup_light, {{"share", number(100.0 * tone.level, 0)}}) +
                  ": " + texts_[verdict]);
    out.push_back(texts_[Text::setup_keys]);
    return out;
}

ScreenView Kiosk::view() {
    ScreenView out;
    out.screen = screens_.now();
    out.seconds = screens_.seconds();
    out.buttons = buttons();
    out.arrangement = arrangement();
    for (const Pointer& pointer : pointers_)
        if (pointer.rested_on().action != Action::invalid)
            out.rests.push_back({pointer.rested_on(), pointer.progress()});
    out.focus = pointers_[0].focus();
    if (out.screen != ScreenName::setup && out.screen != ScreenName::attract)
        for (const Hand& hand : hands())
            if (hand.raised) out.hands.push_back(hand.place);
    if (!out.hands.empty() || out.focus) hand_at_s_ = now_s_;
    out.attention =
        std::clamp(static_cast<float>(1.0 - (now_s_ - hand_at_s_ - 2.0) / 0.6), 0.0f, 1.0f);
    out.declined = screens_.declined();
    out.far_away = visitors_.somebody_far();
    out.measuring = measuring_;
    out.measured = tailor_.progress();
    out.wanted = turn_.wanted();
    out.turned = {turn_.has(Side::front), turn_.has(Side::left), turn_.has(Side::back),
                  turn_.has(Side::right)};
    out.carousel = carousel_;
    const std::size_t look = screens_.comparing() ? 1 : 0;
    if (const Shopper* shopper = visitors_.first()) out.chosen = shopper->wanted[look].article;
    for (const Shopper& shopper : visitors_.all()) {
        const std::string size =
            shopper.looks[look] ? shopper.looks[look]->advice.size : std::string("...");
        out.size_buttons[shopper.id] = texts_.with(Text::size, {{"size", size}});
    }
    if (out.screen == ScreenName::mirror || out.screen == ScreenName::frozen)
        out.captions = captions();
    if (shopper_note_.until_s > now_s_) out.note = shopper_note_.words;
    if (out.screen == ScreenName::setup) out.setup = setup_lines();
    while (!notes_.empty() && notes_.front().until_s < now_s_)
        notes_.pop_front();
    for (const Note& note : notes_)
        out.operator_lines.push_back(note.words);
    return out;
}

// What everybody here wears, as it is now; of the first one the second look.
std::vector<WornMeshes*> Kiosk::worn_meshes(bool second) {
    std::vector<WornMeshes*> out;
    for (Shopper& shopper : visitors_.all()) {
        const bool other = second && &shopper == visitors_.first();
        std::optional<WornLook>& look = shopper.looks[other ? 1 : 0];
        if (!look || !shopper.here) continue;
        look->meshes->update();
        out.push_back(look->meshes.get());
    }
    return out;
}

// What a look leaves bare differs from what the other one does.
void Kiosk::hide_cloth(bool second) {
    std::vector<LivePicture::Wearer> wearers;
    for (const Shopper& shopper : visitors_.all()) {
        const bool other = second && &shopper == visitors_.first();
        const std::optional<WornLook>& look = shopper.looks[other ? 1 : 0];
        if (look && shopper.here) wearers.push_back({look->person.get(), &look->bare});
    }
    display_->picture().hide_by(feed_.pictures(), wearers);
}

// Camera's picture with everybody's clothes; two looks of the first shopper side by side.
void Kiosk::draw_picture() {
    LivePicture& picture = display_->picture();
    if (picture.empty()) return;
    const bool two = arrangement() == Arrangement::two_looks;
    const Stage stage = stage_of(
        arrangement(), display_->screen().width(), display_->screen().height(),
        static_cast<float>(picture.camera_width()) / static_cast<float>(picture.camera_height()));
    for (std::size_t look = 0; look < (two ? 2u : 1u); ++look) {
        if ((fresh_ || two) && feed_.up()) hide_cloth(look == 1);
        picture.draw_mirror(worn_meshes(look == 1), scale_.now());
        render::Placement place = placement(stage.pictures[look]);
        if (stage.panel) place.scale = 1.0f;
        if (two) {
            // Both halves show the shopper in their middle.
            if (const Shopper* shopper = visitors_.first()) {
                const float* hips = shopper->frame.joints[0].position;
                const auto pixel = picture.pixel_of({hips[0], hips[1], hips[2]});
                if (pixel)
                    place.offset.x() =
                        pixel->x() / static_cast<float>(picture.camera_width()) - 0.5f;
            }
        }
        display_->screen().show(picture.renderer(), place);
    }
}

// The avatar takes a quiet pose, then shows its sides.
void Kiosk::draw_frozen() {
    Shopper* shopper = visitors_.first();
    render::Screen& screen = display_->screen();
    if (shopper == nullptr || !shopper->looks[0]) {
        screen.clear({40, 44, 48, 255});
        return;
    }
    WornLook& look = *shopper->looks[0];
    const body::BodyModel& model = look.person->body().model();
    constexpr double kStep_s = 1.0 / 30.0;
    if (!frozen_from_)
        frozen_from_ = pipeline::local_pose(pipeline::transforms_of(look.person->posed().joints));
    if (frozen_s_ < kSettled_s + 0.6) {
        frozen_s_ += kStep_s;
        body::Pose quiet = body::rest_pose(model.skeleton);
        quiet.hips_position.x() = frozen_from_->hips_position.x();
        quiet.hips_position.z() = frozen_from_->hips_position.z();
        const float way = std::min(1.0f, static_cast<float>(frozen_s_ / kSettled_s));
        const body::Pose pose = pipeline::interpolate(*frozen_from_, quiet, way);
        pipeline::BodyFrame frame = shopper->frame;
        frame.joints = pipeline::joints_of(body::forward_kinematics(model.skeleton, pose), 1.0f);
        look.person->step(frame, kStep_s, clock_);
        look.meshes->update();
    }
    azimuth_deg_ += std::clamp(azimuth_goal_deg_ - azimuth_deg_, -3.0f, 3.0f);
    render::Box box;
    for (const Vec3f& p : look.person->posed().positions)
        box.add(p);
    // As deep as wide, so that the avatar keeps its size while it turns.
    const float half = 0.5f * std::max(box.high.x() - box.low.x(), box.high.z() - box.low.z());
    const Vec3f middle = 0.5f * (box.low + box.high);
    box.low.x() = middle.x() - half;
    box.high.x() = middle.x() + half;
    box.low.z() = middle.z() - half;
    box.high.z() = middle.z() + half;
    box.low.y() -= 0.12f;
    box.high.y() += 0.28f;
    const float smaller = 0.5f * scale_.now();
    display_->picture().draw_studio(
        *look.meshes, azimuth_deg_, box,
        std::max(16, static_cast<int>(smaller * static_cast<float>(screen.width()))),
        std::max(16, static_cast<int>(smaller * static_cast<float>(screen.height()))));
    render::Placement place;
    place.to = whole(screen);
    screen.show(display_->picture().renderer(), place);
}

void Kiosk::draw() {
    if (display_->lost()) throw Error("the graphics context is gone");
    render::Screen& screen = display_->screen();
    screen.clear({24, 30, 34, 255});
    if (screens_.now() != last_screen_) {
        for (Pointer& pointer : pointers_)
            pointer.forget();
        for (Shopper& shopper : visitors_.all())
            shopper.reach.reset();
        follow_reach();
    }
    if (screens_.now() == ScreenName::mirror || screens_.now() == ScreenName::setup) draw_picture();
    if (screens_.now() == ScreenName::frozen) draw_frozen();
    if (snapshot_) keep_picture();
    render::Canvas& canvas = display_->canvas();
    canvas.begin(screen.width(), screen.height());
    paint(canvas, view(), texts_);
    last_screen_ = screens_.now();
    screen.draw(canvas);
    display_->show();
    put_out_pictures();
}

// Headless: what the script asks for, or the last picture, or without a script each of them.
void Kiosk::put_out_pictures() {
    if (!run_.headless || run_.out.empty()) return;
    render::Screen& screen = display_->screen();
    const std::vector<ScriptStep> steps = run_.script.at(number_);
    const bool last_only = run_.out.extension() == ".png";
    imaging::Image picture;
    if (!last_only && run_.script.steps.empty()) {
        screen.read(picture);
        std::array<char, 16> name{};
        std::snprintf(name.data(), name.size(), "%06llu.png",
                      static_cast<unsigned long long>(number_));
        imaging::save_image(picture, run_.out / name.data());
    }
    if (last_only && run_.frames == number_ + 1) {
        screen.read(picture);
        imaging::save_image(picture, run_.out);
    }
    for (const ScriptStep& step : steps) {
        if (step.kind == ScriptStep::Kind::picture) {
            screen.read(picture);
            imaging::save_image(picture, run_.out / (step.name + ".png"));
        }
        if (step.kind == ScriptStep::Kind::mask && !display_->picture().empty())
            imaging::save_image(display_->picture().cloth_mask(worn_meshes(false)),
                                run_.out / (step.name + ".png"));
    }
}

// What the shopper sees, without buttons; only ever on request, and where it lies is said.
void Kiosk::keep_picture() {
    snapshot_ = false;
    imaging::Image picture;
    display_->screen().read(picture);
    std::filesystem::path file;
    for (int i = 1; file.empty() || std::filesystem::exists(file); ++i) {
        std::array<char, 32> name{};
        std::snprintf(name.data(), name.size(), "look-%04d.png", i);
        file = run_.config.snapshots / name.data();
    }
    const std::vector<std::uint8_t> bytes = imaging::encode_png(picture);
    scribe_.write(file, std::string(bytes.begin(), bytes.end()));
    ++metrics_.snapshots;
    shopper_note_ = {texts_.with(Text::snapshot_kept, {{"file", file.filename().string()}}),
                     now_s_ + 6.0};
}

} // namespace toile::apps::kiosk
