#include "garment/package_files.h"

#include "assets/zip.h"
#include "core/bytes.h"
#include "core/paths.h"
#include "garment/manifest_reader.h"

#include <algorithm>
#include <set>
#include <unistd.h>

namespace toile::garment {
namespace fs = std::filesystem;
namespace {

bool is_zip(const fs::path& file) {
    return file.extension() == ".zip";
}

/// A fresh folder that nobody else uses.
fs::path make_temporary_folder() {
    std::string pattern = (fs::temp_directory_path() / "toile-garment-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
        throw Error("no temporary folder can be made in " + fs::temp_directory_path().string());
    return pattern;
}

bool stands_inside(const fs::path& file, const fs::path& folder) {
    const auto [at, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return at == folder.end();
}

} // namespace

PackageFiles::PackageFiles(const fs::path& folder_or_zip, const PackageLimits& limits)
    : source_(folder_or_zip), limits_(limits) {
    std::error_code code;
    if (fs::is_directory(source_, code)) {
        root_ = fs::canonical(source_);
    } else if (!fs::exists(source_, code)) {
        throw PackageError({FaultCode::not_found, source_.string() + ": no such package"});
    } else if (!is_zip(source_)) {
        throw PackageError({FaultCode::not_found,
                            source_.string() + ": a package is a folder or a .zip, not this file"});
    } else {
        root_ = fs::canonical(make_temporary_folder());
        temporary_ = true;
        try {
            unpack();
        } catch (const Error& e) {
            fs::remove_all(root_, code);
            throw PackageError({FaultCode::archive, e.what()});
        } catch (...) {
            fs::remove_all(root_, code);
            throw;
        }
    }
}

void PackageFiles::unpack() {
    assets::ZipLimits zip;
    zip.max_file_bytes = limits_.max_package_bytes;
    zip.max_entry_bytes = limits_.max_file_bytes;
    zip.max_total_bytes = limits_.max_package_bytes;
    assets::extract_zip(source_, root_, zip);
}

PackageFiles::~PackageFiles() {
    std::error_code code;
    if (temporary_) fs::remove_all(root_, code);
}

std::string PackageFiles::shown(const std::string& relative) const {
    return (source_ / relative).string();
}

fs::path PackageFiles::resolve(const std::string& relative, const std::string& named_by) const {
    const auto refuse = [&](FaultCode code, const std::string& what) {
        throw PackageError({code, shown(named_by) + ": the file '" + relative + "' " + what});
    };
    if (const std::string reason = unsafe_path_reason(relative); !reason.empty())
        refuse(FaultCode::unsafe_path, reason);
    std::error_code code;
    const fs::path file = fs::canonical(root_ / relative, code);
    if (code) refuse(FaultCode::missing_file, "does not exist");
    if (!stands_inside(file, root_))
        refuse(FaultCode::unsafe_path, "is a symbolic link that leaves the package");
    if (!fs::is_regular_file(file, code)) refuse(FaultCode::missing_file, "is not a regular file");
    if (fs::file_size(file, code) > limits_.max_file_bytes)
        refuse(FaultCode::mesh_file,
               "is larger than " + std::to_string(limits_.max_file_bytes >> 20) + " MiB");
    return file;
}

fs::path find_garment(const std::string& id) {
    std::error_code code;
    if (!is_identifier(id)) {
        if (fs::exists(id, code)) return id;
        throw PackageError({FaultCode::not_found, id + ": no such package"});
    }
    for (const fs::path& folder : data_folders("garments")) {
        if (fs::exists(folder / id / "garment.json", code)) return folder / id;
        if (fs::is_regular_file(folder / (id + ".zip"), code)) return folder / (id + ".zip");
    }
    if (fs::is_directory(id, code)) return id;
    std::string known;
    for (const std::string& other : list_garments())
        known += (known.empty() ? "" : ", ") + other;
    throw PackageError({FaultCode::not_found, "no garment is called '" + id +
                                                  "'; known: " + (known.empty() ? "none" : known)});
}

std::vector<std::string> list_garments() {
    std::set<std::string> ids;
    for (const fs::path& folder : data_folders("garments"))
        for (const auto& entry : fs::directory_iterator(folder)) {
            const std::string name = entry.path().stem().string();
            const bool package = fs::exists(entry.path() / "garment.json") || is_zip(entry.path());
            if (package && is_identifier(name)) ids.insert(name);
        }
    return {ids.begin(), ids.end()};
}

} // namespace toile::garment
