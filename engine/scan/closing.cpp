#include "scan/closing.h"

#include "core/error.h"
#include "geometry/level_surface.h"

#include <algorithm>
#include <limits>

namespace toile::scan {
namespace {

using geometry::NodeField;

constexpr int kCoarse = 2; // nodes along an edge of a cell that is looked through as one
constexpr float kThrough =
    0.02f; // a view sees through what is this much before its reading, metres

/// Whether views looked through a place.
class Emptiness {
  public:
    Emptiness(std::span<const DepthView* const> views, const ViewPlaces& places)
        : views_(views), places_(places) {}

    [[nodiscard]] bool empty(const Vec3f& place, std::vector<Warp>& space) const {
        std::size_t through = 0, beside = 0, looked = 0;
        const auto camera_from_scan = places_.at(place, space);
        for (std::size_t i = 0; i < views_.size(); ++i) {
            const DepthView& view = *views_[i];
            const Vec3f p = warped(camera_from_scan[i], place);
            float u = 0.0f, v = 0.0f;
            if (!view.camera.project(p, u, v) || !in_picture(view, u, v)) continue;
            ++looked;
            int x = 0, y = 0;
            if (!view.camera.pixel(p, x, y)) {
                ++beside;
                continue;
            }
            const std::size_t at = view.camera.at(x, y);
            const Beyond beyond = view.beyond[at];
            if (beyond == Beyond::nothing) ++beside;
            if (beyond == Beyond::subject && -p.z() < view.depth[at] - kThrough) ++through;
            if (beyond == Beyond::scene && -p.z() < view.behind[at] - kThrough) ++through;
        }
        // Seen through twice; or often in front of nothing, which a lost reading may be too.
        return through >= 2 || (looked > 0 && 4 * beside >= looked);
    }

  private:
    [[nodiscard]] static bool in_picture(const DepthView& view, float u, float v) {
        const auto& [left, above, right, below] = view.around;
        return u >= static_cast<float>(-left) && v >= static_cast<float>(-above) &&
               u < static_cast<float>(view.camera.width + right) &&
               v < static_cast<float>(view.camera.height + below);
    }
    std::span<const DepthView* const> views_;
    const ViewPlaces& places_;
};

/// The volume's voxels in a box around all blocks; NaN where unknown.
NodeField known_field(const Volume& volume) {
    constexpr int kMargin = 6;
    if (volume.blocks().empty()) throw Error("no surface was seen");
    Eigen::Vector3i low = volume.blocks().front(), high = low;
    for (const auto& place : volume.blocks()) {
        low = low.cwiseMin(place);
        high = high.cwiseMax(place);
    }
    low.array() -= kMargin;
    high.array() += Volume::kSide + kMargin;
    NodeField out;
    out.spacing = volume.options().voxel_m;
    out.origin = volume.origin() + out.spacing * low.cast<float>();
    for (int k = 0; k < 3; ++k)
        out.size[static_cast<std::size_t>(k)] = high[k] - low[k];
    out.values.assign(static_cast<std::size_t>(out.size[0] * out.size[1] * out.size[2]),
                      std::numeric_limits<float>::quiet_NaN());
    for (const auto& place : volume.blocks())
        for (int k = 0; k < Volume::kSide * Volume::kSide * Volume::kSide; ++k) {
            const Eigen::Vector3i at = place + Eigen::Vector3i(k & 7, (k >> 3) & 7, k >> 6);
            float distance = 0.0f, weight = 0.0f;
            if (!volume.voxel(at.x(), at.y(), at.z(), distance, weight)) continue;
            const Eigen::Vector3i node = at - low;
            out.values[static_cast<std::size_t>(out.index(node.x(), node.y(), node.z()))] =
                distance;
        }
    return out;
}

/// Fills unknown nodes, and remembers which those were.
class Guess {
  public:
    Guess(NodeField& field, const Emptiness& emptiness, const geometry::NearestSurface* likely,
          float far)
        : field_(field), emptiness_(emptiness), likely_(likely), far_(far),
          guessed_(field.values.size(), 0) {}

