#include "body_tracker/forest_trainer.h"

#include "body_tracker/split_search.h"
#include "core/bytes.h"
#include "core/random.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace toile::body_tracker {
namespace {

using Sample = TrainingSet::Sample;

constexpr std::size_t kBatch = 256; ///< nodes between two questions whether to go on
constexpr std::size_t kMaxCheckpointBytes = 512u << 20;

/// Samples of the nodes of one level, each node's together and in their order.
struct Level {
    std::vector<std::uint32_t> nodes; ///< not grown yet
    std::vector<std::size_t> first;   ///< (nodes + 1) into order
    std::vector<std::uint32_t> order; ///< samples

    [[nodiscard]] std::span<const std::uint32_t> samples(std::size_t node) const {
        return std::span(order).subspan(first[node], first[node + 1] - first[node]);
    }
};

std::uint64_t fold(std::uint64_t sum, std::uint64_t value) {
    return Random(sum ^ value).next();
}

/// Tells one training from another.
std::uint64_t fingerprint(const TrainingSet& set, const TrainerOptions& o) {
    std::uint64_t sum = fold(o.seed, set.frame_count());
    for (const int value :
         {o.class_count, o.tree_count, o.depth, o.candidates, o.thresholds, o.reach_mm})
        sum = fold(sum, static_cast<std::uint64_t>(value));
    sum = fold(fold(fold(sum, o.min_samples), o.split_samples), o.max_leaves);
    sum = fold(sum, static_cast<std::uint64_t>(o.balance * 1e6));
    for (const Sample& s : set.samples())
        sum = fold(sum, (std::uint64_t{s.frame} << 32 | std::uint64_t{s.x} << 16 | s.y) ^
                            std::uint64_t{s.label} << 56);
    for (std::uint32_t f = 0; f < set.frame_count(); ++f) {
        const DepthView view = set.frame(f);
        for (const std::uint16_t mm :
             std::span(view.mm, static_cast<std::size_t>(view.width) * view.height))
            sum = sum * 0x100000001b3ull ^ mm;
        sum = fold(sum, static_cast<std::uint64_t>(view.focal_px * 65536.0f));
    }
    return sum;
}

void check(const TrainingSet& set, const TrainerOptions& o) {
    const auto refuse = [](const std::string& what) {
        throw Error("training of the forest: " + what);
    };
    if (o.class_count < 1 || o.class_count > kMaxClasses) refuse("class_count must be 1 to 32");
    if (o.tree_count < 1 || o.tree_count > kMaxTrees) refuse("tree_count must be 1 to 16");
    if (o.depth < 1 || o.depth > 30) refuse("depth must be 1 to 30");
    if (o.candidates < 1) refuse("candidates must be 1 or more");
    if (o.thresholds < 1 || o.thresholds > 31) refuse("thresholds must be 1 to 31");
    if (!(o.balance >= 0.0 && o.balance <= 1.0)) refuse("balance must be 0 to 1");
    if (o.max_leaves < 2) refuse("max_leaves must be 2 or more");
    if (o.reach_mm < 1 || o.reach_mm > 4000) refuse("reach_mm must be 1 to 4000");
    if (o.min_samples < 2 || o.split_samples < 2)
        refuse("min_samples and split_samples must be 2 or more");
    if (set.samples().empty()) refuse("there are no samples; add labelled frames");
    for (const Sample& s : set.samples())
        if (s.label >= static_cast<std::uint32_t>(o.class_count))
            refuse("frame " + std::to_string(s.frame) + " has label " + std::to_string(s.label) +
                   ", but class_count is " + std::to_string(o.class_count));
}

class Trainer {
  public:
    Trainer(const TrainingSet& set, const TrainerOptions& options, const RowLoop& rows)
        : set_(set), options_(options), rows_(rows), search_(set, options),
          fingerprint_(fingerprint(set, options)) {
        forest_.class_count = options.class_count;
        load_checkpoint();
    }

    std::optional<Forest> run(const TrainerProgress& progress) {
        for (int t = std::max(static_cast<int>(forest_.trees.size()) - 1, 0);
             t < options_.tree_count; ++t) {
            if (static_cast<int>(forest_.trees.size()) == t) {
                forest_.trees.emplace_back().nodes.resize(1);
                level_ = 0;
            }
            for (Level level = find_level(); !level.nodes.empty(); level = descend(level)) {
                if (!grow(level, progress)) return std::nullopt;
                ++level_;
                save_checkpoint();
            }
        }
        return std::move(forest_);
    }

  private:
    [[nodiscard]] ForestTree& tree() { return forest_.trees.back(); }
    [[nodiscard]] const Sample& sample(std::uint32_t index) const { return set_.samples()[index]; }
    [[nodiscard]] bool goes_on(std::uint32_t index, const ForestNode& node) const {
        const Sample& s = sample(index);
        return feature_value(node.feature, set_.frame(s.frame), s.x, s.y) >= node.threshold;
    }

