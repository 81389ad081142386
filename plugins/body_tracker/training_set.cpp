#include "body_tracker/training_set.h"

#include "core/error.h"

#include <algorithm>
#include <string>

namespace toile::body_tracker {
namespace {

/// Smallest rectangle with all readings; one pixel where there is none.
struct Box {
    int left, top, right, bottom; ///< the last two inclusive
};

Box find_box(const DepthView& frame) {
    Box box{frame.width, frame.height, -1, -1};
    for (int y = 0; y < frame.height; ++y)
        for (int x = 0; x < frame.width; ++x) {
            if (frame.mm[y * frame.width + x] == 0) continue;
            box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x),
                   std::max(box.bottom, y)};
        }
    return box.right < 0 ? Box{0, 0, 0, 0} : box;
}

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
    const Box box = find_box(frame);
    const auto index = static_cast<std::uint32_t>(frames_.size());
    frames_.push_back(
        {box.right - box.left + 1, box.bottom - box.top + 1, frame.focal_px, depths_.size()});
    for (int y = box.top; y <= box.bottom; ++y) {
        const std::uint16_t* row = frame.mm + static_cast<std::ptrdiff_t>(y) * frame.width;
        depths_.insert(depths_.end(), row + box.left, row + box.right + 1);
    }
    for (Sample s : samples) {
        s.frame = index;
        s.x = static_cast<std::uint16_t>(s.x - box.left);
        s.y = static_cast<std::uint16_t>(s.y - box.top);
        samples_.push_back(s);
    }
}

DepthView TrainingSet::frame(std::uint32_t index) const {
    const Frame& f = frames_[index];
    return {f.width, f.height, f.focal_px, depths_.data() + f.first};
}

} // namespace toile::body_tracker
