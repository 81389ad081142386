#include "core/bytes.h"

#include <fstream>

namespace toile {

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file, std::size_t max_bytes) {
    std::error_code problem;
    if (!std::filesystem::exists(file, problem)) throw FileError(file.string(), "no such file");
    if (!std::filesystem::is_regular_file(file, problem))
        throw FileError(file.string(), "not a regular file");
    const auto size = std::filesystem::file_size(file, problem);
    if (problem) throw FileError(file.string(), "cannot be read: " + problem.message());
    if (size > max_bytes)
        throw FileError(file.string(), "is " + std::to_string(size) + " bytes, more than the " +
                                           std::to_string(max_bytes) + " allowed");
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    std::ifstream stream(file, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream || static_cast<std::size_t>(stream.gcount()) != bytes.size())
        throw FileError(file.string(), "cannot be read");
    return bytes;
}

void write_bytes(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    if (!stream) throw FileError(file.string(), "cannot be opened for writing");
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw FileError(file.string(), "cannot be written (disk full?)");
}

void write_text(const std::filesystem::path& file, std::string_view text) {
    write_bytes(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

} // namespace toile