    std::vector<std::uint8_t> all(const RowLoop& rows) {
        const auto layers = static_cast<std::uint32_t>((field_.size[2] + kCoarse - 1) / kCoarse);
        rows(layers, 1, [&](std::uint32_t begin, std::uint32_t end) {
            std::vector<Warp> space;
            for (std::int64_t z = kCoarse * static_cast<std::int64_t>(begin);
                 z <
                 std::min<std::int64_t>(kCoarse * static_cast<std::int64_t>(end), field_.size[2]);
                 z += kCoarse)
                for (std::int64_t y = 0; y < field_.size[1]; y += kCoarse)
                    for (std::int64_t x = 0; x < field_.size[0]; x += kCoarse)
                        cell(x, y, z, space);
        });
        return std::move(guessed_);
    }

  private:
    /// Nodes that are looked through as one.
    void cell(std::int64_t x, std::int64_t y, std::int64_t z, std::vector<Warp>& space) {
        const Vec3f middle = field_.position(field_.index(x, y, z)) +
                             Vec3f::Constant(0.5f * field_.spacing * (kCoarse - 1));
        float value = 0.0f;
        bool told = false;
        for (int k = 0; k < kCoarse * kCoarse * kCoarse; ++k) {
            const std::int64_t u = x + k % kCoarse, v = y + k / kCoarse % kCoarse,
                               w = z + k / (kCoarse * kCoarse);
            if (u >= field_.size[0] || v >= field_.size[1] || w >= field_.size[2]) continue;
            const auto i = static_cast<std::size_t>(field_.index(u, v, w));
            if (!std::isnan(field_.values[i])) continue;
            if (!told) value = of(middle, space);
            told = true;
            // Near the likely surface each node for itself.
            const bool near = likely_ != nullptr && std::abs(value) < far_;
            field_.values[i] = near ? likely(field_.position(static_cast<std::int64_t>(i))) : value;
            guessed_[i] = 1;
        }
    }
    [[nodiscard]] float of(const Vec3f& place, std::vector<Warp>& space) const {
        if (emptiness_.empty(place, space)) return far_;
        return likely_ != nullptr ? likely(place) : -far_;
    }
    [[nodiscard]] float likely(const Vec3f& place) const {
        const auto near = likely_->nearest(place);
        return std::clamp(near.signed_distance, -far_, far_);
    }

