#include "body_tracker/forest_trainer.h"

#include "core/bytes.h"
#include "core/random.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace toile::body_tracker {
namespace {

using Sample = TrainingSet::Sample;
using Counts = std::array<std::uint32_t, kMaxClasses>;

constexpr std::uint32_t kBatch = 256; ///< nodes whose candidates are kept at once
constexpr std::size_t kMaxCheckpointBytes = 512u << 20;

/// One question and how much purer it leaves the samples; gain 0 = none.
struct Split {
    double gain = 0.0;
    int threshold = 0;
};

/// Sum over classes of n_c^2 / n: the larger, the purer.
double purity(const Counts& counts) {
    double squares = 0.0, total = 0.0;
    for (const std::uint32_t n : counts) {
        squares += static_cast<double>(n) * n;
        total += n;
    }
    return total > 0.0 ? squares / total : 0.0;
}

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
    sum = fold(fold(sum, o.min_samples), o.split_samples);
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
    if (o.candidates < 1 || o.thresholds < 1) refuse("candidates and thresholds must be 1 or more");
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
        : set_(set), options_(options), rows_(rows), fingerprint_(fingerprint(set, options)) {
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
            for (Level level = find_level(); !level.nodes.empty(); level = find_level()) {
                const double done =
                    (t + static_cast<double>(level_) / (options_.depth + 1)) / options_.tree_count;
                if (!progress(done, "tree " + std::to_string(t + 1) + ", level " +
                                        std::to_string(level_) + ": " +
                                        std::to_string(level.nodes.size()) + " nodes"))
                    return std::nullopt;
                grow(level);
                ++level_;
                save_checkpoint();
            }
        }
        return std::move(forest_);
    }

  private:
    [[nodiscard]] ForestTree& tree() { return forest_.trees.back(); }
    [[nodiscard]] const Sample& sample(std::uint32_t index) const { return set_.samples()[index]; }

    /// Node that a sample has come to; -1 in a leaf.
    [[nodiscard]] std::int64_t arrive(std::uint32_t index) const {
        const Sample& s = sample(index);
        const DepthView view = set_.frame(s.frame);
        const auto& nodes = forest_.trees.back().nodes;
        std::int32_t at = 0;
        while (nodes[static_cast<std::size_t>(at)].child > 0) {
            const ForestNode& node = nodes[static_cast<std::size_t>(at)];
            at =
                node.child + (feature_value(node.feature, view, s.x, s.y) < node.threshold ? 0 : 1);
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

    [[nodiscard]] Counts count(std::span<const std::uint32_t> samples) const {
        Counts counts{};
        for (const std::uint32_t index : samples)
            ++counts[sample(index).label];
        return counts;
    }

    /// The candidate's feature; the same whoever asks.
    [[nodiscard]] DepthFeature draw(std::uint32_t node, int candidate) const {
        Random random(fold(fold(fold(options_.seed, forest_.trees.size()), node),
                           static_cast<std::uint64_t>(candidate)));
        // Cubes: near places are asked more often than far ones.
        const auto offset = [&] {
            const double u = random.uniform(-1.0, 1.0);
            return static_cast<std::int16_t>(u * u * u * options_.reach_mm);
        };
        DepthFeature feature;
        feature.ax = offset();
        feature.ay = offset();
        if (random.next() % 2 == 0) return feature;
        feature.bx = offset();
        feature.by = offset();
        return feature;
    }

    /// Best threshold of one feature for a node's samples.
    [[nodiscard]] Split try_feature(const DepthFeature& feature,
                                    std::span<const std::uint32_t> samples) const {
        const std::size_t used = std::min<std::size_t>(samples.size(), options_.split_samples);
        std::vector<std::pair<int, std::uint32_t>> values(used); // feature, class
        for (std::size_t i = 0; i < used; ++i) {
            const Sample& s = sample(samples[i * samples.size() / used]);
            values[i] = {
                std::clamp(feature_value(feature, set_.frame(s.frame), s.x, s.y), -32767, 32767),
                s.label};
        }
        std::sort(values.begin(), values.end());
        return best_threshold(values);
    }

    [[nodiscard]] Split
    best_threshold(const std::vector<std::pair<int, std::uint32_t>>& values) const {
        Counts below{}, above{};
        for (const auto& value : values)
            ++above[value.second];
        const double before = purity(above);
        Split best;
        std::size_t at = 0;
        for (int t = 1; t <= options_.thresholds; ++t) {
            const int threshold = values[values.size() * static_cast<std::size_t>(t) /
                                         (static_cast<std::size_t>(options_.thresholds) + 1)]
                                      .first;
            for (; at < values.size() && values[at].first < threshold; ++at) {
                ++below[values[at].second];
                --above[values[at].second];
            }
            if (at == 0) continue;
            const double gain = purity(below) + purity(above) - before;
            if (gain > best.gain * (1.0 + 1e-12)) best = {gain, threshold};
        }
        return best;
    }

    void grow(const Level& level) {
        for (std::size_t begin = 0; begin < level.nodes.size(); begin += kBatch)
            grow_batch(level, begin, std::min<std::size_t>(begin + kBatch, level.nodes.size()));
    }

    void grow_batch(const Level& level, std::size_t begin, std::size_t end) {
        const auto candidates = static_cast<std::uint32_t>(options_.candidates);
        std::vector<Split> splits((end - begin) * candidates);
        rows_(static_cast<std::uint32_t>(splits.size()), 16,
              [&](std::uint32_t from, std::uint32_t to) {
                  for (std::uint32_t i = from; i < to; ++i) {
                      const std::size_t n = begin + i / candidates;
                      if (!may_split(level.samples(n))) continue;
                      const auto candidate = static_cast<int>(i % candidates);
                      splits[i] = try_feature(draw(level.nodes[n], candidate), level.samples(n));
                  }
              });
        for (std::size_t n = begin; n < end; ++n) {
            const auto mine = std::span(splits).subspan((n - begin) * candidates, candidates);
            const auto best =
                std::max_element(mine.begin(), mine.end(),
                                 [](const Split& a, const Split& b) { return a.gain < b.gain; });
            finish(level.nodes[n], level.samples(n), *best, static_cast<int>(best - mine.begin()));
        }
    }

    [[nodiscard]] bool may_split(std::span<const std::uint32_t> samples) const {
        return level_ < options_.depth && samples.size() >= options_.min_samples;
    }

    /// A question or a leaf. A node without gain ends here: gain needs samples on both sides.
    void finish(std::uint32_t node, std::span<const std::uint32_t> samples, const Split& split,
                int candidate) {
        if (split.gain <= 0.0) {
            const auto classes = static_cast<std::size_t>(options_.class_count);
            tree().nodes[node].child = ~static_cast<std::int32_t>(tree().leaves.size() / classes);
            const Counts counts = count(samples);
            for (std::size_t c = 0; c < classes; ++c)
                tree().leaves.push_back(static_cast<std::uint8_t>(
                    (std::uint64_t{counts[c]} * 510 + samples.size()) / (2 * samples.size())));
            return;
        }
        ForestNode& grown = tree().nodes[node];
        grown.feature = draw(node, candidate);
        grown.threshold = static_cast<std::int16_t>(split.threshold);
        grown.child = static_cast<std::int32_t>(tree().nodes.size());
        tree().nodes.resize(tree().nodes.size() + 2);
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
    std::uint64_t fingerprint_ = 0;
    Forest forest_; ///< the last tree is growing
    int level_ = 0;
};

} // namespace

void TrainingSet::add(const DepthView& frame, std::span<const Sample> samples) {
    const auto refuse = [&](const std::string& what) {
        throw Error("training frame " + std::to_string(frames_.size()) + ": " + what);
    };
    if (frame.width < 1 || frame.height < 1 || frame.width > 65535 || frame.height > 65535 ||
        frame.mm == nullptr || !(frame.focal_px > 0.0f && frame.focal_px < 32768.0f))
        refuse("needs a size of 1 to 65535, depths and a focal length of up to 32768 pixels");
    for (const Sample& s : samples) {
        const auto place = " at (" + std::to_string(s.x) + ", " + std::to_string(s.y) + ")";
        if (s.x >= frame.width || s.y >= frame.height)
            refuse("the sample" + place + " is out of it");
        if (frame.mm[s.y * frame.width + s.x] == 0)
            refuse("the sample" + place + " is not of the person");
    }
    const auto index = static_cast<std::uint32_t>(frames_.size());
    frames_.push_back({frame.width, frame.height, frame.focal_px, depths_.size()});
    depths_.insert(depths_.end(), frame.mm,
                   frame.mm + static_cast<std::size_t>(frame.width) * frame.height);
    for (Sample s : samples) {
        s.frame = index;
        samples_.push_back(s);
    }
}

DepthView TrainingSet::frame(std::uint32_t index) const {
    const Frame& f = frames_[index];
    return {f.width, f.height, f.focal_px, depths_.data() + f.first};
}

std::optional<Forest> train_forest(const TrainingSet& set, const TrainerOptions& options,
                                   const RowLoop& rows, const TrainerProgress& progress) {
    check(set, options);
    return Trainer(set, options, rows).run(progress);
}

} // namespace toile::body_tracker
