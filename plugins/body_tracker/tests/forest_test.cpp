#include "body_tracker/forest.h"

#include "core/error.h"

#include <cstring>
#include <gmock/gmock.h>

namespace toile::body_tracker {
namespace {

/// One question: is there something nearer than 0.5 m behind, 100 mm to the right?
Forest right_of_edge() {
    Forest forest;
    forest.class_count = 2;
    ForestTree tree;
    tree.nodes.resize(3);
    tree.nodes[0] = {{100, 0, 0, 0}, 500, 0, 1};
    tree.nodes[1].child = ~0;
    tree.nodes[2].child = ~1;
    tree.leaves = {255, 0, 55, 200};
    forest.trees = {tree};
    return forest;
}

/// A row of `count` pixels at 1 m, from the left.
std::vector<std::uint16_t> bar(int width, int count, std::uint16_t mm) {
    std::vector<std::uint16_t> depth(static_cast<std::size_t>(width));
    std::fill(depth.begin(), depth.begin() + count, mm);
    return depth;
}

std::string refusal(const std::vector<std::uint8_t>& bytes) {
    try {
        (void)decode_forest(bytes, "a.forest");
    } catch (const FileError& e) {
        return e.what();
    }
    return "accepted";
}

TEST(Forest, AnswersAKnownTree) {
    const auto depth = bar(40, 30, 1000);
    const DepthView view{40, 1, 100.0f, depth.data()}; // 100 mm = 10 pixels at 1 m
    std::vector<std::uint8_t> labels(40), shares(40);
    label_pixels(right_of_edge(), view, {1, labels, shares}, 0, 1);
    for (int x = 0; x < 40; ++x) {
        const int expected = x < 20 ? 1 : x < 30 ? 2 : 0;
        EXPECT_EQ(labels[static_cast<std::size_t>(x)], expected) << x;
    }
    EXPECT_EQ(shares[0], 255);
    EXPECT_EQ(shares[25], 200);
}

TEST(Forest, OffsetsAreMetricWhateverTheDistance) {
    for (const int metres : {1, 2, 5}) {
        const auto depth = bar(40, 30, static_cast<std::uint16_t>(1000 * metres));
        const DepthView view{40, 1, 100.0f, depth.data()};
        std::vector<std::uint8_t> labels(40), shares(40);
        label_pixels(right_of_edge(), view, {1, labels, shares}, 0, 1);
        EXPECT_EQ(std::count(labels.begin(), labels.end(), 2), 10 / metres);
    }
}

TEST(Forest, StepsLabelTheSamePixels) {
    const auto depth = bar(41, 30, 1000);
    const DepthView view{41, 1, 100.0f, depth.data()};
    std::vector<std::uint8_t> all(41), every(21), shares(41);
    label_pixels(right_of_edge(), view, {1, all, shares}, 0, 1);
    label_pixels(right_of_edge(), view, {2, every, shares}, 0, 1);
    for (std::size_t i = 0; i < every.size(); ++i)
        EXPECT_EQ(every[i], all[2 * i]);
}

TEST(Forest, FilesComeBackTheSame) {
    const auto bytes = encode_forest(right_of_edge());
    EXPECT_EQ(encode_forest(decode_forest(bytes, "a.forest")), bytes);
}

TEST(Forest, DamagedFilesAreRefused) {
    using testing::HasSubstr;
    const auto good = encode_forest(right_of_edge());
    for (std::size_t i = 0; i < good.size(); ++i) {
        auto bad = good;
        bad[i] ^= 1;
        EXPECT_THAT(refusal(bad), HasSubstr("a.forest: ")) << "byte " << i;
        EXPECT_NE(refusal({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(i)}),
                  "accepted");
    }
    Forest forest = right_of_edge();
    forest.trees[0].nodes[1].child = ~2;
    EXPECT_THAT(refusal(encode_forest(forest)), HasSubstr("node 1 names a leaf"));
    forest.trees[0].nodes[1].child = 1;
    EXPECT_THAT(refusal(encode_forest(forest)), HasSubstr("node 1 names a node"));
    forest.trees[0].nodes[1].child = 0;
    EXPECT_THAT(refusal(encode_forest(forest)), HasSubstr("node 1 leads nowhere"));
    forest.trees[0].nodes.clear();
    EXPECT_THAT(refusal(encode_forest(forest)), HasSubstr("a tree has no nodes"));
    forest.trees.clear();
    EXPECT_THAT(refusal(encode_forest(forest)), HasSubstr("no trees"));
}

} // namespace
} // namespace toile::body_tracker
