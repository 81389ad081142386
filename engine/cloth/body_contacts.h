// Contact of one garment with the moving body: which triangle each sample of the garment lies
// over, the plane that stands for it between two refreshes, and the push with friction.
#pragma once

#include "cloth/body_places.h"
#include "cloth/lanes.h"

namespace toile::cloth {

struct ContactSettings {
    float offset = 0.004f;        ///< m, vertices are kept this far out
    float centre_offset = 0.002f; ///< m, and triangle centres
    float friction = 0.4f;        ///< Coulomb, kinetic
    float static_share = 1.2f;    ///< static friction over kinetic
    float reach = 0.05f;          ///< m, other parts are noticed from here
};

/// One refresh of the contacts among those of a step.
struct Refresh {
    float ahead;         ///< s, from the positions given to the moment of the body
    float since_last;    ///< s, from the body of the last refresh to this one
    float until_next;    ///< s, how long the planes must serve
    float period;        ///< s, until a sample's next turn
    std::uint32_t phase; ///< whose turn it is: samples with index % phases == phase
    std::uint32_t phases;
    bool last; ///< end of the frame: every sample near the skin, nobody looks around
    /// 0: on its turn every sample walks and every vertex looks around. Else who has not slid keeps
    /// its place on the skin, and looks around on every fourth of its turns only; counts frames.
    std::uint32_t lazy_frame = 0;
};

/// Positions x, those at the start of the substep q (their difference is the motion), and inverse
/// masses w of a garment's vertices; (nv) each.
struct Particles {
    std::span<Vec4> x, q;
    std::span<const float> w;
};

/// Samples are the vertices, then the triangle centres. Each sample follows its *own* place on
/// the body, found by walking from where it was, over the parts that its joints say it covers: it
/// is kept outside of these however deep it got. Besides it may have one *other* place, a part
/// that came near (a hand over the skirt, the second thigh), first met from outside. Where
/// the body runs into itself and no room is left between both, the own place wins.
/// Cloth of short edges hardly sags between its vertices and may do without the centres.
class BodyContacts {
  public:
    /// \throw Error when joint rows do not match or no part of the body fits a vertex
    BodyContacts(std::span<const Triangle> triangles, std::size_t vertex_count,
                 std::span<const std::array<std::uint16_t, 4>> joints,
                 std::span<const std::array<float, 4>> weights, bool centres = true);

    /// Finds each sample's place on the body at rest; `start` (nv) as bound to it.
    /// \throw Error when the body has no part that a vertex could lie on
    void bind(const MovingBody& rest_body, std::span<const Vec3f> start);
    /// Forgets where the samples were; they lie as they were bound.
    void reset() noexcept;

    /// Walks samples to their places on the body as placed now: when it is their turn, which is
    /// when vertices look around for other parts too, and in between those near the skin that have
    /// slid over it. Then lists whom the planes may touch before the next refresh.
    void refresh(const MovingBody& body, std::span<const Vec4> x, std::span<const Vec4> v,
                 const Refresh& when, const ContactSettings& settings) noexcept;

    /// Pushes everything out, `since` seconds after (or before) the last refresh's body, with
    /// friction over a substep of `substep` seconds; `centres`: those of triangles too.
    void resolve(const Particles& particles, float since, float substep,
                 const ContactSettings& settings, bool centres = true) const noexcept;

    [[nodiscard]] std::size_t sample_count() const noexcept { return own_triangle_.size(); }
    [[nodiscard]] bool has_centres() const noexcept { return sample_count() > vertex_count_; }
    /// Body triangle under a sample; vertices first, then centres if it has them.
    [[nodiscard]] std::uint32_t own_triangle(std::size_t sample) const noexcept {
        return own_triangle_[sample];
    }
    /// Does it lie between two parts that leave no room for it?
    [[nodiscard]] bool is_squeezed(std::size_t sample) const noexcept {
        return squeezed_[sample] != 0;
    }
    [[nodiscard]] std::span<const Triangle> triangles() const noexcept { return triangles_; }

  private:
    using Plane = SkinPlane;
    static const Plane kNowhere; ///< never touched
    struct ActivePlane {
        std::uint32_t sample;
        Plane plane;
    };
    /// Eight planes under eight vertices; the last lanes may repeat one.
    struct alignas(32) PlaneBlock {
        std::uint32_t vertex[kLanes];
        float normal[4][kLanes], velocity[4][kLanes];
    };

    [[nodiscard]] Vec4 ahead(const MovingBody& body, const Vec4& p, const Vec4& v,
                             std::size_t sample, float seconds) const noexcept;
    void refresh_vertex(const MovingBody& body, const Vec4& p, const Vec4& v, std::uint32_t vertex,
                        const Refresh& when, const ContactSettings& settings) noexcept;
    void refresh_centre(const MovingBody& body, const Vec4& p, const Vec4& v, std::size_t triangle,
                        const Refresh& when, const ContactSettings& settings) noexcept;
    void look_around(const MovingBody& body, const Vec4& p, std::size_t sample,
                     const ContactSettings& settings, float period, SurfacePoint& own) noexcept;
    void place_sample(const MovingBody& body, const Vec4& p, std::size_t sample,
                      const SurfacePoint& nearest, const ContactSettings& settings,
                      float period) noexcept;
    void list_vertex(const Vec4& p, const Vec4& v, std::uint32_t vertex, float until_next) noexcept;
    void list_centre(const Vec4& p, const Vec4& v, std::size_t sample, float until_next) noexcept;
    void list_own(std::uint32_t vertex, const Plane& plane) noexcept;
    [[nodiscard]] static Plane plane_at(const MovingBody& body, const Vec4& p,
                                        const SurfacePoint& at) noexcept;
    [[nodiscard]] bool has_drifted(const MovingBody& body, const Vec4& p, const Vec4& v,
                                   std::size_t sample, const Refresh& when) noexcept;
    /// Its place on the skin moves with the skin.
    void carry(const MovingBody& body, const Vec4& p, std::size_t sample) noexcept;
    [[nodiscard]] JointMask mask_for(std::size_t sample, const MovingBody& body,
                                     std::uint32_t triangle) const noexcept;
    void push_vertex(const Particles& particles, std::uint32_t vertex, const Plane& plane,
                     float since, float substep, const ContactSettings& settings) const noexcept;
    static void push_block(const Particles& particles, const PlaneBlock& block, float since,
                           float substep, const ContactSettings& settings) noexcept;
    void push_centre(const Particles& particles, const Triangle& corner, const Plane& plane,
                     float since, float substep, const ContactSettings& settings) const noexcept;

    std::vector<Triangle> triangles_;
    std::size_t vertex_count_;
    std::vector<JointMask> mask_;                 ///< (samples) parts that it covers
    std::vector<std::uint32_t> anchor_;           ///< (samples) triangle under it as bound
    std::vector<std::uint32_t> own_triangle_;     ///< (samples)
    std::vector<std::uint32_t> other_triangle_;   ///< (samples) or kNone
    std::vector<Plane> own_plane_, other_plane_;  ///< (samples)
    std::vector<std::array<float, 3>> own_place_; ///< (samples) barycentric
    std::vector<float> drift_; ///< (samples) m, at most slid over the skin since its last walk
    std::vector<std::uint8_t> squeezed_; ///< (samples) 1: no room between both places
    /// Planes within reach until the next refresh; capacity (samples).
    std::vector<PlaneBlock> own_vertices_;
    std::size_t own_count_ = 0; ///< vertices in these blocks
    std::vector<ActivePlane> other_vertices_, own_centres_, other_centres_;
};

} // namespace toile::cloth