    NodeField& field_;
    const Emptiness& emptiness_;
    const geometry::NearestSurface* likely_;
    float far_;
    std::vector<std::uint8_t> guessed_;
};

/// The outermost nodes are outside, so that every surface is closed.
void close_box(NodeField& field, float far) {
    for (std::int64_t z = 0; z < field.size[2]; ++z)
        for (std::int64_t y = 0; y < field.size[1]; ++y)
            for (std::int64_t x = 0; x < field.size[0]; ++x)
                if (x < 1 || y < 1 || z < 1 || x + 1 >= field.size[0] || y + 1 >= field.size[1] ||
                    z + 1 >= field.size[2])
                    field.values[static_cast<std::size_t>(field.index(x, y, z))] = far;
}

/// Guessed nodes near a change of sign, rounds of averaging among them.
void diffuse(NodeField& field, const std::vector<std::uint8_t>& guessed, const RowLoop& rows) {
    constexpr int kRounds = 6;
    constexpr std::int64_t kReach = 4;
    const std::array<std::int64_t, 3> step{1, field.size[0], field.size[0] * field.size[1]};
    std::vector<std::int64_t> band;
    for (std::int64_t z = kReach; z + kReach < field.size[2]; ++z)
        for (std::int64_t y = kReach; y + kReach < field.size[1]; ++y)
            for (std::int64_t x = kReach; x + kReach < field.size[0]; ++x) {
                const std::int64_t i = field.index(x, y, z);
                if (guessed[static_cast<std::size_t>(i)] == 0) continue;
                const bool inside = field.values[static_cast<std::size_t>(i)] < 0.0f;
                bool near = false;
                for (const std::int64_t s : step)
                    for (std::int64_t k = 1; k <= kReach && !near; ++k)
                        near =
                            (field.values[static_cast<std::size_t>(i - k * s)] < 0.0f) != inside ||
                            (field.values[static_cast<std::size_t>(i + k * s)] < 0.0f) != inside;
                if (near) band.push_back(i);
            }
    std::vector<float> next(band.size());
    for (int round = 0; round < kRounds; ++round) {
        rows(static_cast<std::uint32_t>(band.size()), 4096,
             [&](std::uint32_t begin, std::uint32_t end) {
                 for (std::uint32_t k = begin; k < end; ++k) {
                     float sum = 0.0f;
                     for (const std::int64_t s : step)
                         sum += field.values[static_cast<std::size_t>(band[k] - s)] +
                                field.values[static_cast<std::size_t>(band[k] + s)];
                     next[k] = sum / 6.0f;
                 }
             });
        for (std::size_t k = 0; k < band.size(); ++k)
            field.values[static_cast<std::size_t>(band[k])] = next[k];
    }
}

/// What is guessed next to the floor, where readings are the floor's, goes on straight down from
/// above; beneath the floor nothing is.
void stand_on(NodeField& field, const std::vector<std::uint8_t>& guessed,
              const geometry::Plane& floor) {
    constexpr float kClear_m = 0.03f; // above that the subject is told from the floor
    const std::vector<float> from = field.values;
    const auto node_at = [&](const Vec3f& place) {
        std::int64_t out[3];
        for (int k = 0; k < 3; ++k)
            out[k] =
                std::clamp<std::int64_t>(std::lround((place[k] - field.origin[k]) / field.spacing),
                                         0, field.size[static_cast<std::size_t>(k)] - 1);
        return static_cast<std::size_t>(field.index(out[0], out[1], out[2]));
    };
    for (std::size_t i = 0; i < field.values.size(); ++i) {
        const float height =
            floor.normal.dot(field.position(static_cast<std::int64_t>(i))) - floor.offset;
        if (guessed[i] != 0 && height < kClear_m && height > -kClear_m)
            field.values[i] = from[node_at(field.position(static_cast<std::int64_t>(i)) +
                                           (kClear_m - height) * floor.normal)];
        field.values[i] = std::max(field.values[i], -height);
    }
}

} // namespace

RigidPlaces::RigidPlaces(std::span<const Pose> scan_from_camera) {
    for (const Pose& pose : scan_from_camera)
        camera_from_scan_.emplace_back(pose.inverse().matrix().topRows<3>().cast<float>());
}

ClosedSurface closed_surface(const Volume& volume, std::span<const DepthView* const> views,
                             const ViewPlaces& places, const std::optional<geometry::Plane>& floor,
                             const geometry::NearestSurface* likely, const RowLoop& rows) {
    NodeField field = known_field(volume);
    const float far = volume.options().truncation_m;
    const Emptiness emptiness(views, places);
    const auto guessed = Guess(field, emptiness, likely, far).all(rows);
    close_box(field, far);
    diffuse(field, guessed, rows);
    if (floor) stand_on(field, guessed, *floor);
    ClosedSurface out;
    auto pieces = geometry::connected_pieces(geometry::level_surface(field));
    if (pieces.empty()) throw Error("no closed surface came out of what was seen");
    const auto largest =
        std::max_element(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) {
            return geometry::volume(a) < geometry::volume(b);
        });
    out.dropped_pieces = pieces.size() - 1;
    out.mesh = std::move(*largest);
    std::size_t unseen = 0;
    for (const Vec3f& p : out.mesh.positions) {
        float distance = 0.0f;
        if (!volume.sample(p, distance)) ++unseen;
    }
    out.guessed_share =
        static_cast<double>(unseen) / static_cast<double>(out.mesh.positions.size());
    out.mesh.normals.resize(out.mesh.positions.size());
    geometry::vertex_normals(out.mesh.positions, out.mesh.triangles, out.mesh.normals);
    return out;
}

void move(const Eigen::Isometry3d& by, geometry::TriangleMesh& mesh) {
    const Eigen::Isometry3f motion = by.cast<float>();
    for (Vec3f& p : mesh.positions)
        p = motion * p;
    for (Vec3f& n : mesh.normals)
        n = motion.linear() * n;
}

