#include "host/instance.h"

#include <algorithm>
#include <cstring>

namespace toile::host {
namespace {

constexpr std::size_t kHeaderBytes = 2 * sizeof(std::uint32_t);

std::string with_text(const std::string& what, const std::string& text) {
    return text.empty() ? what : what + ": " + text;
}

} // namespace

Instance::Instance(std::shared_ptr<const Plugin> plugin, Services& services)
    : plugin_(std::move(plugin)), host_(services, plugin_->id()) {
    create();
    try {
        for (const std::string& kind : plugin_->manifest().provides)
            if (find(kind.c_str()) == nullptr)
                throw PluginRefused(Refusal::kind_missing, plugin_->shown(),
                                    "the instance does not offer '" + kind + "'");
    } catch (...) {
        (void)frame([](toile_instance* i) { return i->destroy(i), TOILE_OK; });
        throw;
    }
}

Instance::~Instance() {
    deactivate();
    (void)frame([](toile_instance* i) { return i->destroy(i), TOILE_OK; });
}

void Instance::create() {
    const std::string shown = plugin_->shown();
    try {
        instance_ = plugin_->entry().create(host_.handle(), plugin_->id().c_str());
    } catch (...) {
        throw PluginRefused(Refusal::init_threw, shown, "create threw an exception");
    }
    if (instance_ == nullptr)
        throw PluginRefused(Refusal::create_failed, shown,
                            with_text("create gave no instance", host_.take_error()));
    if (instance_->size < sizeof(toile_instance))
        throw PluginRefused(Refusal::instance_short, shown,
                            "instance has " + std::to_string(instance_->size) +
                                " bytes, at least " + std::to_string(sizeof(toile_instance)) +
                                " wanted");
    const toile_instance& i = *instance_;
    const char* missing = i.init == nullptr            ? "init"
                          : i.activate == nullptr      ? "activate"
                          : i.deactivate == nullptr    ? "deactivate"
                          : i.reset == nullptr         ? "reset"
                          : i.destroy == nullptr       ? "destroy"
                          : i.get_extension == nullptr ? "get_extension"
                                                       : nullptr;
    if (missing != nullptr)
        throw PluginRefused(Refusal::instance_incomplete, shown,
                            std::string("instance lacks '") + missing + "'");
    toile_status status = TOILE_OK;
    bool threw_in_init = false;
    try {
        status = instance_->init(instance_);
    } catch (...) {
        threw_in_init = true;
    }
    if (!threw_in_init && status >= 0) return;
    const std::string text = host_.take_error();
    (void)frame([](toile_instance* instance) { return instance->destroy(instance), TOILE_OK; });
    if (threw_in_init) throw PluginRefused(Refusal::init_threw, shown, "init threw an exception");
    throw PluginRefused(Refusal::init_failed, shown,
                        with_text("init failed with " + status_text(status), text));
}

const void* Instance::find(const char* id) {
    if (const auto found = tables_.find(id); found != tables_.end()) return found->second.data();
    const KindInfo* kind = find_kind(id);
    const void* table = nullptr;
    try {
        table = instance_->get_extension(instance_, id);
    } catch (...) {
        throw PluginRefused(Refusal::call_threw, plugin_->shown(),
                            "get_extension threw an exception");
    }
    if (kind == nullptr || table == nullptr) return nullptr;
    fetch_table(*kind, table);
    return tables_.at(id).data();
}

const void* Instance::require(const char* id) {
    const void* table = find(id);
    if (table == nullptr) throw Error(this->id() + ": does not offer '" + id + "'");
    return table;
}

void Instance::fetch_table(const KindInfo& kind, const void* table) {
    std::uint32_t size = 0;
    std::memcpy(&size, table, sizeof(size));
    if (size < kind.base_size)
        throw PluginRefused(Refusal::table_short, plugin_->shown(),
                            std::string("table of '") + kind.id + "' has " + std::to_string(size) +
                                " bytes, at least " + std::to_string(kind.base_size) + " wanted");
    std::vector<void*> copy(kind.size / sizeof(void*));
    std::memcpy(copy.data(), table, std::min(size, kind.size));
    for (std::size_t call = 0; call < (kind.base_size - kHeaderBytes) / sizeof(void*); ++call)
        if (copy[call + kHeaderBytes / sizeof(void*)] == nullptr)
            throw PluginRefused(Refusal::call_missing, plugin_->shown(),
                                std::string("table of '") + kind.id + "' lacks the call '" +
                                    kind.calls[call] + "'");
    tables_.emplace(kind.id, std::move(copy));
}

void Instance::activate(const toile_limits& limits) {
    deactivate();
    call("activate", [&](toile_instance* i) { return i->activate(i, &limits); });
    active_ = true;
}

void Instance::deactivate() noexcept {
    if (!active_) return;
    active_ = false;
    (void)frame([](toile_instance* i) { return i->deactivate(i), TOILE_OK; });
}

void Instance::reset() noexcept {
    (void)frame([](toile_instance* i) { return i->reset(i), TOILE_OK; });
}

toile_status Instance::checked(toile_status status, const char* what) {
    if (status == TOILE_CANCELLED) throw Cancelled(id() + ": " + what + ": cancelled");
    if (status >= 0) return status;
    std::string text = take_error();
    if (text.empty()) text = "failed with " + status_text(status);
    throw Error(id() + ": " + what + ": " + text);
}

Error Instance::threw(const char* what) const {
    return Error(id() + ": " + what + ": threw an exception across the boundary");
}

} // namespace toile::host
