// How large a run's plugins must be ready to work.
#pragma once

#include "abi/plugin.h"
#include "apps/global_options.h"
#include "host/registry.h"
#include "host/services.h"

namespace toile::apps {

/// The most that one surface, or one picture, may hold.
struct Capacity {
    std::uint32_t people = 1;
    std::uint32_t vertices = 0;
    std::uint32_t triangles = 0;
};

constexpr Capacity kDressedPerson{1, 200'000, 400'000};
constexpr Capacity kScannedPerson{1, 2'000'000, 4'000'000};
constexpr Capacity kSensedScene{16, 2'000'000, 4'000'000};

/// Where every command looks for plugins.
[[nodiscard]] host::RegistryOptions registry_options(const GlobalOptions& global);

/// What every command gives its plugins: these sizes, the run's threads and seed, and on a live
/// clock (frames that come late are dropped) a thirtieth of a second for a frame.
[[nodiscard]] toile_limits limits_of(const GlobalOptions& global, const host::Services& services,
                                     const Capacity& capacity, bool live_clock = false);

} // namespace toile::apps
