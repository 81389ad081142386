// From a body space to a forest of body parts: frames, samples, training, push-back.
#pragma once

#include "body_tracker/forest_trainer.h"
#include "body_tracker/parts_frames.h"

namespace toile::body_tracker {

struct PartsTrainingOptions {
    int frames = 20000;
    int people = 600;           ///< different bodies in them
    int pixels = 200;           ///< samples of a frame, evenly taken
    int push_back_frames = 600; ///< behind the others; the trained forest labels them
    FrameRange range;
    /// Its class_count is set here; its seed is that of the frames too.
    TrainerOptions trainer;
};

/// Parts as classes: PartLabel - 1. Frames `first` to `first` + `count` - 1 of the maker.
[[nodiscard]] TrainingSet sample_frames(const FrameMaker& maker, std::uint32_t first, int count,
                                        int pixels, const RowLoop& rows);

/// Per part the mean distance along the ray from the first mode on the surface to the joint,
/// metres; modes farther than 30 cm from their joint are mistakes and left out.
[[nodiscard]] std::array<float, kPartCount>
learn_push_back(const Forest& forest, const FrameMaker& maker, std::uint32_t first, int count);

/// The whole of it; the same bytes whatever `rows`. Nothing when `progress` says stop; a checkpoint
/// keeps what is done. \throw Error as FrameMaker and train_forest
[[nodiscard]] std::optional<Forest> train_parts(const body::BodySpace& space,
                                                std::vector<body::Pose> recorded,
                                                const PartsTrainingOptions& options,
                                                const RowLoop& rows,
                                                const TrainerProgress& progress);

} // namespace toile::body_tracker
