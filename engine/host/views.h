// The boundary's views over the engine's own packed data.
#pragma once

#include "abi/body.h"
#include "abi/cloth.h"
#include "core/types.h"

#include <span>
#include <type_traits>

namespace toile::host {

/// The TOILE_* format whose elements are T.
template <class T>
constexpr std::uint32_t format_of() {
    using U = std::remove_const_t<T>;
    if constexpr (std::is_same_v<U, float>)
        return TOILE_F32;
    else if constexpr (std::is_same_v<U, Vec2f> || std::is_same_v<U, std::array<float, 2>>)
        return TOILE_F32X2;
    else if constexpr (std::is_same_v<U, Vec3f> || std::is_same_v<U, std::array<float, 3>>)
        return TOILE_F32X3;
    else if constexpr (std::is_same_v<U, std::array<float, 4>>)
        return TOILE_F32X4;
    else if constexpr (std::is_same_v<U, std::uint8_t>)
        return TOILE_U8;
    else if constexpr (std::is_enum_v<U> && sizeof(U) == 1)
        return TOILE_U8;
    else if constexpr (std::is_same_v<U, std::array<std::uint8_t, 4>>)
        return TOILE_U8X4;
    else if constexpr (std::is_same_v<U, std::uint16_t>)
        return TOILE_U16;
    else if constexpr (std::is_same_v<U, std::array<std::uint16_t, 4>>)
        return TOILE_U16X4;
    else if constexpr (std::is_same_v<U, std::uint32_t>)
        return TOILE_U32;
    else if constexpr (std::is_same_v<U, Triangle>)
        return TOILE_U32X3;
    else {
        static_assert(std::is_same_v<U, toile_joint> || std::is_same_v<U, toile_landmark> ||
                          std::is_same_v<U, toile_measurement> || std::is_same_v<U, toile_seam>,
                      "no format of the boundary has such elements");
        return TOILE_STRUCT;
    }
}

/// Borrowed: the data must outlive the call that it is handed to. Empty data: count 0.
template <class T>
[[nodiscard]] toile_view view_of(std::span<const T> data) noexcept {
    return {data.empty() ? nullptr : data.data(), static_cast<std::uint32_t>(data.size()),
            sizeof(T), format_of<T>(), 0};
}
template <class Container>
[[nodiscard]] toile_view view_of(const Container& data) noexcept {
    return view_of(std::span<const typename Container::value_type>(data));
}
template <class T>
[[nodiscard]] toile_view_mut view_mut(std::span<T> data) noexcept {
    return {data.empty() ? nullptr : data.data(), static_cast<std::uint32_t>(data.size()),
            sizeof(T), format_of<T>(), 0};
}
template <class Container>
[[nodiscard]] toile_view_mut view_mut(Container& data) noexcept {
    return view_mut(std::span<typename Container::value_type>(data));
}

/// A struct of the boundary with its size set and everything else zero.
template <class T>
[[nodiscard]] T sized() noexcept {
    T out{};
    out.size = sizeof(T);
    return out;
}

} // namespace toile::host
