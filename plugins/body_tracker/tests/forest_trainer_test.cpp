#include "body_tracker/forest_trainer.h"

#include "core/error.h"
#include "core/random.h"
#include "support/temporary_folder.h"

#include <gmock/gmock.h>
#include <thread>

namespace toile::body_tracker {
namespace {

constexpr int kSide = 48;

/// Squares of 24 pixels somewhere, 0.9 to 1.1 m away; classes are their four quarters.
TrainingSet squares(std::uint64_t seed, int frames) {
    TrainingSet set;
    Random random(seed);
    for (int f = 0; f < frames; ++f) {
        std::vector<std::uint16_t> mm(kSide * kSide);
        const auto mmv = static_cast<std::uint16_t>(random.uniform(900.0, 1100.0));
        const int x0 = static_cast<int>(random.uniform(0.0, 24.0));
        const int y0 = static_cast<int>(random.uniform(0.0, 24.0));
        std::vector<TrainingSet::Sample> samples;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                mm[static_cast<std::size_t>((y0 + y) * kSide + x0 + x)] = mmv;
                samples.push_back({0, static_cast<std::uint16_t>(x0 + x),
                                   static_cast<std::uint16_t>(y0 + y),
                                   (x >= 12 ? 1u : 0u) + (y >= 12 ? 2u : 0u)});
            }
        set.add({kSide, kSide, 60.0f, mm.data()}, samples);
    }
    return set;
}

TrainerOptions small() {
    TrainerOptions options;
    options.class_count = 4;
    options.tree_count = 2;
    options.depth = 7;
    options.candidates = 60;
    options.thresholds = 8;
    options.reach_mm = 500;
    return options;
}

/// Two threads, each taking every second range.
void two_threads(std::uint32_t count, std::uint32_t grain,
                 const std::function<void(std::uint32_t, std::uint32_t)>& body) {
    const auto run = [&](std::uint32_t first) {
        for (std::uint64_t at = std::uint64_t{first} * grain; at < count; at += 2ull * grain)
            body(static_cast<std::uint32_t>(at),
                 static_cast<std::uint32_t>(std::min<std::uint64_t>(at + grain, count)));
    };
    std::jthread other(run, 1u);
    run(0);
}

bool always(double, const std::string&) {
    return true;
}

std::string refusal(const TrainingSet& set, const TrainerOptions& options) {
    try {
        (void)train_forest(set, options, serial_rows, always);
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

TEST(ForestTrainer, LearnsTheQuartersOfUnseenSquares) {
    const Forest forest = *train_forest(squares(1, 30), small(), serial_rows, always);
    const TrainingSet unseen = squares(2, 10);
    std::size_t right = 0;
    for (const auto& s : unseen.samples()) {
        std::array<std::uint16_t, 4> sums{};
        classify(forest, unseen.frame(s.frame), s.x, s.y, sums);
        right += std::max_element(sums.begin(), sums.end()) - sums.begin() == s.label ? 1 : 0;
    }
    // Chance is 0.25; a pixel at a border between quarters may go either way.
    EXPECT_GT(static_cast<double>(right), 0.9 * static_cast<double>(unseen.samples().size()));
}

TEST(ForestTrainer, ThreadsDoNotChangeTheBytes) {
    const TrainingSet set = squares(1, 8);
    EXPECT_EQ(encode_forest(*train_forest(set, small(), serial_rows, always)),
              encode_forest(*train_forest(set, small(), two_threads, always)));
}

TEST(ForestTrainer, ResumedGivesTheSameBytesWhereverItStopped) {
    const TrainingSet set = squares(1, 8);
    const auto whole = encode_forest(*train_forest(set, small(), serial_rows, always));
    for (const int levels : {1, 5, 8, 11}) {
        const test::TemporaryFolder folder;
        TrainerOptions options = small();
        options.checkpoint = folder.path() / "parts.checkpoint";
        int left = levels;
        const auto stop = [&](double, const std::string&) { return left-- > 0; };
        ASSERT_FALSE(train_forest(set, options, serial_rows, stop).has_value());
        int grown = 0;
        const auto count = [&](double, const std::string&) { return ++grown > 0; };
        EXPECT_EQ(encode_forest(*train_forest(set, options, serial_rows, count)), whole);
        EXPECT_EQ(grown, 16 - levels); // two trees of 7 levels of questions and one of leaves
    }
}

std::size_t leaves(const Forest& forest, std::size_t tree) {
    return forest.trees[tree].leaves.size() / static_cast<std::size_t>(forest.class_count);
}

TEST(ForestTrainer, LeavesKeepWithinTheirBound) {
    const TrainingSet set = squares(1, 20);
    const Forest free = *train_forest(set, small(), serial_rows, always);
    ASSERT_GT(leaves(free, 0), 20u);
    TrainerOptions options = small();
    options.max_leaves = 12;
    const Forest bounded = *train_forest(set, options, serial_rows, always);
    for (const std::size_t tree : {0u, 1u}) {
        EXPECT_LE(leaves(bounded, tree), 12u);
        EXPECT_GE(leaves(bounded, tree), 9u);
    }
}

TEST(ForestTrainer, BalanceHelpsARareClass) {
    // Of one quarter only every 40th pixel is given.
    TrainingSet rare;
    const TrainingSet all = squares(1, 30);
    std::vector<TrainingSet::Sample> kept;
    for (std::uint32_t f = 0, at = 0; f < all.frame_count(); ++f) {
        kept.clear();
        for (; at < all.samples().size() && all.samples()[at].frame == f; ++at)
            if (all.samples()[at].label != 3 || at % 40 == 0) kept.push_back(all.samples()[at]);
        rare.add(all.frame(f), kept);
    }
    const auto found = [&](double balance) {
        TrainerOptions options = small();
        options.depth = 4;
        options.balance = balance;
        const Forest forest = *train_forest(rare, options, serial_rows, always);
        std::size_t right = 0;
        const TrainingSet unseen = squares(2, 10);
        for (const auto& s : unseen.samples()) {
            std::array<std::uint16_t, 4> sums{};
            classify(forest, unseen.frame(s.frame), s.x, s.y, sums);
            right += s.label == 3 && std::max_element(sums.begin(), sums.end()) == sums.end() - 1;
        }
        return right;
    };
    EXPECT_GT(found(1.0), found(0.0));
}

TEST(ForestTrainer, CheckpointsOfAnotherTrainingAreRefused) {
    const test::TemporaryFolder folder;
    TrainerOptions options = small();
    options.checkpoint = folder.path() / "parts.checkpoint";
    ASSERT_TRUE(train_forest(squares(1, 4), options, serial_rows, always).has_value());
    EXPECT_THAT(refusal(squares(2, 4), options), testing::HasSubstr("other samples or options"));
    ++options.seed;
    EXPECT_THAT(refusal(squares(1, 4), options), testing::HasSubstr("other samples or options"));
}

TEST(ForestTrainer, BadOptionsAndSamplesAreRefused) {
    using testing::HasSubstr;
    TrainerOptions options = small();
    EXPECT_THAT(refusal({}, options), HasSubstr("there are no samples"));
    options.class_count = 3;
    EXPECT_THAT(refusal(squares(1, 1), options), HasSubstr("has label 3, but class_count is 3"));
    options = small();
    options.balance = 1.5;
    EXPECT_THAT(refusal(squares(1, 1), options), HasSubstr("balance must be 0 to 1"));
    options = small();
    options.depth = 0;
    EXPECT_THAT(refusal(squares(1, 1), options), HasSubstr("depth must be 1 to 30"));
    const std::vector<std::uint16_t> mm = {0, 1000};
    const TrainingSet::Sample nobody{0, 0, 0, 0}, outside{0, 2, 0, 0};
    TrainingSet set;
    EXPECT_THROW(set.add({2, 1, 60.0f, mm.data()}, std::span(&nobody, 1)), Error);
    EXPECT_THROW(set.add({2, 1, 60.0f, mm.data()}, std::span(&outside, 1)), Error);
    EXPECT_THROW(set.add({2, 1, 0.0f, mm.data()}, {}), Error);
}

} // namespace
} // namespace toile::body_tracker
