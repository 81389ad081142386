#include "host/kinds.h"

#include <array>

namespace toile::host {
namespace {

constexpr const char* kSensor[] = {"open", "stream_count", "describe", "poll", "release"};
constexpr const char* kBodySource[] = {"describe", "begin", "feed", "result", "end"};
constexpr const char* kScanner[] = {"begin", "feed", "finish"};
constexpr const char* kSkinning[] = {"bind", "pose"};
constexpr const char* kResizer[] = {"resize"};
constexpr const char* kGarment[] = {"bind", "targets"};
constexpr const char* kCloth[] = {"set_body", "add_garment", "remove_garment", "step"};
constexpr const char* kTool[] = {"describe", "run"};
constexpr const char* kParameters[] = {"count", "describe", "get", "set"};
constexpr const char* kState[] = {"save", "load"};
constexpr const char* kDebugDraw[] = {"lines"};
constexpr const char* kBodyFit[] = {"fit", "surface", "report"};
constexpr const char* kScanGuide[] = {"guide"};
constexpr const char* kPartLabels[] = {"labels"};
constexpr const char* kTruth[] = {"people", "camera", "surface_count", "surface"};

// `n` calls now, the first `base` of them in ABI 1.0.
template <std::size_t n>
constexpr KindInfo table(const char* id, const char* const (&calls)[n], std::size_t base = n) {
    constexpr std::size_t head = 2 * sizeof(std::uint32_t);
    constexpr std::size_t call = sizeof(void (*)());
    return {id, static_cast<std::uint32_t>(head + base * call),
            static_cast<std::uint32_t>(head + n * call), calls};
}

constexpr std::array kKinds{
    table(TOILE_SENSOR, kSensor),   table(TOILE_BODY_SOURCE, kBodySource),
    table(TOILE_SCANNER, kScanner), table(TOILE_SKINNING, kSkinning),
    table(TOILE_RESIZER, kResizer), table(TOILE_GARMENT, kGarment),
    table(TOILE_CLOTH, kCloth),     table(TOILE_TOOL, kTool),
};
constexpr std::array kExtensions{
    table(TOILE_PARAMETERS, kParameters),  table(TOILE_STATE, kState),
    table(TOILE_DEBUG_DRAW, kDebugDraw),   table(TOILE_TRUTH, kTruth),
    table(TOILE_BODY_FIT, kBodyFit),       table(TOILE_SCAN_GUIDE, kScanGuide),
    table(TOILE_PART_LABELS, kPartLabels),
};
constexpr std::array kHostExtensions{TOILE_THREAD_POOL};

// A table that grows in a later minor names its calls of ABI 1.0 above: table(id, calls, base).
static_assert(table(TOILE_SENSOR, kSensor).size == sizeof(toile_sensor));
static_assert(table(TOILE_BODY_SOURCE, kBodySource).size == sizeof(toile_body_source));
static_assert(table(TOILE_SCANNER, kScanner).size == sizeof(toile_scanner));
static_assert(table(TOILE_SKINNING, kSkinning).size == sizeof(toile_skinning));
static_assert(table(TOILE_RESIZER, kResizer).size == sizeof(toile_resizer));
static_assert(table(TOILE_GARMENT, kGarment).size == sizeof(toile_garment));
static_assert(table(TOILE_CLOTH, kCloth).size == sizeof(toile_cloth));
static_assert(table(TOILE_TOOL, kTool).size == sizeof(toile_tool));
static_assert(table(TOILE_PARAMETERS, kParameters).size == sizeof(toile_parameters));
static_assert(table(TOILE_STATE, kState).size == sizeof(toile_state));
static_assert(table(TOILE_DEBUG_DRAW, kDebugDraw).size == sizeof(toile_debug_draw));
static_assert(table(TOILE_BODY_FIT, kBodyFit).size == sizeof(toile_body_fit));
static_assert(table(TOILE_SCAN_GUIDE, kScanGuide).size == sizeof(toile_scan_guide));
static_assert(table(TOILE_PART_LABELS, kPartLabels).size == sizeof(toile_part_labels));
static_assert(table(TOILE_TRUTH, kTruth).size == sizeof(toile_truth));

} // namespace

std::span<const KindInfo> known_kinds() {
    return kKinds;
}

std::span<const KindInfo> known_extensions() {
    return kExtensions;
}

std::span<const char* const> host_extensions() {
    return kHostExtensions;
}

const KindInfo* find_kind(std::string_view id) {
    for (const auto list : {known_kinds(), known_extensions()})
        for (const KindInfo& kind : list)
            if (id == kind.id) return &kind;
    return nullptr;
}

std::string status_text(toile_status status) {
    switch (status) {
    case TOILE_OK:
        return "TOILE_OK";
    case TOILE_NO_NEW_DATA:
        return "TOILE_NO_NEW_DATA";
    case TOILE_END_OF_STREAM:
        return "TOILE_END_OF_STREAM";
    case TOILE_CANCELLED:
        return "TOILE_CANCELLED";
    case TOILE_E_ARGUMENT:
        return "TOILE_E_ARGUMENT";
    case TOILE_E_UNSUPPORTED:
        return "TOILE_E_UNSUPPORTED";
    case TOILE_E_DEVICE:
        return "TOILE_E_DEVICE";
    case TOILE_E_NUMERIC:
        return "TOILE_E_NUMERIC";
    case TOILE_E_CAPACITY:
        return "TOILE_E_CAPACITY";
    case TOILE_E_IO:
        return "TOILE_E_IO";
    case TOILE_E_INTERNAL:
        return "TOILE_E_INTERNAL";
    default:
        return "status " + std::to_string(status);
    }
}

} // namespace toile::host
