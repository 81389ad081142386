#include "pipeline/scanning.h"

#include "core/error.h"
#include "host/scan_sink.h"
#include "host/views.h"
#include "pipeline/sensor_views.h"

#include <algorithm>

namespace toile::pipeline {
namespace {

constexpr std::uint32_t kMostVertices = 2'000'000, kMostTriangles = 4'000'000;

std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (const std::string& name : names)
        out += (out.empty() ? "" : ", ") + name;
    return out.empty() ? "none" : out;
}

} // namespace

std::vector<std::string> scan_methods(const host::Registry& registry) {
    std::vector<std::string> out;
    for (const host::Manifest& manifest : registry.manifests(TOILE_SCANNER))
        if (std::find(out.begin(), out.end(), manifest.method) == out.end())
            out.push_back(manifest.method);
    return out;
}

std::string Scanning::id_of(const host::Registry& registry, std::string& method) {
    const std::vector<std::string> methods = scan_methods(registry);
    if (methods.empty())
        throw Error("no plugin that scans was found; `toile plugin list` shows what there is");
    if (method.empty()) method = methods.front();
    for (const host::Manifest& manifest : registry.manifests(TOILE_SCANNER))
        if (manifest.method == method) return manifest.id;
    throw UsageError("scan --method '" + method + "': no plugin has it; there are " +
                     listed(methods));
}

Scanning::Scanning(host::Registry& registry, host::Services& services, const toile_limits& limits,
                   const std::string& method)
    : registry_(registry), services_(services), method_(method),
      instance_(registry.find(TOILE_SCANNER, id_of(registry, method_)), services), limits_(limits) {
}

void Scanning::set(const std::string& parameter, double value) {
    const auto* table = instance_.find<toile_parameters>();
    std::vector<std::string> known;
    for (std::uint32_t k = 0; table != nullptr && k < table->count(instance_.handle()); ++k) {
        auto told = host::sized<toile_parameter>();
        instance_.call("describe", [&](toile_instance* i) { return table->describe(i, k, &told); });
        known.emplace_back(told.id);
        if (parameter != told.id) continue;
        if (!(value >= told.minimum && value <= told.maximum))
            throw UsageError("scan --set " + parameter + ": must lie in " +
                             std::to_string(told.minimum) + " to " + std::to_string(told.maximum));
        instance_.call("set",
                       [&](toile_instance* i) { return table->set(i, parameter.c_str(), value); });
        return;
    }
    throw UsageError("scan --set '" + parameter + "': " + method_ + " has " + listed(known));
}

host::Instance& Scanning::active() {
    if (!active_) instance_.activate(limits_);
    active_ = true;
    return instance_;
}

void Scanning::begin(std::span<const SensorStream> streams) {
    std::vector<toile_stream> told;
    for (const SensorStream& stream : streams)
        told.push_back(stream_view(stream, static_cast<std::uint32_t>(told.size())));
    active().call("begin", [&](toile_instance* i) {
        return instance_.table<toile_scanner>().begin(i, told.data(),
                                                      static_cast<std::uint32_t>(told.size()));
    });
    guide_.reset();
    if (instance_.find<toile_scan_guide>() != nullptr) guide_.emplace(streams);
}

void Scanning::feed(std::span<const SensorFrame> frames) {
    std::vector<toile_frame> given;
    for (const SensorFrame& frame : frames)
        given.push_back(frame_view(frame, static_cast<std::uint32_t>(given.size())));
    instance_.call("feed", [&](toile_instance* i) {
        return instance_.table<toile_scanner>().feed(i, given.data(),
                                                     static_cast<std::uint32_t>(given.size()));
    });
    if (guide_) guide_->keep(frames);
}

ScannedSurface Scanning::finish(host::Job& job) {
    nlohmann::ordered_json guided;
    if (guide_) guided = guide_->give(registry_, services_, limits_, instance_, job);
    host::ScanSink sink(kMostVertices, kMostTriangles);
    try {
        instance_.call("finish", [&](toile_instance* i) {
            return instance_.table<toile_scanner>().finish(i, sink.handle(), job.handle());
        });
    } catch (const Error& e) {
        if (guided.contains("reason"))
            throw Error(std::string(e.what()) +
                        "; and no body was found to help: " + guided["reason"].get<std::string>());
        throw;
    }
    host::SunkScan taken = sink.take();
    ScannedSurface out;
    geometry::TriangleMesh& mesh = out.surface.mesh;
    for (const auto& p : taken.mesh.positions)
        mesh.positions.emplace_back(p[0], p[1], p[2]);
    mesh.triangles = std::move(taken.mesh.triangles);
    mesh.normals.resize(mesh.positions.size());
    geometry::vertex_normals(mesh.positions, mesh.triangles, mesh.normals);
    out.surface.colors = std::move(taken.mesh.colors);
    if (!taken.joints.empty())
        out.skin = body::SkinWeights{std::move(taken.joints), std::move(taken.weights)};
    out.report =
        nlohmann::ordered_json::parse(taken.report.empty() ? "{}" : taken.report, nullptr, false);
    if (out.report.is_discarded() || !out.report.is_object())
        throw Error(instance_.id() + ": its report is no JSON object");
    if (!guided.is_null()) out.report["body"] = std::move(guided);
    return out;
}

} // namespace toile::pipeline
