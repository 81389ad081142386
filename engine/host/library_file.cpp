#include "host/library_file.h"

#include <array>
#include <cstring>
#include <elf.h>
#include <fstream>

namespace toile::host {
namespace {

class Reader {
  public:
    Reader(const std::filesystem::path& file, std::string shown)
        : name_(file.filename().string()), shown_(std::move(shown)), in_(file, std::ios::binary) {
        std::error_code code;
        if (!std::filesystem::is_regular_file(file, code))
            throw refuse(Refusal::library_missing, "no such file beside the manifest");
        size_ = std::filesystem::file_size(file, code);
        if (!in_ || code) throw refuse(Refusal::library_missing, "cannot be read");
    }

    [[nodiscard]] PluginRefused refuse(Refusal reason, const std::string& what) const {
        return {reason, shown_, "library '" + name_ + "': " + what};
    }
    [[nodiscard]] std::uint64_t size() const { return size_; }

    template <class T>
    T read(std::uint64_t offset) {
        T out;
        if (!inside(offset, sizeof(T))) throw truncated(offset + sizeof(T));
        in_.seekg(static_cast<std::streamoff>(offset));
        in_.read(reinterpret_cast<char*>(&out), sizeof(T));
        if (!in_) throw refuse(Refusal::library_missing, "cannot be read");
        return out;
    }
    [[nodiscard]] bool inside(std::uint64_t offset, std::uint64_t bytes) const {
        return offset <= size_ && bytes <= size_ - offset;
    }
    [[nodiscard]] PluginRefused truncated(std::uint64_t wanted) const {
        return refuse(Refusal::library_truncated,
                      "is truncated: its headers want " + std::to_string(wanted) +
                          " bytes, the file has " + std::to_string(size_) + ": copy it again");
    }

  private:
    std::string name_;
    std::string shown_;
    std::ifstream in_;
    std::uint64_t size_ = 0;
};

void check_table(const Reader& reader, std::uint64_t offset, std::uint64_t count,
                 std::uint64_t bytes) {
    if (!reader.inside(offset, count * bytes)) throw reader.truncated(offset + count * bytes);
}

} // namespace

void check_library_file(const std::filesystem::path& library, const std::string& shown) {
    Reader reader(library, shown);
    if (reader.size() == 0) throw reader.refuse(Refusal::library_truncated, "is empty");
    if (reader.size() < SELFMAG ||
        std::memcmp(reader.read<std::array<char, SELFMAG>>(0).data(), ELFMAG, SELFMAG) != 0)
        throw reader.refuse(Refusal::library_not_shared_object, "is not a shared library");

    // Identity: 64 bit, little endian, x86-64, ET_DYN.
    const auto ident = reader.read<std::array<unsigned char, EI_NIDENT>>(0);
    const auto header = reader.read<Elf64_Ehdr>(0);
    if (ident[EI_CLASS] != ELFCLASS64 || ident[EI_DATA] != ELFDATA2LSB ||
        header.e_machine != EM_X86_64)
        throw reader.refuse(Refusal::library_wrong_architecture,
                            "is built for another processor (ELF machine " +
                                std::to_string(header.e_machine) + ", this is x86-64)");
    if (header.e_type != ET_DYN)
        throw reader.refuse(Refusal::library_not_shared_object,
                            "is an ELF file, but not a shared library");

    // Everything that the headers promise must lie inside the file.
    check_table(reader, header.e_phoff, header.e_phnum, sizeof(Elf64_Phdr));
    if (header.e_phnum == 0 || header.e_phentsize != sizeof(Elf64_Phdr))
        throw reader.refuse(Refusal::library_not_shared_object, "has no program headers");
    for (std::uint64_t i = 0; i < header.e_phnum; ++i) {
        const auto segment = reader.read<Elf64_Phdr>(header.e_phoff + i * sizeof(Elf64_Phdr));
        if (segment.p_type != PT_NULL) check_table(reader, segment.p_offset, 1, segment.p_filesz);
    }
    if (header.e_shoff != 0 && header.e_shentsize == sizeof(Elf64_Shdr))
        check_table(reader, header.e_shoff, header.e_shnum, sizeof(Elf64_Shdr));
}

} // namespace toile::host
