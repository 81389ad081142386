#include "body_tracker/parts_frames.h"

#include "body_tracker/forest_trainer.h"

#include <cmath>
#include <gtest/gtest.h>

namespace toile::body_tracker {
namespace {

const body::BodySpace& space() {
    static const body::BodySpace loaded = body::BodySpace::load(body::find_avatar("adult"));
    return loaded;
}

TEST(PartsFrames, ATriangleHasItsDepthsAndTheNearestWins) {
    const std::vector<Vec3f> points = {{-9, -9, -2}, {9, -9, -2}, {0, 9, -2},
                                       {-9, -9, -3}, {9, -9, -3}, {0, 9, -3}};
    const std::vector<Triangle> triangles = {{0, 1, 2}, {3, 4, 5}};
    const std::vector<PartLabel> labels = {PartLabel::head, PartLabel::head, PartLabel::head,
                                           PartLabel::neck, PartLabel::neck, PartLabel::neck};
    PartsFrame frame;
    frame.width = frame.height = 20;
    frame.focal_px = 20.0f;
    draw_parts(points, triangles, labels, frame);
    for (std::size_t i = 0; i < frame.mm.size(); ++i) {
        EXPECT_EQ(frame.mm[i], 2000);
        EXPECT_EQ(frame.labels[i], PartLabel::head);
    }
}

TEST(PartsFrames, AreTheSameWhenAskedAgainAndLabelledWhereSeen) {
    const FrameMaker maker(space(), 4, 7, {});
    for (std::uint32_t i = 0; i < 20; ++i) {
        const PartsFrame frame = maker.make(i);
        EXPECT_EQ(frame.mm, maker.make(i).mm);
        std::size_t seen = 0;
        for (std::size_t p = 0; p < frame.mm.size(); ++p) {
            EXPECT_EQ(frame.mm[p] == 0, frame.labels[p] == PartLabel::invalid);
            seen += frame.mm[p] != 0 ? 1 : 0;
        }
        EXPECT_GT(seen, 200u) << "frame " << i;
    }
    EXPECT_NE(maker.make(0).mm, maker.make(1).mm);
}

TEST(PartsFrames, TheHipsLieBehindTheirSurface) {
    FrameRange range;
    range.clothes = range.noise = false;
    const FrameMaker maker(space(), 4, 7, range);
    int inside = 0;
    for (std::uint32_t i = 0; i < 40; ++i) {
        const PartsFrame frame = maker.make(i);
        const Vec3f hips = frame.joints[0];
        const auto x = std::lround(0.5f * static_cast<float>(frame.width - 1) -
                                   frame.focal_px * hips.x() / hips.z());
        const auto y = std::lround(0.5f * static_cast<float>(frame.height - 1) +
                                   frame.focal_px * hips.y() / hips.z());
        if (x < 0 || y < 0 || x >= frame.width || y >= frame.height) continue;
        const int mm = frame.mm[static_cast<std::size_t>(y * frame.width + x)];
        EXPECT_GT(mm, 0) << "frame " << i;
        EXPECT_LT(mm, -1000.0f * hips.z()) << "frame " << i;
        ++inside;
    }
    EXPECT_GT(inside, 20);
}

TrainingSet samples(const FrameMaker& maker, std::uint32_t frames) {
    TrainingSet set;
    for (std::uint32_t f = 0; f < frames; ++f) {
        const PartsFrame frame = maker.make(f);
        std::vector<TrainingSet::Sample> taken;
        for (int y = f % 3; y < frame.height; y += 3)
            for (int x = 0; x < frame.width; x += 3) {
                const auto label = frame.labels[static_cast<std::size_t>(y * frame.width + x)];
                if (label != PartLabel::invalid)
                    taken.push_back({0, static_cast<std::uint16_t>(x),
                                     static_cast<std::uint16_t>(y),
                                     static_cast<std::uint32_t>(label) - 1});
            }
        set.add({frame.width, frame.height, frame.focal_px, frame.mm.data()}, taken);
    }
    return set;
}

TEST(PartsFrames, TeachAForestPeopleItHasNotSeen) {
    TrainerOptions options;
    options.class_count = kPartCount;
    options.tree_count = 1;
    options.depth = 10;
    options.candidates = 60;
    options.thresholds = 10;
    options.split_samples = 1000;
    const Forest forest =
        *train_forest(samples(FrameMaker(space(), 10, 1, {}), 150), options, serial_rows,
                      [](double, const std::string&) { return true; });
    const TrainingSet unseen = samples(FrameMaker(space(), 5, 2, {}), 30);
    std::size_t right = 0;
    std::array<std::size_t, kPartCount> counts{};
    for (const auto& s : unseen.samples()) {
        std::array<std::uint16_t, kPartCount> sums{};
        classify(forest, unseen.frame(s.frame), s.x, s.y, sums);
        right += std::max_element(sums.begin(), sums.end()) - sums.begin() == s.label ? 1 : 0;
        ++counts[s.label];
    }
    const auto all = static_cast<double>(unseen.samples().size());
    const double share = static_cast<double>(right) / all;
    RecordProperty("pixels_right", std::to_string(share));
    // Guessing the commonest part for every pixel is what it must leave far behind.
    EXPECT_GT(share,
              2.0 * static_cast<double>(*std::max_element(counts.begin(), counts.end())) / all);
}

} // namespace
} // namespace toile::body_tracker
