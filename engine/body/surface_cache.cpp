#include "body/surface_cache.h"

#include "assets/files.h"
#include "core/bytes.h"
#include "core/json.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>

namespace toile::body {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSchema = 1;
constexpr std::size_t kMostFrameBytes = 256u << 20;
static_assert(std::endian::native == std::endian::little && sizeof(Vec3f) == 12);

constexpr std::array<std::string_view, 4> kRoles = {"", "body", "garment", "other"};

std::string_view role_name(SurfaceRole role) {
    return kRoles.at(static_cast<std::size_t>(role));
}

fs::path frame_file(const fs::path& folder, std::size_t frame) {
    std::string name = std::to_string(frame);
    name.insert(0, name.size() < 6 ? 6 - name.size() : 0, '0');
    return folder / "frames" / (name + ".f32");
}

std::vector<CachedSurface> list_surfaces(const assets::Scene& scene,
                                         const std::vector<SurfaceRole>& roles) {
    std::vector<CachedSurface> out;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        for (std::size_t p = 0; p < scene.meshes[m].primitives.size(); ++p)
            out.push_back({scene.meshes[m].name, roles[m], m, p,
                           scene.meshes[m].primitives[p].positions.size()});
    return out;
}

std::size_t frame_bytes(const std::vector<CachedSurface>& surfaces) {
    std::size_t vertices = 0;
    for (const CachedSurface& surface : surfaces)
        vertices += surface.vertex_count;
    return vertices * sizeof(Vec3f);
}

std::vector<SurfaceRole> read_roles(const fs::path& file, std::size_t meshes) {
    const nlohmann::json json = parse_json_file(file, 1u << 20);
    JsonObject root(json, file.string());
    root.integer("schema", kSchema, kSchema);
    std::vector<SurfaceRole> roles;
    for (JsonObject& surface : root.objects("surfaces")) {
        surface.text("name");
        const std::string role = surface.text("role");
        const auto known = std::find(kRoles.begin() + 1, kRoles.end(), role);
        if (known == kRoles.end())
            throw surface.error("role", "'" + role + "' is none of body, garment, other");
        roles.push_back(static_cast<SurfaceRole>(known - kRoles.begin()));
        surface.finish();
    }
    root.finish();
    if (roles.size() != meshes)
        throw root.error("surfaces", "names " + std::to_string(roles.size()) +
                                         " surfaces, surfaces.glb holds " + std::to_string(meshes));
    return roles;
}

} // namespace

SurfaceCacheWriter::SurfaceCacheWriter(fs::path folder, const assets::Scene& scene,
                                       const std::vector<SurfaceRole>& roles)
    : folder_(std::move(folder)) {
    if (roles.size() != scene.meshes.size())
        throw Error(folder_.string() + ": not every surface of the cache has a role");
    if (fs::exists(folder_ / "cache.json"))
        throw FileError(folder_.string(), "already holds a surface cache; choose another folder");
    std::error_code problem;
    fs::create_directories(folder_ / "frames", problem);
    if (problem) throw FileError(folder_.string(), "cannot be made: " + problem.message());
    surfaces_ = list_surfaces(scene, roles);
    if (frame_bytes(surfaces_) > kMostFrameBytes)
        throw FileError(folder_.string(), "a frame of these surfaces is too large");
    assets::save_scene(scene, folder_ / "surfaces.glb");
    nlohmann::ordered_json json;
    json["schema"] = kSchema;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        json["surfaces"].push_back(
            {{"name", scene.meshes[m].name}, {"role", std::string(role_name(roles[m]))}});
    write_text(folder_ / "cache.json", json.dump(2) + "\n");
}

void SurfaceCacheWriter::add(double time_s, std::span<const TrackedPerson> people,
                             std::span<const std::span<const Vec3f>> positions) {
    const std::string frame = "frame " + std::to_string(count_);
    if (!std::isfinite(time_s) || (count_ > 0 && time_s <= last_time_s_))
        throw FileError(folder_.string(), frame + ": its time does not come after the one before");
    if (positions.size() != surfaces_.size())
        throw FileError(folder_.string(), frame + ": not one set of positions a surface");
    std::vector<std::uint8_t> bytes;
    bytes.reserve(frame_bytes(surfaces_));
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
        if (positions[s].size() != surfaces_[s].vertex_count)
            throw FileError(folder_.string(),
                            frame + ": surface '" + surfaces_[s].name + "' changed its vertices");
        const auto* data = reinterpret_cast<const std::uint8_t*>(positions[s].data());
        bytes.insert(bytes.end(), data, data + positions[s].size_bytes());
    }
    write_bytes(frame_file(folder_, count_), bytes);
    std::ofstream track(folder_ / "track.jsonl", std::ios::app | std::ios::binary);
    track << track_line(count_, time_s, people);
    track.close();
    if (!track) throw FileError((folder_ / "track.jsonl").string(), "cannot be written");
    last_time_s_ = time_s;
    ++count_;
}

SurfaceCache open_surface_cache(const fs::path& folder) {
    if (!fs::exists(folder / "cache.json"))
        throw FileError(folder.string(), "is no surface cache (no cache.json in it)");
    SurfaceCache out;
    out.folder = folder;
    out.scene = assets::load_scene(folder / "surfaces.glb");
    out.surfaces =
        list_surfaces(out.scene, read_roles(folder / "cache.json", out.scene.meshes.size()));
    out.frames = read_track_frames(folder / "track.jsonl");
    if (out.frames.empty()) throw FileError(folder.string(), "the surface cache has no frames");
    return out;
}

void SurfaceCache::load(std::size_t frame, std::vector<std::vector<Vec3f>>& positions) const {
    const fs::path file = frame_file(folder, frame);
    const std::vector<std::uint8_t> bytes = read_bytes(file, kMostFrameBytes);
    if (bytes.size() != frame_bytes(surfaces))
        throw FileError(file.string(), "has " + std::to_string(bytes.size()) + " bytes, " +
                                           std::to_string(frame_bytes(surfaces)) +
                                           " were expected");
    positions.resize(surfaces.size());
    std::size_t begin = 0;
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        positions[s].resize(surfaces[s].vertex_count);
        const std::size_t count = surfaces[s].vertex_count * sizeof(Vec3f);
        std::memcpy(static_cast<void*>(positions[s].data()), bytes.data() + begin, count);
        begin += count;
        for (const Vec3f& p : positions[s])
            if (!p.allFinite()) throw FileError(file.string(), "a position is not finite");
    }
}

} // namespace toile::body
