// Restarts, garments on disk, the light in a picture, the room.
#include "apps/kiosk/catalogue.h"
#include "apps/kiosk/light.h"
#include "apps/kiosk/restart_policy.h"
#include "apps/kiosk/room.h"
#include "core/bytes.h"
#include "core/error.h"
#include "imaging/srgb.h"
#include "support/garments.h"
#include "support/temporary_folder.h"

#include <chrono>
#include <gmock/gmock.h>
#include <random>
#include <thread>

namespace toile::test {
namespace {

using namespace apps::kiosk;
using testing::HasSubstr;

TEST(KioskRestarts, AreQuickAtFirstAndSafeAfterThree) {
    RestartPolicy policy;
    const auto first = policy.crashed(10.0);
    EXPECT_FALSE(first.safe);
    EXPECT_FALSE(first.stock);
    const auto second = policy.crashed(11.0);
    EXPECT_LE(second.pause_s, 1.0);
    EXPECT_TRUE(second.stock) << "others' plugins may be at fault";
    EXPECT_FALSE(second.safe);
    const auto third = policy.crashed(12.0);
    EXPECT_TRUE(third.safe);
    EXPECT_TRUE(third.stock);
    EXPECT_LE(third.pause_s, 2.0);
    EXPECT_FALSE(policy.recovered(300.0));
    EXPECT_TRUE(policy.recovered(12.0 + 600.0));
    policy.leave_safe_mode();
    EXPECT_FALSE(policy.stock());
    EXPECT_FALSE(policy.crashed(700.0).safe);
    EXPECT_EQ(policy.restarts(), 4u);
}

TEST(KioskRestarts, RareCrashesNeverLeadToSafeMode) {
    RestartPolicy policy;
    for (int i = 0; i < 100; ++i) {
        const auto decision = policy.crashed(121.0 * i);
        EXPECT_FALSE(decision.safe);
        EXPECT_FALSE(decision.stock);
        EXPECT_DOUBLE_EQ(decision.pause_s, 0.2);
    }
}

Article article(std::size_t sizes, std::size_t colours) {
    Article out;
    out.sizes.resize(sizes);
    out.colours.resize(colours);
    return out;
}

TEST(KioskCatalogue, StepsGoRoundAndSizesComeBackToTheSuitingOne) {
    Choice choice{2, 0, 1};
    EXPECT_EQ(step(choice, 1, 3), (Choice{0, 0, 0}));
    EXPECT_EQ(step(choice, -3, 3).article, 2u);
    const Article two = article(2, 3);
    std::vector<std::size_t> sizes;
    std::vector<std::size_t> colours;
    for (int i = 0; i < 3; ++i) {
        choice = next_size(choice, two);
        sizes.push_back(choice.size);
        choice = next_colour(choice, two);
        colours.push_back(choice.colour);
    }
    EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 2, 0}));
    EXPECT_EQ(colours, (std::vector<std::size_t>{2, 0, 1}));
    EXPECT_EQ(next_colour({}, article(1, 0)).colour, 0u);
}

std::vector<CatalogueChange> changes_within(CatalogueWatch& watch, double seconds) {
    std::vector<CatalogueChange> out;
    for (int i = 0; i < static_cast<int>(seconds * 100.0) && out.empty(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        out = watch.take();
    }
    return out;
}

TEST(KioskCatalogue, AChangedGarmentIsReadAgainAndABadOneRefused) {
    const TemporaryFolder folder;
    const std::filesystem::path source = folder / "test-skirt";
    garment::write_package(small_package(), source);
    const Article first = read_article(source);
    CatalogueWatch watch({first}, 0.05);
    EXPECT_TRUE(changes_within(watch, 0.3).empty()) << "nothing changed";
    const auto bytes = read_bytes(source / "garment.json", 1u << 20);
    std::string text(bytes.begin(), bytes.end());
    const std::string::size_type at = text.find("\"name\"");
    ASSERT_NE(at, std::string::npos);
    std::string broken = text;
    broken.replace(at, 6, "\"nmae\"");
    write_text(source / "garment.json", broken);
    const auto refused = changes_within(watch, 10.0);
    ASSERT_EQ(refused.size(), 1u);
    EXPECT_THAT(refused[0].refused, HasSubstr("/name: is missing"));
    EXPECT_EQ(refused[0].article.id, first.id);
    write_text(source / "garment.json", text + "\n");
    const auto again = changes_within(watch, 10.0);
    ASSERT_EQ(again.size(), 1u);
    EXPECT_EQ(again[0].refused, "");
    EXPECT_NE(again[0].article.stamp, first.stamp);
}

TEST(KioskCatalogue, AnEmptyFolderIsSaid) {
    const TemporaryFolder folder;
    EXPECT_THROW((void)garment_sources({}, folder.path()), Error);
    EXPECT_THROW((void)garment_sources({"no-such-garment"}, {}), Error);
}

/// Places of a ball in four colours, lit as E(n) = 1 + c d . n.
std::vector<LitPlace> ball(const Vec3f& direction, float contrast, float brightness) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::vector<LitPlace> out;
    while (out.size() < 1200) {
        LitPlace place;
        place.normal = Vec3f(normal(random), normal(random), normal(random)).normalized();
        if (place.normal.z() < 0.1f) continue;
        place.group = static_cast<std::uint8_t>(out.size() % 4);
        const Vec3f albedo = Vec3f::Constant(0.15f + 0.15f * static_cast<float>(place.group));
        place.color = brightness * albedo *
                      (1.0f + contrast * direction.dot(place.normal) + 0.03f * normal(random));
        out.push_back(place);
    }
    return out;
}

