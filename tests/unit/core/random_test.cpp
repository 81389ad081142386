// Random numbers: the published sequence, and distributions that are what they claim to be.
#include "core/random.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <numeric>
#include <vector>

namespace toile {
namespace {

constexpr int kMany = 200'000;

TEST(Random, IsSplitMix64) {
    // The reference program's first five for seed 1234567 (Vigna, splitmix64.c).
    Random random(1234567);
    for (const std::uint64_t expected :
         {6457827717110365317ull, 3203168211198807973ull, 9817491932198370423ull,
          4593380528125082431ull, 16408922859458223821ull})
        EXPECT_EQ(random.next(), expected);
}

TEST(Random, TheSeedDecidesEverything) {
    Random a(5);
    Random b(5);
    Random c(6);
    bool differs = false;
    for (int i = 0; i < 100; ++i) {
        const double x = a.normal();
        EXPECT_EQ(x, b.normal());
        differs = differs || x != c.normal();
    }
    EXPECT_TRUE(differs);
}

TEST(Random, UniformFillsItsIntervalEvenly) {
    Random random(1);
    std::array<int, 20> bins{};
    for (int i = 0; i < kMany; ++i) {
        const double x = random.uniform();
        ASSERT_GE(x, 0.0);
        ASSERT_LT(x, 1.0);
        ++bins[static_cast<std::size_t>(x * bins.size())];
    }
    // Chi-squared with 19 degrees of freedom: 43.8 is passed once in a thousand seeds.
    const double expected = static_cast<double>(kMany) / bins.size();
    double chi_squared = 0.0;
    for (const int count : bins)
        chi_squared += (count - expected) * (count - expected) / expected;
    EXPECT_LT(chi_squared, 43.8);
}

TEST(Random, UniformBetweenTwoNumbers) {
    Random random(2);
    std::vector<double> values(kMany);
    std::generate(values.begin(), values.end(), [&] { return random.uniform(-3.0, 5.0); });
    EXPECT_GE(*std::min_element(values.begin(), values.end()), -3.0);
    EXPECT_LT(*std::max_element(values.begin(), values.end()), 5.0);
    EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0) / kMany, 1.0, 0.02);
}

TEST(Random, NormalHasTheMomentsOfANormal) {
    Random random(3);
    std::array<double, 5> moment{};
    for (int i = 0; i < kMany; ++i) {
        const double x = random.normal();
        ASSERT_TRUE(std::isfinite(x));
        for (std::size_t k = 1; k < moment.size(); ++k)
            moment[k] += std::pow(x, static_cast<double>(k)) / kMany;
    }
    // Five standard errors of each.
    EXPECT_NEAR(moment[1], 0.0, 5.0 * std::sqrt(1.0 / kMany));
    EXPECT_NEAR(moment[2], 1.0, 5.0 * std::sqrt(2.0 / kMany));
    EXPECT_NEAR(moment[3], 0.0, 5.0 * std::sqrt(15.0 / kMany));
    EXPECT_NEAR(moment[4], 3.0, 5.0 * std::sqrt(96.0 / kMany));
}

TEST(Random, NeighboursAreNotCorrelated) {
    Random random(4);
    double sum = 0.0;
    double last = random.uniform() - 0.5;
    for (int i = 0; i < kMany; ++i) {
        const double now = random.uniform() - 0.5;
        sum += last * now;
        last = now;
    }
    EXPECT_NEAR(12.0 * sum / kMany, 0.0, 5.0 / std::sqrt(kMany));
}

} // namespace
} // namespace toile
