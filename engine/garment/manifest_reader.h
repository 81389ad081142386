// Reads a JSON object key by key and goes on after a fault, so that all of them are reported.
#pragma once

#include "core/json.h"
#include "garment/fault.h"
#include "garment/manifest.h"

#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace toile::garment {

/// Runs `read`; what it throws becomes a fault of the given kind.
template <typename Read>
bool attempt(Faults& faults, FaultCode code, Read&& read) {
    try {
        std::forward<Read>(read)();
        return true;
    } catch (const PackageError& e) {
        faults.push_back({e.code(), e.what()});
    } catch (const Error& e) {
        faults.push_back({code, e.what()});
    }
    return false;
}

/// A number's sane range, how a file's unit turns into SI, and what to say beyond the range.
struct Quantity {
    const char* key;
    const char* unit; ///< as in the file
    double minimum;   ///< in the file's unit
    double maximum;
    double si_per_unit;
    const char* hint = ""; ///< "" or what a value out of range probably means
};

/// The object's "ease_class": one class for all of the garment, or an object of regions.
/// \throw Error naming the place
[[nodiscard]] EaseIntent read_ease_intent(JsonObject& root);

/// True when `text` is letters a-z, digits and single - _ between, at most 64.
[[nodiscard]] bool is_identifier(std::string_view text);
/// True for MAJOR.MINOR.PATCH with an optional -suffix.
[[nodiscard]] bool is_version(std::string_view text);
/// Why `path` may not stand in a package, or "".
[[nodiscard]] std::string unsafe_path_reason(const std::string& path);

} // namespace toile::garment
