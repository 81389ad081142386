// Typed spans from the boundary's untyped views, with format, stride and count checked.
#pragma once

#include "sdk/failure.h"

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

namespace toile::sdk {

using Float2 = std::array<float, 2>;
using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;
using Byte4 = std::array<std::uint8_t, 4>;
using Index4 = std::array<std::uint16_t, 4>; ///< joint indices of a vertex
using Triangle = std::array<std::uint32_t, 3>;

/// The TOILE_* format whose elements are T; TOILE_STRUCT for a struct of the boundary.
template <class T>
constexpr std::uint32_t format_of() {
    if constexpr (std::is_same_v<T, float>)
        return TOILE_F32;
    else if constexpr (std::is_same_v<T, Float2>)
        return TOILE_F32X2;
    else if constexpr (std::is_same_v<T, Float3>)
        return TOILE_F32X3;
    else if constexpr (std::is_same_v<T, Float4>)
        return TOILE_F32X4;
    else if constexpr (std::is_same_v<T, std::uint8_t>)
        return TOILE_U8;
    else if constexpr (std::is_same_v<T, Byte4>)
        return TOILE_U8X4;
    else if constexpr (std::is_same_v<T, std::uint16_t>)
        return TOILE_U16;
    else if constexpr (std::is_same_v<T, Index4>)
        return TOILE_U16X4;
    else if constexpr (std::is_same_v<T, std::uint32_t>)
        return TOILE_U32;
    else if constexpr (std::is_same_v<T, Triangle>)
        return TOILE_U32X3;
    else
        return TOILE_STRUCT;
}

namespace detail {
template <class T, class View>
void check_view(const View& view, const char* name) {
    if (view.count == 0) return;
    const auto refuse = [&](const char* what) { return bad_argument(std::string(name) + what); };
    if (view.data == nullptr) throw refuse(": null data");
    if (view.format != format_of<T>()) throw refuse(": wrong element format");
    if (view.stride != sizeof(T)) throw refuse(": elements are not packed");
    if (reinterpret_cast<std::uintptr_t>(view.data) % alignof(T) != 0)
        throw refuse(": data is not aligned");
}
inline void check_count(std::size_t have, std::size_t want, const char* name) {
    if (have != want)
        throw bad_argument(std::string(name) + ": " + std::to_string(have) + " elements, " +
                           std::to_string(want) + " wanted");
}
} // namespace detail

/// Elements of a view of any count; empty for count 0. `name` stands in errors.
/// \throw Failure TOILE_E_ARGUMENT for another format, stride or alignment
template <class T>
[[nodiscard]] std::span<const T> span_of(const toile_view& view, const char* name) {
    detail::check_view<T>(view, name);
    return {static_cast<const T*>(view.data), view.count};
}
template <class T>
[[nodiscard]] std::span<T> span_of(const toile_view_mut& view, const char* name) {
    detail::check_view<T>(view, name);
    return {static_cast<T*>(view.data), view.count};
}

/// The same, and exactly `count` elements.
template <class T>
[[nodiscard]] std::span<const T> span_of(const toile_view& view, const char* name,
                                         std::size_t count) {
    detail::check_count(view.count, count, name);
    return span_of<T>(view, name);
}
template <class T>
[[nodiscard]] std::span<T> span_of(const toile_view_mut& view, const char* name,
                                   std::size_t count) {
    detail::check_count(view.count, count, name);
    return span_of<T>(view, name);
}

/// A view of a plugin's own packed data, to hand to the host.
template <class T>
[[nodiscard]] toile_view view_of(std::span<const T> data) noexcept {
    return {data.data(), static_cast<std::uint32_t>(data.size()), sizeof(T), format_of<T>(), 0};
}

} // namespace toile::sdk
