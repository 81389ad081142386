#include "host/plugin.h"

#include "host/kinds.h"
#include "host/library_file.h"

#include <algorithm>
#include <dlfcn.h>
#include <elf.h>
#include <link.h>

namespace toile::host {
namespace {

std::string abi_text(std::uint32_t major, std::uint32_t minor) {
    return std::to_string(major) + "." + std::to_string(minor);
}

std::string bytes_text(std::size_t have, std::size_t want) {
    return std::to_string(have) + " bytes, at least " + std::to_string(want) + " wanted";
}

// dlerror's text without the path in front, which the refusal shows already.
std::string loader_text(const std::filesystem::path& library) {
    const char* text = dlerror();
    std::string out = text == nullptr ? "unknown reason" : text;
    const std::string path = library.string() + ": ";
    if (out.starts_with(path)) out.erase(0, path.size());
    return out;
}

const toile_entry& open_library(const Manifest& manifest) {
    const std::string shown = manifest.file.string();
    check_library_file(manifest.library, shown);
    const std::string name = "library '" + manifest.library.filename().string() + "': ";
    const auto path = std::filesystem::absolute(manifest.library);
    void* library = nullptr;
    try {
        library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    } catch (...) {
        throw PluginRefused(Refusal::library_unloadable, shown,
                            name + "a static constructor threw an exception");
    }
    if (library == nullptr) {
        const std::string text = loader_text(path);
        const bool undefined = text.find("undefined symbol") != std::string::npos;
        throw PluginRefused(undefined ? Refusal::undefined_symbol : Refusal::library_unloadable,
                            shown, name + text);
    }
    void* symbol = dlsym(library, TOILE_ENTRY_SYMBOL);
    const std::string entry = std::string("'") + TOILE_ENTRY_SYMBOL + "'";
    if (symbol == nullptr)
        throw PluginRefused(Refusal::entry_missing, shown, name + "exports no " + entry);
    // The symbol's own length, so that nothing beyond it is read.
    Dl_info info{};
    ElfW(Sym)* elf = nullptr;
    if (dladdr1(symbol, &info, reinterpret_cast<void**>(&elf), RTLD_DL_SYMENT) != 0 &&
        elf != nullptr) {
        if (ELF64_ST_TYPE(elf->st_info) != STT_OBJECT)
            throw PluginRefused(Refusal::entry_missing, shown, name + entry + " is not a constant");
        if (elf->st_size < sizeof(toile_entry))
            throw PluginRefused(Refusal::entry_short, shown,
                                name + entry + " has " +
                                    bytes_text(elf->st_size, sizeof(toile_entry)));
    }
    return *static_cast<const toile_entry*>(symbol);
}

// Gate 2: sizes, versions and presence of what the entry holds.
void check_entry(const toile_entry& entry, const std::string& shown) {
    if (entry.size < sizeof(toile_entry))
        throw PluginRefused(Refusal::entry_short, shown,
                            "entry has " + bytes_text(entry.size, sizeof(toile_entry)));
    const std::string versions = "entry built for ABI " +
                                 abi_text(entry.abi_major, entry.abi_minor) + ", this engine has " +
                                 abi_text(TOILE_ABI_MAJOR, TOILE_ABI_MINOR);
    if (entry.abi_major != TOILE_ABI_MAJOR)
        throw PluginRefused(Refusal::entry_abi_major, shown,
                            versions + ": build it against this engine's headers");
    if (std::uint64_t{entry.abi_minor} > TOILE_ABI_MINOR)
        throw PluginRefused(Refusal::entry_abi_newer, shown, versions + ": update the engine");
    const char* missing = entry.init == nullptr       ? "init"
                          : entry.deinit == nullptr   ? "deinit"
                          : entry.count == nullptr    ? "count"
                          : entry.describe == nullptr ? "describe"
                          : entry.create == nullptr   ? "create"
                                                      : nullptr;
    if (missing != nullptr)
        throw PluginRefused(Refusal::entry_incomplete, shown,
                            std::string("entry lacks '") + missing + "'");
}

void init_entry(const toile_entry& entry, const Manifest& manifest, const std::string& shown) {
    toile_status status = TOILE_OK;
    const std::string folder = manifest.file.parent_path().string();
    try {
        status = entry.init(folder.c_str());
    } catch (...) {
        throw PluginRefused(Refusal::init_threw, shown, "entry's init threw an exception");
    }
    if (status < 0)
        throw PluginRefused(Refusal::init_failed, shown,
                            "entry's init failed with " + status_text(status));
}

// Gate 3 for the descriptor: whole, and saying the same as plugin.json.
const toile_descriptor* find_descriptor(const toile_entry& entry, const Manifest& manifest,
                                        const std::string& shown) {
    const auto disagrees = [&](const std::string& what) {
        return PluginRefused(Refusal::descriptor_disagrees, shown, what);
    };
    for (std::uint32_t i = 0, n = std::min(entry.count(), 256u); i < n; ++i) {
        const toile_descriptor* found = entry.describe(i);
        if (found == nullptr || found->size < sizeof(toile_descriptor))
            throw PluginRefused(
                Refusal::descriptor_short, shown,
                "descriptor " + std::to_string(i) + " has " +
                    bytes_text(found == nullptr ? 0 : found->size, sizeof(toile_descriptor)));
        if (found->id == nullptr || found->name == nullptr || found->version == nullptr ||
            found->vendor == nullptr || found->kinds == nullptr)
            throw disagrees("descriptor " + std::to_string(i) + " has a null text");
        if (found->id != manifest.id) continue;
        if (found->version != manifest.version)
            throw disagrees("descriptor says version '" + std::string(found->version) +
                            "', the manifest '" + manifest.version + "'");
        std::size_t kinds = 0;
        for (; found->kinds[kinds] != nullptr; ++kinds)
            if (!manifest.provides_kind(found->kinds[kinds]))
                throw disagrees("descriptor offers '" + std::string(found->kinds[kinds]) +
                                "', the manifest does not");
        if (kinds != manifest.provides.size())
            throw disagrees("descriptor offers " + std::to_string(kinds) + " kinds, the manifest " +
                            std::to_string(manifest.provides.size()));
        return found;
    }
    throw disagrees("the library describes no plugin '" + manifest.id + "'");
}

} // namespace

Plugin::Plugin(Manifest manifest, const toile_entry& entry)
    : manifest_(std::move(manifest)), entry_(&entry) {
    check_entry(entry, shown());
    init_entry(entry, manifest_, shown());
    try {
        descriptor_ = find_descriptor(entry, manifest_, shown());
    } catch (const PluginRefused&) {
        throw;
    } catch (...) {
        throw PluginRefused(Refusal::init_threw, shown(), "entry's describe threw an exception");
    }
}

std::shared_ptr<const Plugin> Plugin::load(Manifest manifest) {
    const toile_entry& entry = open_library(manifest);
    return std::shared_ptr<const Plugin>(new Plugin(std::move(manifest), entry));
}

std::shared_ptr<const Plugin> Plugin::link(const toile_entry& entry, Manifest manifest) {
    return std::shared_ptr<const Plugin>(new Plugin(std::move(manifest), entry));
}

std::string Plugin::shown() const {
    return manifest_.file.empty() ? manifest_.id : manifest_.file.string();
}

} // namespace toile::host
