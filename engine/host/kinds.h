// The kinds and extensions that this engine knows, and which table of calls belongs to which.
#pragma once

#include "abi/toile.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace toile::host {

/// A table of calls: `uint32_t size, reserved`, then function pointers only.
struct KindInfo {
    const char* id;           ///< "toile.skinning/1"
    std::uint32_t base_size;  ///< bytes of its table in ABI 1.0: the least a plugin may have
    std::uint32_t size;       ///< bytes of its table in this build
    const char* const* calls; ///< their names, in the table's order
};

[[nodiscard]] std::span<const KindInfo> known_kinds();
[[nodiscard]] std::span<const KindInfo> known_extensions(); ///< an instance's, beside its kinds
/// Ids of what the host offers to plugins (`needs` of a manifest).
[[nodiscard]] std::span<const char* const> host_extensions();
/// Kinds and extensions; null when unknown.
[[nodiscard]] const KindInfo* find_kind(std::string_view id);

/// Text of a status: "TOILE_E_IO".
[[nodiscard]] std::string status_text(toile_status status);

/// Id of a table's type: KindOf<toile_skinning>::id.
template <class Table>
struct KindOf;
template <>
struct KindOf<toile_sensor> {
    static constexpr const char* id = TOILE_SENSOR;
};
template <>
struct KindOf<toile_body_source> {
    static constexpr const char* id = TOILE_BODY_SOURCE;
};
template <>
struct KindOf<toile_scanner> {
    static constexpr const char* id = TOILE_SCANNER;
};
template <>
struct KindOf<toile_skinning> {
    static constexpr const char* id = TOILE_SKINNING;
};
template <>
struct KindOf<toile_resizer> {
    static constexpr const char* id = TOILE_RESIZER;
};
template <>
struct KindOf<toile_garment> {
    static constexpr const char* id = TOILE_GARMENT;
};
template <>
struct KindOf<toile_cloth> {
    static constexpr const char* id = TOILE_CLOTH;
};
template <>
struct KindOf<toile_tool> {
    static constexpr const char* id = TOILE_TOOL;
};
template <>
struct KindOf<toile_parameters> {
    static constexpr const char* id = TOILE_PARAMETERS;
};
template <>
struct KindOf<toile_state> {
    static constexpr const char* id = TOILE_STATE;
};
template <>
struct KindOf<toile_debug_draw> {
    static constexpr const char* id = TOILE_DEBUG_DRAW;
};
template <>
struct KindOf<toile_body_fit> {
    static constexpr const char* id = TOILE_BODY_FIT;
};
template <>
struct KindOf<toile_scan_guide> {
    static constexpr const char* id = TOILE_SCAN_GUIDE;
};
template <>
struct KindOf<toile_part_labels> {
    static constexpr const char* id = TOILE_PART_LABELS;
};
template <>
struct KindOf<toile_truth> {
    static constexpr const char* id = TOILE_TRUTH;
};

} // namespace toile::host
