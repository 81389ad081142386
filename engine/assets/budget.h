// What one import may still take; asked before every allocation that a file controls.
#pragma once

#include "assets/files.h"
#include "core/error.h"

#include <string>

namespace toile::assets {

class Budget {
  public:
    Budget(const ImportLimits& limits, std::string file)
        : limits_(limits), file_(std::move(file)), left_(limits.max_decoded_bytes) {}

    /// \throw FileError when `count` things of `size` bytes are more than what is left
    void take(std::size_t count, std::size_t size, const std::string& what) {
        if (size != 0 && count > left_ / size)
            throw FileError(file_, what + " would take the file's decoded data over " +
                                       std::to_string(limits_.max_decoded_bytes) + " bytes");
        left_ -= count * size;
    }
    /// \throw FileError over the limits for the whole file
    void add_mesh(std::size_t vertices, std::size_t triangles, const std::string& what) {
        vertices_ += vertices;
        triangles_ += triangles;
        if (vertices > limits_.max_vertices || vertices_ > limits_.max_vertices)
            throw FileError(file_, what + ": more than " + std::to_string(limits_.max_vertices) +
                                       " vertices");
        if (triangles > limits_.max_triangles || triangles_ > limits_.max_triangles)
            throw FileError(file_, what + ": more than " + std::to_string(limits_.max_triangles) +
                                       " triangles");
    }
    [[nodiscard]] FileError error(const std::string& what) const { return {file_, what}; }
    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const ImportLimits& limits() const { return limits_; }

  private:
    ImportLimits limits_;
    std::string file_;
    std::size_t left_;
    std::size_t vertices_ = 0;
    std::size_t triangles_ = 0;
};

} // namespace toile::assets
