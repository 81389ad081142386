#include "host/scan_sink.h"

#include "core/error.h"
#include "host/views.h"

#include <cmath>
#include <cstring>

namespace toile::host {
namespace {

constexpr std::uint32_t kLargestTexture = 8192;
constexpr std::size_t kLongestReport = 1u << 20;

ScanSink& of(toile_scan_sink* sink) {
    return *static_cast<ScanSink*>(sink->sink_data);
}

} // namespace

ScanSink::ScanSink(std::uint32_t max_vertices, std::uint32_t max_triangles)
    : mesh_(max_vertices, max_triangles) {
    sink_.size = sizeof(toile_scan_sink);
    sink_.mesh = mesh_.handle();
    sink_.sink_data = this;
    sink_.texture = [](toile_scan_sink* sink, std::uint32_t width, std::uint32_t height,
                       toile_view_mut* out) { return of(sink).texture(width, height, out); };
    sink_.skin = [](toile_scan_sink* sink, toile_view_mut* joints, toile_view_mut* weights) {
        return of(sink).skin(joints, weights);
    };
    sink_.report = [](toile_scan_sink* sink, const char* json) { return of(sink).report(json); };
}

toile_status ScanSink::texture(std::uint32_t width, std::uint32_t height, toile_view_mut* out) {
    if (out == nullptr || width == 0 || height == 0 || !scan_.texture.empty())
        return TOILE_E_ARGUMENT;
    if (width > kLargestTexture || height > kLargestTexture) return TOILE_E_CAPACITY;
    scan_.texture_width = width;
    scan_.texture_height = height;
    scan_.texture.assign(std::size_t{4} * width * height, 0);
    *out = {scan_.texture.data(), width * height, 4, TOILE_U8X4, 0};
    return TOILE_OK;
}

toile_status ScanSink::skin(toile_view_mut* joints, toile_view_mut* weights) {
    if (joints == nullptr || weights == nullptr || !scan_.joints.empty()) return TOILE_E_ARGUMENT;
    const std::size_t vertices = mesh_.vertex_count();
    if (vertices == 0) return TOILE_E_ARGUMENT; // before the mesh
    scan_.joints.assign(vertices, {});
    scan_.weights.assign(vertices, {});
    *joints = view_mut(scan_.joints);
    *weights = view_mut(scan_.weights);
    return TOILE_OK;
}

toile_status ScanSink::report(const char* json) {
    if (json == nullptr) return TOILE_E_ARGUMENT;
    const std::size_t length = strnlen(json, kLongestReport);
    if (length == kLongestReport) return TOILE_E_CAPACITY;
    scan_.report.assign(json, length);
    return TOILE_OK;
}

SunkScan ScanSink::take() {
    scan_.mesh = mesh_.take();
    for (std::size_t v = 0; v < scan_.joints.size(); ++v) {
        float sum = 0.0f;
        for (std::size_t k = 0; k < 4; ++k) {
            if (scan_.joints[v][k] >= TOILE_JOINT_COUNT || !(scan_.weights[v][k] >= 0.0f))
                throw Error("the plugin's skin is refused: a joint or weight out of range");
            sum += scan_.weights[v][k];
        }
        if (!(std::abs(sum - 1.0f) < 1e-3f))
            throw Error("the plugin's skin is refused: weights that do not sum to 1");
    }
    return std::move(scan_);
}

} // namespace toile::host
