// The `size` field: structs grow at their end, so reader and writer may know different lengths.
#pragma once

#include "sdk/failure.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace toile::sdk {

/// An in-struct as this build knows it: what the writer gave is copied, what it does not know is
/// zero. \throw Failure TOILE_E_ARGUMENT when null or without a size
template <class T>
[[nodiscard]] T read_struct(const T* in, const char* name) {
    if (in == nullptr) throw bad_argument(std::string(name) + ": null");
    if (in->size < 2 * sizeof(std::uint32_t)) throw bad_argument(std::string(name) + ": no size");
    T out{};
    const std::size_t bytes = std::min<std::size_t>(in->size, sizeof(T));
    std::memcpy(&out, in, bytes);
    out.size = static_cast<std::uint32_t>(bytes);
    return out;
}

/// Fills an out-struct: at most what its owner has room for, and never its size.
/// \throw Failure TOILE_E_ARGUMENT when null or without a size
template <class T>
void write_struct(T* out, const T& value, const char* name) {
    if (out == nullptr) throw bad_argument(std::string(name) + ": null");
    const std::size_t room = out->size;
    if (room < 2 * sizeof(std::uint32_t)) throw bad_argument(std::string(name) + ": no size");
    std::memcpy(reinterpret_cast<char*>(out) + sizeof(out->size),
                reinterpret_cast<const char*>(&value) + sizeof(value.size),
                std::min(room, sizeof(T)) - sizeof(value.size));
}

/// An array of structs with `size`: the element's size is the array's stride.
template <class T>
class SizedArray {
  public:
    /// \throw Failure TOILE_E_ARGUMENT when null, or elements are shorter than this build's
    SizedArray(T* first, std::uint32_t count, const char* name) : first_(first), count_(count) {
        if (count == 0) return;
        if (first == nullptr) throw bad_argument(std::string(name) + ": null");
        if (first->size < sizeof(T)) throw bad_argument(std::string(name) + ": short elements");
        stride_ = first->size;
    }
    [[nodiscard]] std::uint32_t size() const noexcept { return count_; }
    [[nodiscard]] T& operator[](std::uint32_t i) const noexcept {
        using Byte = std::conditional_t<std::is_const_v<T>, const char, char>;
        return *reinterpret_cast<T*>(reinterpret_cast<Byte*>(first_) + std::size_t{i} * stride_);
    }

  private:
    T* first_;
    std::uint32_t count_;
    std::size_t stride_ = 0;
};

} // namespace toile::sdk