    /// Node that a sample has come to; -1 in a leaf.
    [[nodiscard]] std::int64_t arrive(std::uint32_t index) const {
        const auto& nodes = forest_.trees.back().nodes;
        std::int32_t at = 0;
        while (nodes[static_cast<std::size_t>(at)].child > 0) {
            const ForestNode& node = nodes[static_cast<std::size_t>(at)];
            at = node.child + (goes_on(index, node) ? 1 : 0);
        }
        return nodes[static_cast<std::size_t>(at)].child < 0 ? -1 : at;
    }

    /// The level follows from the tree alone, so that a checkpoint needs no samples.
    [[nodiscard]] Level find_level() {
        const auto count = static_cast<std::uint32_t>(set_.samples().size());
        std::vector<std::int64_t> at(count);
        rows_(count, 4096, [&](std::uint32_t begin, std::uint32_t end) {
            for (std::uint32_t i = begin; i < end; ++i)
                at[i] = arrive(i);
        });
        Level level;
        std::vector<std::size_t> place(tree().nodes.size());
        for (std::size_t n = 0; n < tree().nodes.size(); ++n)
            if (tree().nodes[n].child == 0) {
                place[n] = level.nodes.size();
                level.nodes.push_back(static_cast<std::uint32_t>(n));
            }
        level.first.assign(level.nodes.size() + 1, 0);
        for (const std::int64_t node : at)
            if (node >= 0) ++level.first[place[static_cast<std::size_t>(node)] + 1];
        for (std::size_t n = 1; n < level.first.size(); ++n)
            level.first[n] += level.first[n - 1];
        level.order.resize(level.first.back());
        auto next = level.first;
        for (std::uint32_t i = 0; i < count; ++i)
            if (at[i] >= 0) level.order[next[place[static_cast<std::size_t>(at[i])]]++] = i;
        return level;
    }