TEST(KioskLight, DirectionAndContrastComeBackWhateverTheColours) {
    for (const Vec3f& direction :
         {Vec3f(0.6f, 0.6f, 0.5f), Vec3f(-0.8f, 0.3f, 0.5f), Vec3f(0.0f, 0.9f, 0.4f)}) {
        const Vec3f d = direction.normalized();
        for (const float brightness : {0.2f, 0.8f}) {
            const PictureLight light = estimate_light(ball(d, 0.5f, brightness), {0.5f}, {});
            EXPECT_GT(light.direction.dot(d), 0.93f);
            EXPECT_NEAR(light.contrast, 0.5f, 0.15f);
            EXPECT_FLOAT_EQ(light.level, 0.5f);
        }
    }
}

TEST(KioskLight, TooFewPlacesKeepWhatWasKnown) {
    PictureLight before;
    before.direction = Vec3f::UnitX();
    const auto some = ball(Vec3f::UnitY(), 0.5f, 1.0f);
    const PictureLight light = estimate_light({some.data(), 40}, {0.3f}, before);
    EXPECT_EQ(light.direction, before.direction);
    EXPECT_FLOAT_EQ(light.level, 0.3f);
}

imaging::Image flat(const Vec3f& linear, float noise) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    imaging::Image out{200, 160, {}};
    for (int i = 0; i < 200 * 160; ++i) {
        for (int k = 0; k < 3; ++k)
            out.pixels.push_back(static_cast<std::uint8_t>(
                std::clamp(255.0f * (imaging::srgb_from_linear(linear[k]) + noise * normal(random)),
                           0.0f, 255.0f)));
        out.pixels.push_back(255);
    }
    return out;
}

TEST(KioskLight, ABrighterAndAWarmerPictureAreTold) {
    const PictureTone dim = picture_tone(flat(Vec3f::Constant(0.05f), 0.0f));
    const PictureTone bright = picture_tone(flat(Vec3f::Constant(0.20f), 0.0f));
    EXPECT_NEAR(bright.level / dim.level, 4.0f, 0.3f);
    const PictureTone warm = picture_tone(flat(Vec3f(0.3f, 0.2f, 0.1f), 0.0f));
    EXPECT_GT(warm.tint.x(), 1.1f);
    EXPECT_LT(warm.tint.z(), 0.9f);
    EXPECT_NEAR(warm.tint.mean(), 1.0f, 1e-4f);
    EXPECT_EQ(judge_light(dim.level, 0.0f), LightVerdict::good);
    EXPECT_EQ(judge_light(0.03f, 0.0f), LightVerdict::dark);
    EXPECT_EQ(judge_light(0.5f, picture_tone(flat(Vec3f::Ones(), 0.0f)).clipped),
              LightVerdict::bright);
}

TEST(KioskLight, NoiseIsMeasured) {
    for (const float noise : {0.008f, 0.02f})
        EXPECT_NEAR(picture_tone(flat(Vec3f::Constant(0.2f), noise)).noise, noise, 0.3f * noise);
    EXPECT_LT(picture_tone(flat(Vec3f::Constant(0.2f), 0.0f)).noise, 0.002f);
}

TEST(KioskLight, TheRenderersLightHasTheSameMeanAndGradient) {
    PictureLight light;
    light.direction = Vec3f(0.6f, 0.0f, 0.8f);
    light.contrast = 0.5f;
    light.level = 0.7f;
    const render::Lighting made = lighting_of(light);
    // Mean over the sphere of key max(0, d . n) + surroundings.
    const Vec3f mean = 0.25f * made.key_color + 0.5f * (made.sky + made.ground);
    EXPECT_NEAR(mean.x(), 0.7f, 1e-3f);
    EXPECT_EQ(made.key_direction, light.direction);
    EXPECT_NEAR(0.5f * made.key_color.x(), 0.35f, 1e-3f);
}

TEST(KioskRoom, TheCameraIsFoundFromTheFloor) {
    imaging::Intrinsics camera{320, 240, 290.0, 290.0, 159.5, 119.5, {}};
    for (const CameraSettings& set :
         {CameraSettings{1.2, -8.0}, CameraSettings{0.9, 0.0}, CameraSettings{1.9, -22.0}}) {
        const Eigen::Isometry3d place = camera_place(set);
        imaging::DepthImage depth{320, 240, {}};
        for (int y = 0; y < 240; ++y)
            for (int x = 0; x < 320; ++x) {
                const Vec3d ray = *imaging::unproject(camera, {x, y}, 1.0);
                const Vec3d world = place.linear() * ray;
                double t = 3.5 / -world.z(); // a wall
                if (world.y() < 0.0) t = std::min(t, set.height_m / -world.y());
                depth.metres.push_back(static_cast<float>(t));
            }
        const auto found = find_camera(depth, camera);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->height_m, set.height_m, 0.04);
        EXPECT_NEAR(found->tilt_deg, set.tilt_deg, 1.0);
    }
    imaging::DepthImage nothing{320, 240, std::vector<float>(320 * 240, std::nanf(""))};
    EXPECT_FALSE(find_camera(nothing, camera));
}

} // namespace
} // namespace toile::test
