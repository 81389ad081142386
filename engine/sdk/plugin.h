// From a class to the boundary: descriptor, lifecycle, kinds and the entry that a library exports.
//
//     class Skin {
//       public:
//         static constexpr toile::sdk::Info info{.id = "acme.skin", .name = "Skin",
//                                                .version = "1.0.0", .vendor = "Acme"};
//         using Kinds = toile::sdk::Kinds<toile::sdk::Skinning>;
//         explicit Skin(toile::sdk::Host host);          // [main] init; may throw
//         void activate(const toile_limits& limits);     // optional, and so are
//         void deactivate(); void reset();               // these
//         ...                                            // the calls of its kinds, see skinning.h
//     };
//     TOILE_PLUGIN(skin, Skin)
#pragma once

#include "sdk/guard.h"
#include "sdk/structs.h"

#include <array>
#include <cstring>
#include <string>
#include <string_view>

namespace toile::sdk {

/// All must agree with plugin.json.
struct Info {
    const char* id;
    const char* name;
    const char* version;
    const char* vendor;
};

/// The kinds (and extensions) a class offers: each has `id` and `table<P>`.
template <class... K>
struct Kinds {
    static constexpr std::array<const char*, sizeof...(K) + 1> ids{K::id..., nullptr};

    template <class P>
    static const void* find(std::string_view id) noexcept {
        const void* found = nullptr;
        (void)((id == K::id && (found = &K::template table<P>, true)) || ...);
        return found;
    }
};

/// Extensions beside the kinds, e.g. `using Extensions = Kinds<Parameters>;`, not in plugin.json.
template <class P>
const void* find_extension(std::string_view id) noexcept {
    if (const void* kind = P::Kinds::template find<P>(id)) return kind;
    if constexpr (requires { typename P::Extensions; }) return P::Extensions::template find<P>(id);
    return nullptr;
}

template <class P>
inline constexpr toile_descriptor descriptor_of{
    sizeof(toile_descriptor), 0, P::info.id, P::info.name, P::info.version, P::info.vendor,
    P::Kinds::ids.data()};

/// Lifecycle of one class as the boundary wants it.
template <class P>
struct Lifecycle {
    static toile_instance* create(const toile_host* host) noexcept {
        auto* holder = new (std::nothrow) Holder<P>{};
        if (holder == nullptr) return nullptr;
        holder->host = host;
        holder->instance = {sizeof(toile_instance),
                            0,
                            &descriptor_of<P>,
                            holder,
                            &init,
                            &activate,
                            &deactivate,
                            &reset,
                            &destroy,
                            &get_extension};
        return &holder->instance;
    }

  private:
    static toile_status init(toile_instance* instance) noexcept {
        Holder<P>& holder = Holder<P>::of(instance);
        return guarded(holder.host, [&] { holder.plugin.emplace(Host(holder.host)); });
    }
    static toile_status activate(toile_instance* instance, const toile_limits* limits) noexcept {
        return guarded<P>(instance, [&](P& plugin) {
            const toile_limits known = read_struct(limits, "limits");
            if constexpr (requires { plugin.activate(known); }) plugin.activate(known);
        });
    }
    static void deactivate(toile_instance* instance) noexcept {
        (void)guarded<P>(instance, [](P& plugin) {
            if constexpr (requires { plugin.deactivate(); }) plugin.deactivate();
        });
    }
    static void reset(toile_instance* instance) noexcept {
        (void)guarded<P>(instance, [](P& plugin) {
            if constexpr (requires { plugin.reset(); }) plugin.reset();
        });
    }
    static void destroy(toile_instance* instance) noexcept {
        if (instance != nullptr) delete &Holder<P>::of(instance);
    }
    static const void* get_extension(toile_instance*, const char* id) noexcept {
        return id == nullptr ? nullptr : find_extension<P>(id);
    }
};

/// Folder of this library, where its data stand: told once, when it is opened, and the same for all
/// of its instances. Empty when it is linked in (tests). [any thread]
inline std::string& library_folder() noexcept {
    static std::string folder;
    return folder;
}

/// The entry of a library that holds these classes.
template <class... P>
struct Entry {
    static_assert(sizeof...(P) > 0);
    static toile_status init(const char* folder) noexcept {
        return guarded(nullptr, [&] { library_folder() = folder == nullptr ? "" : folder; });
    }
    static void deinit() noexcept {}
    static std::uint32_t count() noexcept { return sizeof...(P); }
    static const toile_descriptor* describe(std::uint32_t index) noexcept {
        constexpr std::array<const toile_descriptor*, sizeof...(P)> all{&descriptor_of<P>...};
        return index < all.size() ? all[index] : nullptr;
    }
    static toile_instance* create(const toile_host* host, const char* id) noexcept {
        if (id == nullptr) return nullptr;
        toile_instance* made = nullptr;
        (void)((std::string_view(id) == P::info.id && (made = Lifecycle<P>::create(host), true)) ||
               ...);
        return made;
    }
    static constexpr toile_entry value{
        sizeof(toile_entry), TOILE_ABI_MAJOR, TOILE_ABI_MINOR, 0, &init, &deinit, &count,
        &describe,           &create};
};

} // namespace toile::sdk

/// TOILE_PLUGIN(name, Class...): the symbol that the host looks for. With TOILE_STATIC_PLUGIN
/// defined it is toile_plugin_entry_<name> instead, so that several can be linked into one test.
#ifdef TOILE_STATIC_PLUGIN
#define TOILE_PLUGIN(name, ...)                                                                    \
    extern "C" const toile_entry toile_plugin_entry_##name;                                        \
    extern "C" const toile_entry toile_plugin_entry_##name = toile::sdk::Entry<__VA_ARGS__>::value;
#else
#define TOILE_PLUGIN(name, ...)                                                                    \
    extern "C" TOILE_EXPORT const toile_entry toile_plugin_entry;                                  \
    extern "C" TOILE_EXPORT const toile_entry toile_plugin_entry =                                 \
        toile::sdk::Entry<__VA_ARGS__>::value;
#endif
