#include "apps/plugin_limits.h"

#include "host/views.h"

namespace toile::apps {

host::RegistryOptions registry_options(const GlobalOptions& global) {
    host::RegistryOptions out;
    out.folders = global.plugin_folders;
    return out;
}

toile_limits limits_of(const GlobalOptions& global, const host::Services& services,
                       const Capacity& capacity, bool live_clock) {
    auto out = host::sized<toile_limits>();
    out.max_people = capacity.people;
    out.max_vertices = capacity.vertices;
    out.max_triangles = capacity.triangles;
    out.thread_count = services.thread_count();
    out.live_clock = live_clock ? 1 : 0;
    out.frame_budget_s = 1.0 / 30.0;
    out.random_seed = global.seed;
    return out;
}

} // namespace toile::apps
