// plugin.json: what a plugin says of itself, readable without running its code (gate 1).
#pragma once

#include "host/refusal.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace toile::host {

struct Manifest {
    std::filesystem::path file; ///< the plugin.json; empty for a plugin linked in
    std::string id;             ///< "toile.bullet_cloth"
    std::string version;        ///< semver
    std::uint32_t abi_major = 0;
    std::uint32_t abi_minor = 0;
    std::filesystem::path library;     ///< beside the manifest
    std::vector<std::string> provides; ///< kinds: "toile.cloth/1"
    std::vector<std::string> needs;    ///< host extensions: "toile.thread_pool/1"
    std::vector<std::string> schemes;  ///< source URI schemes: "kinect-log"
    int priority = 0;                  ///< the highest of a kind serves it by default
    std::filesystem::path sample;      ///< a short recording beside the manifest, or empty
    std::string method;                ///< of a scanner: "fusion"; else empty
    std::string command;               ///< of a tool: "avatar train-parts"; else empty
    std::string command_summary;       ///< one line for --help
    std::string licence;               ///< SPDX expression, or empty

    [[nodiscard]] bool provides_kind(const std::string& kind) const;
    [[nodiscard]] bool serves_scheme(const std::string& scheme) const;
};

/// Reads and checks a manifest; the library is not looked at. \throw PluginRefused
[[nodiscard]] Manifest read_manifest(const std::filesystem::path& file);

/// Manifests of one folder, sorted: `plugin.json` and `<word>.plugin.json`.
[[nodiscard]] std::vector<std::filesystem::path> manifests_in(const std::filesystem::path& folder);

} // namespace toile::host