    /// The next level: what find_level gives, without the walk from the root.
    [[nodiscard]] Level descend(const Level& level) {
        const auto& nodes = tree().nodes;
        std::vector<std::uint8_t> sides(level.order.size());
        rows_(static_cast<std::uint32_t>(level.nodes.size()), 16,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::size_t n = begin; n < end; ++n) {
                      if (nodes[level.nodes[n]].child < 0) continue;
                      for (std::size_t i = level.first[n]; i < level.first[n + 1]; ++i)
                          sides[i] = goes_on(level.order[i], nodes[level.nodes[n]]) ? 1 : 0;
                  }
              });
        Level next;
        next.first.push_back(0);
        for (std::size_t n = 0; n < level.nodes.size(); ++n) {
            const std::int32_t child = nodes[level.nodes[n]].child;
            if (child < 0) continue;
            for (std::uint8_t side = 0; side < 2; ++side) {
                next.nodes.push_back(static_cast<std::uint32_t>(child) + side);
                for (std::size_t i = level.first[n]; i < level.first[n + 1]; ++i)
                    if (sides[i] == side) next.order.push_back(level.order[i]);
                next.first.push_back(next.order.size());
            }
        }
        return next;
    }

    /// False when told to stop; the tree is as before then.
    [[nodiscard]] bool grow(const Level& level, const TrainerProgress& progress) {
        std::vector<Split> splits(level.nodes.size());
        for (std::size_t begin = 0; begin < splits.size(); begin += kBatch) {
            const double in_level = static_cast<double>(begin) / static_cast<double>(splits.size());
            const double in_tree = (level_ + in_level) / (options_.depth + 1);
            const auto number = forest_.trees.size();
            if (!progress((static_cast<double>(number - 1) + in_tree) / options_.tree_count,
                          "tree " + std::to_string(number) + ", level " + std::to_string(level_) +
                              ": " + std::to_string(level.nodes.size()) + " nodes"))
                return false;
            find_splits(level, begin, std::min(begin + kBatch, splits.size()), splits);
        }
        keep_best(splits);
        for (std::size_t n = 0; n < splits.size(); ++n)
            finish(level.nodes[n], level.samples(n), splits[n]);
        return true;
    }

    void find_splits(const Level& level, std::size_t begin, std::size_t end,
                     std::vector<Split>& splits) const {
        const auto blocks = static_cast<std::size_t>(
            (options_.candidates + SplitSearch::kBlock - 1) / SplitSearch::kBlock);
        std::vector<Split> found((end - begin) * blocks);
        rows_(static_cast<std::uint32_t>(found.size()), 4,
              [&](std::uint32_t from, std::uint32_t to) {
                  SplitSearch::Scratch scratch;
                  for (std::size_t i = from; i < to; ++i) {
                      const std::size_t n = begin + i / blocks;
                      const auto first = static_cast<int>(i % blocks) * SplitSearch::kBlock;
                      if (may_split(level.samples(n)))
                          found[i] = search_.best(forest_.trees.size(), level.nodes[n],
                                                  level.samples(n), first, scratch);
                  }
              });
        for (std::size_t i = 0; i < found.size(); ++i)
            if (Split& best = splits[begin + i / blocks]; found[i].gain > best.gain)
                best = found[i];
    }

    [[nodiscard]] bool may_split(std::span<const std::uint32_t> samples) const {
        return level_ < options_.depth && samples.size() >= options_.min_samples;
    }

    /// Takes away the splits that gain least, so that the leaves keep within their bound. A level
    /// may use half of what is left, so that the best branches can grow deep.
    void keep_best(std::vector<Split>& splits) {
        const std::size_t leaves =
            tree().leaves.size() / static_cast<std::size_t>(options_.class_count) + splits.size();
        const std::size_t left = options_.max_leaves > leaves ? options_.max_leaves - leaves : 0;
        const std::size_t allowed = level_ + 1 < options_.depth ? (left + 1) / 2 : left;
        std::vector<std::size_t> order;
        for (std::size_t n = 0; n < splits.size(); ++n)
            if (splits[n].gain > 0.0) order.push_back(n);
        if (order.size() <= allowed) return;
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return splits[a].gain != splits[b].gain ? splits[a].gain > splits[b].gain : a < b;
        });
        for (const std::size_t n : std::span(order).subspan(allowed))
            splits[n].gain = 0.0;
    }

    /// A question or a leaf.
    void finish(std::uint32_t node, std::span<const std::uint32_t> samples, const Split& split) {
        if (split.gain <= 0.0) {
            add_leaf(node, samples);
            return;
        }
        ForestNode& grown = tree().nodes[node];
        grown.feature = split.feature;
        grown.threshold = static_cast<std::int16_t>(split.threshold);
        grown.child = static_cast<std::int32_t>(tree().nodes.size());
        tree().nodes.resize(tree().nodes.size() + 2);
    }

    void add_leaf(std::uint32_t node, std::span<const std::uint32_t> samples) {
        const auto classes = static_cast<std::size_t>(options_.class_count);
        tree().nodes[node].child = ~static_cast<std::int32_t>(tree().leaves.size() / classes);
        std::array<std::uint64_t, kMaxClasses> counts{};
        std::uint64_t all = 0;
        for (const std::uint32_t index : samples) {
            const std::uint32_t label = sample(index).label;
            counts[label] += search_.weights()[label];
            all += search_.weights()[label];
        }
        for (std::size_t c = 0; c < classes; ++c)
            tree().leaves.push_back(static_cast<std::uint8_t>((counts[c] * 510 + all) / (2 * all)));
    }

    void save_checkpoint() const {
        if (options_.checkpoint.empty()) return;
        std::vector<std::uint8_t> bytes = encode_forest(forest_);
        for (const std::uint64_t value : {fingerprint_, static_cast<std::uint64_t>(level_)})
            for (int shift = 0; shift < 64; shift += 8)
                bytes.push_back(static_cast<std::uint8_t>(value >> shift));
        // Renamed when whole: a stop while it is written leaves the one before.
        auto half = options_.checkpoint;
        half += ".part";
        write_bytes(half, bytes);
        std::filesystem::rename(half, options_.checkpoint);
    }

    void load_checkpoint() {
        const auto& file = options_.checkpoint;
        if (file.empty() || !std::filesystem::exists(file)) return;
        const auto bytes = read_bytes(file, kMaxCheckpointBytes);
        if (bytes.size() < 16) throw FileError(file.string(), "is cut short; delete it");
        std::array<std::uint64_t, 2> tail{};
        std::memcpy(tail.data(), bytes.data() + bytes.size() - 16, 16);
        forest_ = decode_forest(std::span(bytes).first(bytes.size() - 16), file.string(), true);
        if (tail[0] != fingerprint_ || tail[1] > 31)
            throw FileError(file.string(), "is of a training with other samples or options; delete "
                                           "it, or train as before");
        level_ = static_cast<int>(tail[1]);
    }

    const TrainingSet& set_;
    const TrainerOptions& options_;
    const RowLoop& rows_;
    SplitSearch search_;
    std::uint64_t fingerprint_ = 0;
    Forest forest_; ///< the last tree is growing
    int level_ = 0;
};

} // namespace

std::optional<Forest> train_forest(const TrainingSet& set, const TrainerOptions& options,
                                   const RowLoop& rows, const TrainerProgress& progress) {
    check(set, options);
    return Trainer(set, options, rows).run(progress);
}

} // namespace toile::body_tracker
