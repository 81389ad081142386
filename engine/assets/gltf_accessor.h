// Accessors of a glTF file as plain arrays: every view checked against its buffer first.
#pragma once

#include "assets/budget.h"

#include <span>
#include <tiny_gltf.h>
#include <vector>

namespace toile::assets {

class AccessorReader {
  public:
    /// Both must outlive this.
    AccessorReader(const tinygltf::Model& model, Budget& budget) : model_(model), budget_(budget) {}

    /// Elements of an accessor. \throw FileError when there is none of that index
    [[nodiscard]] std::size_t count(int accessor, const std::string& what) const;

    /// Numbers an element has: 1 to 4 for scalars and vectors.
    [[nodiscard]] int components(int accessor, const std::string& what) const;

    /// (count * components) numbers, normalised integers as fractions, sparse parts applied.
    /// \throw FileError when it is not of that many components, lies outside its buffer, or holds
    /// numbers that are not finite
    [[nodiscard]] std::vector<float> floats(int accessor, int components, const std::string& what);

    /// (count * components) whole numbers. \throw FileError as above
    [[nodiscard]] std::vector<std::uint32_t> integers(int accessor, int components,
                                                      const std::string& what);

  private:
    // Elements of one type in one view, bounds already checked.
    struct Elements {
        const std::uint8_t* data = nullptr;
        std::size_t stride = 0;
        int component_type = 0;
    };

    const tinygltf::Accessor& at(int accessor, const std::string& what) const;
    Elements elements(int view, std::size_t offset, std::size_t count, int component_type,
                      int components, const std::string& what) const;
    std::vector<double> read(int accessor, int components, const std::string& what);
    void apply_sparse(const tinygltf::Accessor& accessor, int components, const std::string& what,
                      std::vector<double>& values) const;

    const tinygltf::Model& model_;
    Budget& budget_;
};

} // namespace toile::assets
