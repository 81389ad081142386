#include "pipeline/frame_source.h"

#include "core/error.h"
#include "host/instance.h"
#include "pipeline/people_source.h"

namespace toile::pipeline {
namespace {

// A body source that reads its own recording; gives the first person it sees.
class PluginSource : public FrameSource {
  public:
    PluginSource(std::shared_ptr<const host::Plugin> plugin, host::Services& services,
                 const std::string& path, const BoundaryBody& body, const toile_limits& limits,
                 host::Job& job)
        : instance_(std::move(plugin), services), table_(instance_.table<toile_body_source>()) {
        instance_.activate(limits);
        auto setup = host::sized<toile_body_source_setup>();
        setup.uri = path.c_str();
        setup.body = &body.abi();
        setup.max_people = 1;
        instance_.call("begin", [&](toile_instance* instance) {
            return table_.begin(instance, &setup, job.handle());
        });
    }
    ~PluginSource() override {
        instance_.frame([&](toile_instance* instance) {
            table_.end(instance);
            return TOILE_OK;
        });
    }
    PluginSource(const PluginSource&) = delete;
    PluginSource& operator=(const PluginSource&) = delete;

    toile_status next(BodyFrame& out) noexcept override {
        const auto nothing = host::sized<toile_body_source_input>();
        const toile_status fed = instance_.frame(
            [&](toile_instance* instance) { return table_.feed(instance, &nothing); });
        return fed == TOILE_OK ? read_person(out) : fed;
    }
    std::string error() override {
        const std::string reported = instance_.take_error();
        return instance_.id() + ": " + (reported.empty() ? broken_ : reported);
    }

  private:
    toile_status read_person(BodyFrame& out) noexcept {
        auto person = host::sized<toile_person>();
        person.state.size = sizeof(person.state);
        person.joints = host::view_mut(out.joints);
        std::uint32_t count = 1;
        const toile_status status = instance_.frame(
            [&](toile_instance* instance) { return table_.result(instance, &person, &count); });
        if (status != TOILE_OK) return status;
        if (count == 0) return TOILE_NO_NEW_DATA;
        if (!plausible(out.joints)) {
            broken_ = "gave joints that are not finite";
            return TOILE_E_NUMERIC;
        }
        out.person_id = person.state.person_id;
        out.tracking = person.state.tracking;
        out.sequence = person.state.sequence;
        out.timestamp_ns = person.state.timestamp_ns;
        return TOILE_OK;
    }

    host::Instance instance_;
    const toile_body_source& table_;
    std::string broken_ = "failed without telling why";
};

/// A sensor's pictures through the tracker; gives the person who was seen first.
class TrackedSource : public FrameSource {
  public:
    TrackedSource(const std::string& uri, host::Registry& registry, host::Services& services,
                  const BoundaryBody& body, const toile_limits& limits, host::Job& job)
        : people_(uri, registry, services, limits, {1, &body, true, {}}, job) {}

    toile_status next(BodyFrame& out) noexcept override {
        try {
            if (people_.ended()) return TOILE_END_OF_STREAM;
            if (!people_.next(frame_))
                return people_.ended() ? TOILE_END_OF_STREAM : TOILE_NO_NEW_DATA;
        } catch (const std::exception& e) {
            error_ = e.what();
            return TOILE_E_INTERNAL;
        }
        if (frame_.people.empty() || frame_.people.front().tracking == TOILE_TRACKING_LOST)
            return TOILE_NO_NEW_DATA;
        out = frame_.people.front();
        return TOILE_OK;
    }
    std::string error() override { return error_; }

  private:
    PeopleSource people_;
    PeopleFrame frame_;
    std::string error_;
};

} // namespace

std::unique_ptr<FrameSource> open_source(const std::string& uri, host::Registry& registry,
                                         host::Services& services, const BoundaryBody& body,
                                         const toile_limits& limits, host::Job& job) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string::npos || colon == 0)
        throw UsageError("source '" + uri + "' has no scheme; write for example kinect-log:FILE");
    auto plugin = registry.find_scheme(uri.substr(0, colon));
    if (plugin->manifest().provides_kind(TOILE_SENSOR))
        return std::make_unique<TrackedSource>(uri, registry, services, body, limits, job);
    return std::make_unique<PluginSource>(std::move(plugin), services, uri.substr(colon + 1), body,
                                          limits, job);
}

} // namespace toile::pipeline
