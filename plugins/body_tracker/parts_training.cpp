#include "body_tracker/parts_training.h"

#include "body_tracker/joint_proposals.h"
#include "core/error.h"

#include <cmath>

namespace toile::body_tracker {
namespace {

constexpr int kFramesAtOnce = 256;
constexpr float kMistake_m = 0.3f;
constexpr double kFramesShare = 0.1; // of the progress

std::vector<TrainingSet::Sample> take_samples(const PartsFrame& frame, int pixels) {
    std::vector<TrainingSet::Sample> all;
    for (int y = 0; y < frame.height; ++y)
        for (int x = 0; x < frame.width; ++x) {
            const auto label = frame.labels[static_cast<std::size_t>(y * frame.width + x)];
            if (label != PartLabel::invalid)
                all.push_back({0, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                               static_cast<std::uint32_t>(label) - 1});
        }
    const auto wanted = static_cast<std::size_t>(pixels);
    if (all.size() <= wanted) return all;
    std::vector<TrainingSet::Sample> out;
    for (std::size_t k = 0; k < wanted; ++k)
        out.push_back(all[(2 * k + 1) * all.size() / (2 * wanted)]);
    return out;
}

DepthView view_of(const PartsFrame& frame) {
    return {frame.width, frame.height, frame.focal_px, frame.mm.data()};
}

void add_frames(const FrameMaker& maker, std::uint32_t first, int count, int pixels,
                const RowLoop& rows, TrainingSet& set) {
    std::vector<PartsFrame> frames(static_cast<std::size_t>(count));
    rows(static_cast<std::uint32_t>(count), 4, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t f = begin; f < end; ++f)
            frames[f] = maker.make(first + f);
    });
    for (const PartsFrame& frame : frames)
        set.add(view_of(frame), take_samples(frame, pixels));
}

void check(const PartsTrainingOptions& options) {
    if (options.frames < 1) throw Error("training of the forest: frames must be 1 or more");
    if (options.pixels < 1) throw Error("training of the forest: pixels must be 1 or more");
}

} // namespace

TrainingSet sample_frames(const FrameMaker& maker, std::uint32_t first, int count, int pixels,
                          const RowLoop& rows) {
    TrainingSet set;
    for (int begin = 0; begin < count; begin += kFramesAtOnce)
        add_frames(maker, first + static_cast<std::uint32_t>(begin),
                   std::min(kFramesAtOnce, count - begin), pixels, rows, set);
    return set;
}

std::array<float, kPartCount> learn_push_back(const Forest& forest, const FrameMaker& maker,
                                              std::uint32_t first, int count) {
    std::array<double, kPartCount> sums{}, counts{};
    const auto proposer = std::make_unique<JointProposer>(ProposalOptions{});
    for (int f = 0; f < count; ++f) {
        const PartsFrame frame = maker.make(first + static_cast<std::uint32_t>(f));
        std::vector<std::uint8_t> labels(frame.mm.size()), shares(frame.mm.size());
        const LabelPicture picture{1, labels, shares};
        label_pixels(forest, view_of(frame), picture, 0, frame.height);
        const ImageCentre centre{0.5f * static_cast<float>(frame.width - 1),
                                 0.5f * static_cast<float>(frame.height - 1)};
        const auto& proposals = proposer->propose(view_of(frame), centre, picture);
        for (std::size_t p = 0; p < kPartCount; ++p) {
            const Vec3f& mode = proposals[p].front().position;
            const auto part = static_cast<PartLabel>(p + 1);
            const Vec3f away = frame.joints[static_cast<std::size_t>(part_joint(part))] - mode;
            if (proposals[p].front().area_m2 <= 0.0f || away.norm() > kMistake_m) continue;
            sums[p] += static_cast<double>(away.dot(mode.normalized()));
            counts[p] += 1.0;
        }
    }
    std::array<float, kPartCount> out{};
    for (std::size_t p = 0; p < kPartCount; ++p)
        out[p] = counts[p] > 0.0 ? static_cast<float>(sums[p] / counts[p]) : 0.0f;
    return out;
}

std::optional<Forest> train_parts(const body::BodySpace& space, std::vector<body::Pose> recorded,
                                  const PartsTrainingOptions& options, const RowLoop& rows,
                                  const TrainerProgress& progress) {
    check(options);
    const FrameMaker maker(space, options.people, options.trainer.seed, options.range,
                           std::move(recorded));
    TrainingSet set;
    for (int begin = 0; begin < options.frames; begin += kFramesAtOnce) {
        const double done = kFramesShare * begin / options.frames;
        if (!progress(done,
                      "frame " + std::to_string(begin) + " of " + std::to_string(options.frames)))
            return std::nullopt;
        add_frames(maker, static_cast<std::uint32_t>(begin),
                   std::min(kFramesAtOnce, options.frames - begin), options.pixels, rows, set);
    }
    TrainerOptions trainer = options.trainer;
    trainer.class_count = kPartCount;
    auto forest = train_forest(set, trainer, rows, [&](double done, const std::string& text) {
        return progress(kFramesShare + (1.0 - kFramesShare) * done, text);
    });
    if (!forest) return std::nullopt;
    const auto push_back = learn_push_back(
        *forest, maker, static_cast<std::uint32_t>(options.frames), options.push_back_frames);
    forest->push_back_mm.clear(); // a checkpoint's are zeros
    for (const float metres : push_back)
        forest->push_back_mm.push_back(static_cast<std::int16_t>(std::lround(1000.0f * metres)));
    return forest;
}

} // namespace toile::body_tracker
