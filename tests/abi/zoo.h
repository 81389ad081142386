// A folder of plugins made for one test: the zoo's libraries under the name of their fault.
#pragma once

#include "support/temporary_folder.h"

#include <elf.h>
#include <fstream>
#include <iterator>
#include <string>

namespace toile::test {

class Zoo {
  public:
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

    /// A plugin whose library behaves as `animal` says. Returns its manifest.
    std::filesystem::path add(const std::string& animal, const std::string& id = "zoo.animal",
                              int priority = 0) {
        std::string bytes = library_bytes(animal);
        if (animal == "zeroed_tables") bytes.replace(0x200, 0xe00, 0xe00, '\0');
        if (animal == "zeroed_code") zero_code(bytes);
        return add_file(animal, bytes, id, priority);
    }
    /// A plugin whose library has these bytes.
    std::filesystem::path add_file(const std::string& name, const std::string& bytes,
                                   const std::string& id = "zoo.animal", int priority = 0) {
        const auto manifest = write_manifest(
            name, R"({"id":")" + id +
                      R"(","version":"1.0.0","abi":{"major":1,"minor":0},"library":"libzoo.so",)" +
                      R"("provides":["toile.skinning/1"],"priority":)" + std::to_string(priority) +
                      "}");
        // A fresh file each time: an old one may be mapped.
        const auto library = manifest.parent_path() / "libzoo.so";
        std::filesystem::remove(library);
        std::ofstream(library, std::ios::binary) << bytes;
        return manifest;
    }
    std::filesystem::path write_manifest(const std::string& name, const std::string& json) {
        const auto folder = folder_.path() / name;
        std::filesystem::create_directories(folder);
        std::ofstream(folder / "plugin.json") << json;
        return folder / "plugin.json";
    }
    /// Bytes of the library that the build made for an animal.
    static std::string library_bytes(const std::string& animal = "good") {
        const bool own = animal == "entry_none" || animal == "entry_function" ||
                         animal == "entry_symbol_short" || animal == "entry_undefined";
        std::ifstream in(std::string(TOILE_ZOO_FOLDER "/lib") + (own ? animal : "zoo") + ".so",
                         std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

  private:
    // A bad copy: the first page of code holds zeros.
    static void zero_code(std::string& bytes) {
        const auto* elf = reinterpret_cast<const Elf64_Ehdr*>(bytes.data());
        const auto* segment = reinterpret_cast<const Elf64_Phdr*>(bytes.data() + elf->e_phoff);
        for (int i = 0; i < elf->e_phnum; ++i, ++segment)
            if (segment->p_type == PT_LOAD && (segment->p_flags & PF_X) != 0)
                bytes.replace(segment->p_offset, segment->p_filesz, segment->p_filesz, '\0');
    }

    TemporaryFolder folder_;
};

} // namespace toile::test
