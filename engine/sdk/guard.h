// The wall between a plugin's C++ and the boundary: nothing thrown passes it.
#pragma once

#include "abi/plugin.h"
#include "sdk/failure.h"
#include "sdk/host.h"

#include <new>
#include <optional>
#include <type_traits>

namespace toile::sdk {

/// What stands behind a toile_instance: P is constructed by init, since the host may not be
/// called before.
template <class P>
struct Holder {
    toile_instance instance;
    const toile_host* host;
    std::optional<P> plugin;

    static Holder& of(toile_instance* instance) noexcept {
        return *static_cast<Holder*>(instance->plugin_data);
    }
};

/// Runs `work` and turns whatever it throws into a status; the text goes to host->report.
/// `work` returns nothing (TOILE_OK) or a status.
template <class Work>
toile_status guarded(const toile_host* host, const Work& work) noexcept {
    const auto fail = [&](toile_status status, const char* text) noexcept {
        if (host != nullptr && status != TOILE_CANCELLED)
            host->report(host, TOILE_LOG_ERROR, status, text);
        return status;
    };
    try {
        if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
            work();
            return TOILE_OK;
        } else {
            return work();
        }
    } catch (const Failure& e) {
        return fail(e.status(), e.what());
    } catch (const std::bad_alloc&) {
        return fail(TOILE_E_CAPACITY, "out of memory");
    } catch (const std::exception& e) {
        return fail(TOILE_E_INTERNAL, e.what());
    } catch (...) {
        return fail(TOILE_E_INTERNAL, "threw something that is not a std::exception");
    }
}

/// The same for a call on an instance: work(plugin).
template <class P, class Work>
toile_status guarded(toile_instance* instance, const Work& work) noexcept {
    if (instance == nullptr || instance->plugin_data == nullptr) return TOILE_E_ARGUMENT;
    Holder<P>& holder = Holder<P>::of(instance);
    return guarded(holder.host, [&] {
        if (!holder.plugin) throw bad_argument("called before init");
        return work(*holder.plugin);
    });
}

} // namespace toile::sdk
