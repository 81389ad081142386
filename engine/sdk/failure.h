// What a plugin's code throws; the SDK turns it into a status and a reported text.
#pragma once

#include "abi/base.h"

#include <stdexcept>
#include <string>

namespace toile::sdk {

/// A call of the boundary failed. Any other std::exception counts as TOILE_E_INTERNAL
/// (std::bad_alloc: TOILE_E_CAPACITY); this class says which status it shall be.
class Failure : public std::runtime_error {
  public:
    Failure(toile_status status, const std::string& text)
        : std::runtime_error(text), status_(status) {}
    [[nodiscard]] toile_status status() const noexcept { return status_; }

  private:
    toile_status status_;
};

/// The host sent something that the boundary does not allow.
inline Failure bad_argument(const std::string& text) {
    return {TOILE_E_ARGUMENT, text};
}

} // namespace toile::sdk
