// One garment on one person: bound by the garment plugin, with the buffers that the cloth fills.
#pragma once

#include "body/skinning.h"
#include "garment/embedding.h"
#include "host/instance.h"
#include "pipeline/boundary_views.h"
#include "pipeline/frame_guard.h"

#include <memory>
#include <string>

namespace toile::pipeline {

/// Not movable.
class WornGarment {
  public:
    /// Binds the garment to the body. \throw Error [worker]
    WornGarment(std::shared_ptr<const host::Plugin> plugin, host::Services& services,
                const BoundaryBody& body, std::shared_ptr<const BoundaryGarment> garment,
                const toile_limits& limits, host::Job& job);
    WornGarment(const WornGarment&) = delete;
    WornGarment& operator=(const WornGarment&) = delete;

    /// What the cloth world is to be told: rest, weights, attachment. Views into this.
    [[nodiscard]] toile_cloth_garment cloth_description() const;

    /// Fills `targets` for a posed body; where the plugin fails, plain skinning of the binding
    /// steps in. [frame]
    void update_targets(const toile_body_state& state,
                        const body::JointTransforms& skinning) noexcept;

    /// Starts `shown` from the cloth as it is now; layers may then push it. [frame]
    void begin_showing() noexcept;
    /// Render meshes for `shown`. [frame]
    void update_surfaces() noexcept;

    /// A quantity of the simulation vertices (nv) at the vertices (nr) of a surface. [frame]
    void on_surface(std::size_t surface, std::span<const float> values,
                    std::span<float> out) const noexcept {
        embedding_.spread(surface, values, out);
    }
    /// Triangles of a surface that may be seen: those that hang on `hidden` cloth are left out.
    [[nodiscard]] std::vector<Triangle> drawn_triangles(std::size_t surface) const {
        return embedding_.uncovered(surface, surfaces[surface].primitive->triangles, hidden);
    }
    /// Some of its materials or their textures let light through.
    [[nodiscard]] bool see_through() const;

    [[nodiscard]] const BoundaryGarment& garment() const noexcept { return *garment_; }
    [[nodiscard]] const std::vector<Triangle>& triangles() const {
        return garment_->size().simulation.triangles;
    }
    [[nodiscard]] std::string fault() { return guard_.fault(); }

    std::uint32_t handle = 0;     ///< of the cloth world
    std::vector<Vec3f> bound;     ///< (nv) on the body in its rest pose
    std::vector<Vec3f> targets;   ///< (nv) where plain skinning would have it
    std::vector<Vec3f> positions; ///< (nv) the cloth
    std::vector<Vec3f> normals;   ///< (nv)
    std::vector<Vec3f> shown;     ///< (nv) the cloth as drawn, clear of the layers below
    /// (nf) 1: never seen beneath the garments over it; or empty. Only drawing leaves it out.
    std::vector<std::uint8_t> hidden;

    /// One drawable of the package, positions as worn; material as in its scene.
    struct Surface {
        const assets::Primitive* primitive = nullptr;
        std::vector<Vec3f> positions; ///< (nr)
        std::vector<Vec3f> normals;   ///< (nr)
    };
    std::vector<Surface> surfaces;

  private:
    void bind(const BoundaryBody& body, host::Job& job);

    std::shared_ptr<const BoundaryGarment> garment_;
    host::Instance instance_;
    const toile_garment& table_;
    std::vector<Vec3f> shown_normals_;
    FrameGuard guard_;
    body::SkinWeights weights_;
    std::vector<float> attachment_;
    std::unique_ptr<body::SkinnedSurface> fallback_;
    garment::SurfaceEmbedding embedding_;
    garment::SurfaceEmbedding::Scratch scratch_;
};

} // namespace toile::pipeline
