// Eight particles at a time: rows x y z w of eight vertices become four registers and back.
// Loading rows and turning them in registers is faster than AVX2's gathers, and there is no
// scatter.
#pragma once

#include "core/types.h"

#include <immintrin.h>

namespace toile::cloth {

inline constexpr std::size_t kLanes = 8;

struct Lanes3 {
    __m256 x, y, z;
};

[[gnu::always_inline]] inline __m256 dot(const Lanes3& a, const Lanes3& b) noexcept {
    return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(a.x, b.x), _mm256_mul_ps(a.y, b.y)),
                         _mm256_mul_ps(a.z, b.z));
}
[[gnu::always_inline]] inline Lanes3 operator-(const Lanes3& a, const Lanes3& b) noexcept {
    return {_mm256_sub_ps(a.x, b.x), _mm256_sub_ps(a.y, b.y), _mm256_sub_ps(a.z, b.z)};
}
[[gnu::always_inline]] inline Lanes3 operator+(const Lanes3& a, const Lanes3& b) noexcept {
    return {_mm256_add_ps(a.x, b.x), _mm256_add_ps(a.y, b.y), _mm256_add_ps(a.z, b.z)};
}
/// a s + b t
[[gnu::always_inline]] inline Lanes3 blend(const Lanes3& a, __m256 s, const Lanes3& b,
                                           __m256 t) noexcept {
    return {_mm256_fmadd_ps(a.x, s, _mm256_mul_ps(b.x, t)),
            _mm256_fmadd_ps(a.y, s, _mm256_mul_ps(b.y, t)),
            _mm256_fmadd_ps(a.z, s, _mm256_mul_ps(b.z, t))};
}
/// a += s b
[[gnu::always_inline]] inline void add(Lanes3& a, __m256 s, const Lanes3& b) noexcept {
    a.x = _mm256_fmadd_ps(s, b.x, a.x);
    a.y = _mm256_fmadd_ps(s, b.y, a.y);
    a.z = _mm256_fmadd_ps(s, b.z, a.z);
}

[[gnu::always_inline]] inline __m256 load(const float* values) noexcept {
    return _mm256_loadu_ps(values);
}

/// Asks for what stands some way behind one element of a long array that is read from its front.
template <class Element>
[[gnu::always_inline]] inline void read_ahead(const Element& element) noexcept {
    constexpr std::size_t kAhead = 2048; // bytes
    const char* const at = reinterpret_cast<const char*>(&element) + kAhead;
    for (std::size_t line = 0; line < sizeof(Element); line += 64) {
        __builtin_prefetch(at + line);
    }
}

/// x y z w of eight rows.
struct Lanes4 {
    Lanes3 xyz;
    __m256 w;
};

/// Rows index[0..7] of `rows`.
template <class Index>
[[gnu::always_inline]] inline Lanes4 load_rows4(const Vec4f* rows, const Index* index) noexcept {
    const auto pair = [&](std::size_t k) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(rows[index[k]].data())),
                                    _mm_load_ps(rows[index[k + 4]].data()), 1);
    };
    const __m256 r0 = pair(0);
    const __m256 r1 = pair(1);
    const __m256 r2 = pair(2);
    const __m256 r3 = pair(3);
    const __m256 xy01 = _mm256_unpacklo_ps(r0, r1);
    const __m256 xy23 = _mm256_unpacklo_ps(r2, r3);
    const __m256 zw01 = _mm256_unpackhi_ps(r0, r1);
    const __m256 zw23 = _mm256_unpackhi_ps(r2, r3);
    return {{_mm256_shuffle_ps(xy01, xy23, _MM_SHUFFLE(1, 0, 1, 0)),
             _mm256_shuffle_ps(xy01, xy23, _MM_SHUFFLE(3, 2, 3, 2)),
             _mm256_shuffle_ps(zw01, zw23, _MM_SHUFFLE(1, 0, 1, 0))},
            _mm256_shuffle_ps(zw01, zw23, _MM_SHUFFLE(3, 2, 3, 2))};
}
[[gnu::always_inline]] inline Lanes3 load_rows(const Vec4f* rows,
                                               const std::uint32_t* index) noexcept {
    return load_rows4(rows, index).xyz;
}

/// Back again.
template <class Index>
[[gnu::always_inline]] inline void store_rows4(Vec4f* rows, const Index* index,
                                               const Lanes4& a) noexcept {
    const __m256 xy_low = _mm256_unpacklo_ps(a.xyz.x, a.xyz.y);
    const __m256 xy_high = _mm256_unpackhi_ps(a.xyz.x, a.xyz.y);
    const __m256 zw_low = _mm256_unpacklo_ps(a.xyz.z, a.w);
    const __m256 zw_high = _mm256_unpackhi_ps(a.xyz.z, a.w);
    const auto put = [&](std::size_t k, __m256 pair) {
        _mm_store_ps(rows[index[k]].data(), _mm256_castps256_ps128(pair));
        _mm_store_ps(rows[index[k + 4]].data(), _mm256_extractf128_ps(pair, 1));
    };
    put(0, _mm256_shuffle_ps(xy_low, zw_low, _MM_SHUFFLE(1, 0, 1, 0)));
    put(1, _mm256_shuffle_ps(xy_low, zw_low, _MM_SHUFFLE(3, 2, 3, 2)));
    put(2, _mm256_shuffle_ps(xy_high, zw_high, _MM_SHUFFLE(1, 0, 1, 0)));
    put(3, _mm256_shuffle_ps(xy_high, zw_high, _MM_SHUFFLE(3, 2, 3, 2)));
}
/// Back again, with w = 0.
[[gnu::always_inline]] inline void store_rows(Vec4f* rows, const std::uint32_t* index,
                                              const Lanes3& a) noexcept {
    store_rows4(rows, index, {a, _mm256_setzero_ps()});
}

} // namespace toile::cloth
