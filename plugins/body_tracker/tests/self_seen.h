// A body that is drawn into a grid as if a camera had seen it.
#pragma once

#include "drawn_room.h"

namespace toile::body_tracker {

inline GridCamera grid_camera() {
    return {160, 120, 145.0f, 145.0f, 79.5f, 59.5f};
}

inline body::Pose standing() {
    body::Pose pose = waving(5);
    pose.hips_position = Vec3f(0.1f, -0.2f, -2.6f);
    return pose;
}

/// The same body drawn into a grid, as if it had been seen.
struct SelfSeen {
    TrackedBody body{adult()};
    DepthGrid grid{grid_camera(), std::vector<float>(grid_camera().size(), 0.0f)};
    PersonMask mask{grid_camera()};

    explicit SelfSeen(const body::Pose& pose, const Wear& wear = {}) {
        body.set_shape(body.shape(), wear);
        PosedBody posed = body.blank();
        Drawing drawing = body.blank_drawing(grid.camera);
        body.pose(pose, posed);
        body.draw(posed, grid.camera, drawing);
        for (std::size_t i = 0; i < grid.depth.size(); ++i) {
            grid.depth[i] = drawing.cells[i].depth == 0.0f ? 4.5f : drawing.cells[i].depth;
            mask.cells[i] = drawing.cells[i].depth != 0.0f ? 1 : 0;
        }
        find_nearest(grid.camera, mask);
    }
    [[nodiscard]] SeenPerson seen() const { return {grid, mask, std::nullopt}; }
};

} // namespace toile::body_tracker
