#include "host/mesh_sink.h"

#include "core/error.h"
#include "host/faults.h"
#include "host/views.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>

namespace toile::host {
namespace {

constexpr float kUntouched = std::numeric_limits<float>::quiet_NaN();

template <std::size_t n>
std::span<const float> scalars(const std::vector<std::array<float, n>>& rows) {
    return {rows.empty() ? nullptr : rows[0].data(), rows.size() * n};
}

// Drops an optional buffer that nobody wrote to; false when it was written and is not finite.
template <std::size_t n>
bool keep_if_written(std::vector<std::array<float, n>>& rows) {
    const auto values = scalars(rows);
    if (all_finite(values)) return true;
    const bool untouched =
        std::all_of(values.begin(), values.end(), [](float value) { return value != value; });
    if (untouched) rows.clear();
    return untouched;
}

} // namespace

MeshSink::MeshSink(std::uint32_t max_vertices, std::uint32_t max_triangles)
    : max_vertices_(max_vertices), max_triangles_(max_triangles) {
    sink_.size = sizeof(toile_mesh_sink);
    sink_.sink_data = this;
    sink_.begin = [](toile_mesh_sink* sink, std::uint32_t nv, std::uint32_t nf,
                     toile_mesh_buffers* out) {
        return static_cast<MeshSink*>(sink->sink_data)->begin(nv, nf, out);
    };
    sink_.commit = [](toile_mesh_sink* sink) {
        return static_cast<MeshSink*>(sink->sink_data)->commit();
    };
}

toile_status MeshSink::begin(std::uint32_t nv, std::uint32_t nf, toile_mesh_buffers* out) {
    if (begun_ || out == nullptr || out->size < 2 * sizeof(std::uint32_t)) return TOILE_E_ARGUMENT;
    if (nv > max_vertices_ || nf > max_triangles_) return TOILE_E_CAPACITY;
    try {
        mesh_.positions.assign(nv, {kUntouched, kUntouched, kUntouched});
        mesh_.normals = mesh_.positions;
        mesh_.colors.assign(nv, {0, 0, 0, 0});
        mesh_.triangles.assign(nf, {UINT32_MAX, UINT32_MAX, UINT32_MAX});
        mesh_.corner_coords.assign(std::size_t{nf} * 3, {kUntouched, kUntouched});
    } catch (const std::bad_alloc&) {
        return TOILE_E_CAPACITY;
    }
    begun_ = true;
    toile_mesh_buffers buffers{};
    buffers.positions = view_mut(mesh_.positions);
    buffers.normals = view_mut(mesh_.normals);
    buffers.colors = view_mut(mesh_.colors);
    buffers.triangles = view_mut(mesh_.triangles);
    buffers.corner_coords = view_mut(mesh_.corner_coords);
    buffers.size = out->size;
    std::memcpy(out, &buffers, std::min<std::size_t>(out->size, sizeof(buffers)));
    return TOILE_OK;
}

toile_status MeshSink::commit() {
    if (!begun_ || committed_) return TOILE_E_ARGUMENT;
    committed_ = true;
    const std::size_t nv = mesh_.positions.size();
    const bool indices_fit =
        std::all_of(mesh_.triangles.begin(), mesh_.triangles.end(),
                    [&](const Triangle& t) { return t[0] < nv && t[1] < nv && t[2] < nv; });
    if (!all_finite(scalars(mesh_.positions)))
        wrong_ = "positions are not finite";
    else if (!indices_fit)
        wrong_ = "a triangle has an index beyond the vertices";
    else if (!keep_if_written(mesh_.normals))
        wrong_ = "normals are not finite";
    else if (!keep_if_written(mesh_.corner_coords))
        wrong_ = "texture coordinates are not finite";
    if (std::all_of(mesh_.colors.begin(), mesh_.colors.end(), [](const auto& c) {
            return c == std::array<std::uint8_t, 4>{0, 0, 0, 0};
        }))
        mesh_.colors.clear();
    return wrong_.empty() ? TOILE_OK : TOILE_E_NUMERIC;
}

SunkMesh MeshSink::take() {
    if (!begun_) throw Error("the plugin gave no mesh");
    if (!committed_) throw Error("the plugin began a mesh and did not commit it");
    if (!wrong_.empty()) throw Error("the plugin's mesh is refused: " + wrong_);
    return std::move(mesh_);
}

} // namespace toile::host
