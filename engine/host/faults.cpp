#include "host/faults.h"

#include <bit>

namespace toile::host {
namespace {

std::uint32_t floats_of(std::uint32_t format) noexcept {
    switch (format) {
    case TOILE_F32:
        return 1;
    case TOILE_F32X2:
        return 2;
    case TOILE_F32X3:
        return 3;
    case TOILE_F32X4:
        return 4;
    default:
        return 0;
    }
}

template <class View>
bool rows_finite(const View& view) noexcept {
    const std::uint32_t floats = floats_of(view.format);
    if (floats == 0 || view.count == 0) return true;
    if (view.stride == floats * sizeof(float))
        return all_finite(
            std::span(static_cast<const float*>(view.data), std::size_t{view.count} * floats));
    const char* row = static_cast<const char*>(view.data);
    for (std::uint32_t i = 0; i < view.count; ++i, row += view.stride)
        if (!all_finite(std::span(reinterpret_cast<const float*>(row), floats))) return false;
    return true;
}

} // namespace

bool all_finite(std::span<const float> values) noexcept {
    constexpr std::uint32_t exponent = 0x7f800000u; // all ones: infinity or NaN
    std::uint32_t bad = 0;
    for (const float value : values)
        bad |= (std::bit_cast<std::uint32_t>(value) & exponent) == exponent ? 1u : 0u;
    return bad == 0;
}

bool view_finite(const toile_view& view) noexcept {
    return rows_finite(view);
}

bool view_finite(const toile_view_mut& view) noexcept {
    return rows_finite(view);
}

bool FaultWatch::frame(toile_status status, bool finite, double elapsed_s) noexcept {
    const bool failed = status < 0;
    const bool overrun = limits_.live_clock && elapsed_s > limits_.budget_s;
    failures_ += failed ? 1 : 0;
    overruns_ += overrun ? 1 : 0;
    recent_failures_ = (recent_failures_ << 1) | (failed ? 1u : 0u);
    recent_overruns_ = (recent_overruns_ << 1) | (overrun ? 1u : 0u);
    if (fault_ != Fault::none) return false;
    if (!finite)
        fault_ = Fault::non_finite;
    else if (std::popcount(recent_failures_) >= limits_.failures)
        fault_ = Fault::failing;
    else if (std::popcount(recent_overruns_) >= limits_.overruns)
        fault_ = Fault::over_budget;
    return fault_ != Fault::none;
}

void FaultWatch::clear() noexcept {
    fault_ = Fault::none;
    recent_failures_ = 0;
    recent_overruns_ = 0;
}

std::string FaultWatch::text(const std::string& plugin_id) const {
    switch (fault_) {
    case Fault::none:
        return plugin_id + " is in use";
    case Fault::non_finite:
        return plugin_id + " is switched off: returned numbers that are not finite";
    case Fault::failing:
        return plugin_id + " is switched off: its calls fail again and again";
    case Fault::over_budget:
        break;
    }
    return plugin_id + " is switched off: overran its budget of " +
           std::to_string(static_cast<int>(limits_.budget_s * 1e3)) + " ms again and again";
}

} // namespace toile::host
