// One binary file of named tables: whole numbers, and real numbers in 16 bits a value.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace toile::body {

/// Collects tables and writes them. Little-endian; docs/file_formats.md has the layout.
class TableWriter {
  public:
    void integers(const std::string& name, std::span<const std::uint32_t> values);
    /// Each column is scaled to 16 bits: off by at most 1/65534 of its largest magnitude.
    void numbers(const std::string& name, const Eigen::MatrixXf& values);
    /// \throw FileError when the file cannot be written
    void write(const std::filesystem::path& file) const;

  private:
    std::vector<std::uint8_t> bytes_;
    std::uint32_t count_ = 0;
};

/// Reads such a file whole. \throw FileError naming what is wrong with it
class TableReader {
  public:
    explicit TableReader(const std::filesystem::path& file);

    /// \throw FileError when the table is missing, has another kind, or an entry is >= `bound`
    [[nodiscard]] std::vector<std::uint32_t> integers(const std::string& name,
                                                      std::uint32_t bound) const;
    /// \throw FileError when the table is missing, has another kind or another size
    [[nodiscard]] Eigen::MatrixXf numbers(const std::string& name, std::size_t rows,
                                          std::size_t columns) const;

  private:
    struct Table {
        std::uint32_t kind = 0;
        std::size_t rows = 0, columns = 0, offset = 0;
    };
    [[nodiscard]] const Table& find(const std::string& name, std::uint32_t kind) const;

    std::string file_;
    std::vector<std::uint8_t> bytes_;
    std::map<std::string, Table> tables_;
};

} // namespace toile::body
