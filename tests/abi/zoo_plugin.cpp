// A plugin that can be wrong in every way: which animal it is stands in its folder's name
// (zoo_test.cpp copies the library). Written against the C headers alone, without the SDK.
#include "abi/skinning.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <limits>
#include <unistd.h>
#include <vector>

namespace {

char animal[64]; // filled by the first static constructor

bool is(const char* name) {
    return std::strcmp(animal, name) == 0;
}

[[noreturn]] void hang() {
    for (;;)
        pause();
}

void crash() {
    std::raise(SIGSEGV);
}

const toile_host* host = nullptr;

/// One instance: positions and normals of the body that it was bound to.
struct Animal {
    toile_instance instance;
    std::vector<float> positions, normals;

    static Animal& of(toile_instance* i) { return *static_cast<Animal*>(i->plugin_data); }
};

toile_status fail(toile_status status, const char* text) {
    if (!is("fails_silently")) host->report(host, TOILE_LOG_ERROR, status, text);
    return status;
}

const char* const kinds[] = {TOILE_SKINNING, nullptr};
const char* const other_kinds[] = {"toile.cloth/1", nullptr};
toile_descriptor descriptor{
    sizeof(toile_descriptor), 0, "zoo.animal", "Animal", "1.0.0", "Zoo", kinds};

toile_status bind(toile_instance* i, const toile_body* body, toile_job*) {
    if (is("bind_fails")) return fail(TOILE_E_IO, "the weights file is gone");
    if (is("bind_hangs")) hang();
    if (body == nullptr) return fail(TOILE_E_ARGUMENT, "no body");
    const auto* p = static_cast<const float*>(body->rest.positions.data);
    const auto* n = static_cast<const float*>(body->rest.normals.data);
    Animal::of(i).positions.assign(p, p + 3 * body->rest.positions.count);
    Animal::of(i).normals.assign(n, n + 3 * body->rest.normals.count);
    return TOILE_OK;
}

// Good enough for the control: all joints move as one, turned about y.
void turn(const float* rotation, const float* in, float* out) {
    const float s = 2 * rotation[1] * rotation[3];
    const float c = 1 - 2 * rotation[1] * rotation[1];
    const float x = in[0];
    out[0] = c * x + s * in[2];
    out[1] = in[1];
    out[2] = -s * x + c * in[2];
}

toile_status pose(toile_instance* i, const toile_body_state* state, toile_view_mut positions,
                  toile_view_mut normals) {
    if (is("pose_crashes")) crash();
    if (is("pose_hangs")) hang();
    if (is("pose_aborts")) std::abort();
    if (is("pose_exits")) _exit(0);
    if (is("pose_throws")) throw 1;
    const Animal& self = Animal::of(i);
    if (positions.count == 0 || positions.count != self.positions.size() / 3 ||
        state->joints.count != TOILE_JOINT_COUNT)
        return fail(TOILE_E_ARGUMENT, "not bound, or wrong counts");
    const auto& hips = *static_cast<const toile_joint*>(state->joints.data);
    const float move[3] = {hips.position[0], hips.position[1] - 0.92f, hips.position[2]};
    auto* p = static_cast<float*>(positions.data);
    auto* n = static_cast<float*>(normals.data);
    for (uint32_t v = 0; v < positions.count; ++v) {
        turn(hips.rotation, &self.positions[3 * v], p + 3 * v);
        turn(hips.rotation, &self.normals[3 * v], n + 3 * v);
        for (uint32_t k = 0; k < 3; ++k)
            p[3 * v + k] += move[k];
    }
    if (is("pose_nan")) p[7] = std::numeric_limits<float>::quiet_NaN();
    if (is("pose_overflows")) p[3 * positions.count] = 0;
    if (is("pose_wrong")) p[0] += 1;
    return TOILE_OK;
}

toile_skinning table{sizeof(toile_skinning), 0, &bind, &pose};

toile_status instance_init(toile_instance*) {
    if (is("init_fails")) return fail(TOILE_E_DEVICE, "no licence for this shop");
    if (is("init_throws")) throw 1;
    if (is("init_hangs")) hang();
    if (is("init_aborts")) std::abort();
    if (is("init_exits")) _exit(0);
    if (is("init_crashes")) crash();
    return TOILE_OK;
}

void destroy(toile_instance* i) {
    delete &Animal::of(i);
}

toile_instance prototype{sizeof(toile_instance),
                         0,
                         &descriptor,
                         nullptr,
                         &instance_init,
                         [](toile_instance*, const toile_limits*) -> toile_status { return 0; },
                         [](toile_instance*) {},
                         [](toile_instance*) {},
                         &destroy,
                         [](toile_instance*, const char* id) -> const void* {
                             if (std::strcmp(id, TOILE_SKINNING) != 0) return nullptr;
                             return is("kind_missing") ? nullptr : &table;
                         }};
Animal* volatile newest = nullptr; // keeps one that the host may not destroy reachable

toile_instance* create(const toile_host* by, const char* id) {
    if (std::strcmp(id, descriptor.id) != 0) return nullptr;
    host = by;
    if (is("create_fails")) return nullptr;
    auto* made = new Animal{prototype, {}, {}};
    made->instance.plugin_data = made;
    newest = made;
    return &made->instance;
}

toile_status entry_init(const char*) {
    if (is("entry_init_throws")) throw 1;
    if (is("entry_init_exits")) std::exit(0);
    return is("entry_init_fails") ? TOILE_E_IO : TOILE_OK;
}

void entry_deinit() {
    if (is("deinit_crashes")) crash();
}

} // namespace

extern "C" TOILE_EXPORT toile_entry toile_plugin_entry;
toile_entry toile_plugin_entry{
    sizeof(toile_entry),
    TOILE_ABI_MAJOR,
    TOILE_ABI_MINOR,
    0,
    &entry_init,
    &entry_deinit,
    [] { return uint32_t{1}; },
    [](uint32_t i) -> const toile_descriptor* { return i == 0 ? &descriptor : nullptr; },
    &create};

namespace {

[[gnu::constructor]] void choose_animal() {
    Dl_info info{};
    if (dladdr(&toile_plugin_entry, &info) == 0) return;
    const char* end = std::strrchr(info.dli_fname, '/');
    const char* begin = end;
    while (begin > info.dli_fname && begin[-1] != '/')
        --begin;
    std::strncpy(animal, begin,
                 std::min<std::size_t>(sizeof(animal) - 1, static_cast<std::size_t>(end - begin)));
    if (is("constructor_crashes")) crash();
    if (is("constructor_hangs")) hang();
    if (is("constructor_throws")) throw 1;
    if (is("entry_short")) toile_plugin_entry.size = 16;
    if (is("entry_abi_major")) toile_plugin_entry.abi_major = 2;
    if (is("entry_abi_newer")) toile_plugin_entry.abi_minor = 7;
    if (is("entry_incomplete")) toile_plugin_entry.describe = nullptr;
    if (is("descriptor_short")) descriptor.size = 8;
    if (is("descriptor_id")) descriptor.id = "zoo.somebody_else";
    if (is("descriptor_version")) descriptor.version = "9.9.9";
    if (is("descriptor_kinds")) descriptor.kinds = other_kinds;
    if (is("instance_short")) prototype.size = 16;
    if (is("instance_incomplete")) prototype.reset = nullptr;
    if (is("table_short")) table.size = 16;
    if (is("call_missing")) table.pose = nullptr;
}

} // namespace
