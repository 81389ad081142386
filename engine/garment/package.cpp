#include "garment/package.h"

#include "core/bytes.h"
#include "garment/manifest_reader.h"
#include "garment/package_checks.h"
#include "garment/package_files.h"
#include "garment/size_reader.h"
#include "imaging/image.h"

#include <algorithm>
#include <map>
#include <optional>

namespace toile::garment {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxManifestBytes = 16u << 20;

std::string read_manifest_text(const PackageFiles& files) {
    std::error_code code;
    if (!fs::exists(files.root() / "garment.json", code))
        throw PackageError({FaultCode::not_found, files.shown("garment.json") +
                                                      ": no such file; a package has a "
                                                      "garment.json at its top"});
    try {
        const auto bytes =
            read_bytes(files.resolve("garment.json", "garment.json"), kMaxManifestBytes);
        return {bytes.begin(), bytes.end()};
    } catch (const FileError& e) {
        throw PackageError({FaultCode::json, e.what()});
    }
}

/// The bodies that the sizes were made on, each loaded once.
class BodiesMadeOn {
  public:
    explicit BodiesMadeOn(const PackageLimits& limits) : limits_(limits) {}

    /// Null when the size names none, or (with a fault) when there is no such avatar.
    const geometry::TriangleMesh* of(const Manifest& manifest, const SizeEntry& size,
                                     const std::string& shown, Faults& faults) {
        const std::string& id = size.made_on.empty() ? manifest.made_on : size.made_on;
        if (id.empty() || !limits_.body_of) return nullptr;
        const auto [at, added] = bodies_.try_emplace(id);
        if (added) {
            try {
                at->second = limits_.body_of(id);
            } catch (const Error& e) {
                faults.push_back({FaultCode::made_on, shown + ": /made_on: " + e.what()});
            }
        }
        return at->second ? &*at->second : nullptr;
    }

  private:
    const PackageLimits& limits_;
    std::map<std::string, std::optional<geometry::TriangleMesh>> bodies_;
};

void check_thumbnail(const PackageFiles& files, const std::string& thumbnail) {
    constexpr int kMostSide = 1024;
    const fs::path file = files.resolve(thumbnail, "garment.json");
    try {
        (void)imaging::load_image(file, kMostSide);
    } catch (const Error& e) {
        throw PackageError(
            {FaultCode::mesh_file, files.shown("garment.json") + ": /thumbnail: " + e.what()});
    }
}

GarmentPackage read_package(const fs::path& source, const PackageLimits& limits, Faults& faults) {
    GarmentPackage package;
    package.source = source;
    attempt(faults, FaultCode::json, [&] {
        const PackageFiles files(source, limits);
        const std::string shown = files.shown("garment.json");
        package.manifest = read_manifest(read_manifest_text(files), shown, faults);
        if (!package.manifest.thumbnail.empty())
            attempt(faults, FaultCode::missing_file,
                    [&] { check_thumbnail(files, package.manifest.thumbnail); });
        BodiesMadeOn bodies(limits);
        for (const SizeEntry& entry : package.manifest.sizes) {
            GarmentSize size;
            const auto* const body = bodies.of(package.manifest, entry, shown, faults);
            if (entry.mesh.empty() || !read_size_meshes(files, entry, size, faults, package.notes))
                continue;
            const std::string mesh = files.shown(entry.mesh);
            const std::size_t before = faults.size();
            check_simulation(size, mesh, limits, faults);
            check_unit(size, mesh, body, faults);
            if (faults.size() == before) check_render(size, mesh, limits, faults);
            package.sizes.push_back(std::move(size));
        }
        check_across_sizes(package, shown, faults);
    });
    return package;
}

} // namespace

const GarmentSize& GarmentPackage::size(const std::string& name) const {
    const auto found = std::find_if(sizes.begin(), sizes.end(),
                                    [&name](const GarmentSize& s) { return s.entry.name == name; });
    if (found != sizes.end()) return *found;
    std::string known;
    for (const GarmentSize& s : sizes)
        known += (known.empty() ? "" : ", ") + s.entry.name;
    throw Error("garment '" + manifest.id + "' has no size '" + name + "'; its sizes: " + known);
}

std::shared_ptr<const GarmentPackage> load_package(const fs::path& folder_or_zip,
                                                   const PackageLimits& limits) {
    Faults faults;
    auto package = std::make_shared<GarmentPackage>(read_package(folder_or_zip, limits, faults));
    if (!faults.empty()) throw PackageError(faults.front());
    return package;
}

Faults check_package(const fs::path& folder_or_zip, const PackageLimits& limits,
                     std::vector<std::string>* notes) {
    Faults faults;
    const GarmentPackage package = read_package(folder_or_zip, limits, faults);
    if (notes != nullptr) *notes = package.notes;
    return faults;
}

} // namespace toile::garment