void smooth(geometry::TriangleMesh& mesh) {
    const auto around = geometry::vertex_adjacency(mesh.positions.size(), mesh.triangles);
    for (const float share : {0.6f, -0.63f}) {
        std::vector<Vec3f> next = mesh.positions;
        for (std::uint32_t v = 0; v < next.size(); ++v) {
            Vec3f mean = Vec3f::Zero();
            for (std::uint32_t k = around.first[v]; k < around.first[v + 1]; ++k)
                mean += mesh.positions[around.neighbours[k]];
            const std::uint32_t count = around.first[v + 1] - around.first[v];
            if (count > 0)
                next[v] += share * (mean / static_cast<float>(count) - mesh.positions[v]);
        }
        mesh.positions = std::move(next);
    }
    geometry::vertex_normals(mesh.positions, mesh.triangles, mesh.normals);
}

namespace {

/// Sum of colours of one vertex over the views; w: weight.
Vec4f seen_color(const Vec3f& place, const Vec3f& normal, std::span<const DepthView* const> views,
                 std::span<const Warp> camera_from_scan) {
    constexpr float kSame_m = 0.015f;
    Vec4f sum = Vec4f::Zero();
    for (std::size_t i = 0; i < views.size(); ++i) {
        const DepthView& view = *views[i];
        if (view.colors.empty()) continue;
        const Vec3f p = warped(camera_from_scan[i], place);
        int x = 0, y = 0;
        if (!view.camera.pixel(p, x, y)) continue;
        const std::size_t at = view.camera.at(x, y);
        if (view.depth[at] == 0.0f || std::abs(view.depth[at] + p.z()) > kSame_m) continue;
        const float cosine = (camera_from_scan[i].leftCols<3>() * normal).dot(-p.normalized());
        if (cosine < 0.2f) continue;
        const float weight = cosine * cosine * cosine * cosine;
        const Rgba8& color = view.colors[at];
        sum += weight * Vec4f(color[0], color[1], color[2], 1.0f);
    }
    return sum;
}

/// What has no weight takes the mean of its neighbours, ring by ring.
void spread(std::vector<Vec4f>& colors, const geometry::TriangleMesh& mesh) {
    const auto around = geometry::vertex_adjacency(mesh.positions.size(), mesh.triangles);
    std::vector<std::uint32_t> open;
    for (std::uint32_t v = 0; v < colors.size(); ++v)
        if (colors[v].w() <= 0.0f) open.push_back(v);
    for (int round = 0; round < 400 && !open.empty(); ++round) {
        std::vector<std::pair<std::uint32_t, Vec4f>> found;
        std::vector<std::uint32_t> rest;
        for (const std::uint32_t v : open) {
            Vec4f sum = Vec4f::Zero();
            for (std::uint32_t k = around.first[v]; k < around.first[v + 1]; ++k)
                sum += colors[around.neighbours[k]];
            if (sum.w() > 0.0f)
                found.emplace_back(v, sum / sum.w());
            else
                rest.push_back(v);
        }
        if (found.empty()) break;
        for (const auto& [v, color] : found)
            colors[v] = color;
        open = std::move(rest);
    }
}

} // namespace

std::vector<Rgba8> vertex_colors(const geometry::TriangleMesh& mesh,
                                 std::span<const DepthView* const> views, const ViewPlaces& places,
                                 const RowLoop& rows) {
    if (std::all_of(views.begin(), views.end(), [](const auto* v) { return v->colors.empty(); }))
        return {};
    std::vector<Vec4f> sums(mesh.positions.size(), Vec4f::Zero());
    rows(static_cast<std::uint32_t>(sums.size()), 2048,
         [&](std::uint32_t begin, std::uint32_t end) {
             std::vector<Warp> space;
             for (std::uint32_t v = begin; v < end; ++v) {
                 sums[v] = seen_color(mesh.positions[v], mesh.normals[v], views,
                                      places.at(mesh.positions[v], space));
                 if (sums[v].w() > 0.0f) sums[v] /= sums[v].w();
             }
         });
    spread(sums, mesh);
    std::vector<Rgba8> out(sums.size());
    for (std::size_t v = 0; v < out.size(); ++v)
        for (int k = 0; k < 4; ++k)
            out[v][static_cast<std::size_t>(k)] =
                k == 3 ? 255
                       : static_cast<std::uint8_t>(std::clamp(sums[v][k] + 0.5f, 0.0f, 255.0f));
    return out;
}

} // namespace toile::scan
