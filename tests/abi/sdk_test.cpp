// The SDK: what it lets through the boundary and what it stops; two plugins linked into one test.
#define TOILE_STATIC_PLUGIN
#include "host/instance.h"
#include "host/registry.h"
#include "sdk/sdk.h"

#include <gmock/gmock.h>

namespace {

namespace sdk = toile::sdk;

/// Throws what its body's revision says.
class Thrower {
  public:
    static constexpr sdk::Info info{
        .id = "test.thrower", .name = "Thrower", .version = "1.0.0", .vendor = "Test"};
    using Kinds = sdk::Kinds<sdk::Skinning>;

    explicit Thrower(sdk::Host host) : pool_(host) {}

    void bind(const toile_body& body, sdk::Job job) {
        switch (body.revision) {
        case 1:
            throw sdk::Failure(TOILE_E_IO, "file.bin: is gone");
        case 2:
            throw std::bad_alloc();
        case 3:
            throw std::runtime_error("went wrong");
        case 4:
            throw 4;
        case 5:
            job.progress(0.5);
            break;
        case 6:
            pool_.parallel_for(100, 10, [](std::uint32_t begin, std::uint32_t) {
                if (begin >= 40) throw sdk::Failure(TOILE_E_NUMERIC, std::to_string(begin));
            });
            break;
        default:
            break;
        }
    }
    toile_status pose(const toile_body_state&, toile_view_mut, toile_view_mut) {
        return TOILE_NO_NEW_DATA;
    }

  private:
    sdk::ThreadPool pool_;
};

/// Offers parameters; fails to be made when told so.
class Tuned {
  public:
    static constexpr sdk::Info info{
        .id = "test.tuned", .name = "Tuned", .version = "1.0.0", .vendor = "Test"};
    using Kinds = sdk::Kinds<sdk::Tool>;
    using Extensions = sdk::Kinds<sdk::Parameters>;
    static constexpr std::array parameters{
        sdk::Parameter{"stiffness", TOILE_PARAMETER_REAL, "N/m", "How stiff", 0, 10, 5},
        sdk::Parameter{"substeps", TOILE_PARAMETER_INTEGER, "1", "How many", 1, 8, 4}};
    static inline bool broken = false;

    explicit Tuned(sdk::Host) {
        if (broken) throw std::runtime_error("no table in my folder");
    }
    double& parameter(std::size_t i) { return values_[i]; }
    toile_tool_info describe_tool() {
        static const toile_tool_option pitch{sizeof(toile_tool_option),
                                             TOILE_OPTION_REAL,
                                             TOILE_OPTION_REPEATED,
                                             0,
                                             "pitch",
                                             "HZ",
                                             "To what",
                                             "440",
                                             1,
                                             1000};
        return {0, 1, "tune", "Tunes", "toile tune --pitch 440", &pitch};
    }
    void run_tool(const sdk::ToolArguments& arguments, sdk::Job job) {
        pitches = arguments.values("pitch");
        last = arguments.number("pitch", 440.0);
        job.progress(1.0, "tuned");
    }
    static inline std::vector<std::string> pitches;
    static inline double last = 0.0;

  private:
    std::array<double, 2> values_{5, 4};
};

} // namespace

TOILE_PLUGIN(thrower, Thrower)
TOILE_PLUGIN(tuned, Tuned)

namespace toile::host {
namespace {

Manifest manifest_for(const toile_descriptor& d) {
    Manifest out;
    out.id = d.id;
    out.version = d.version;
    for (auto kind = d.kinds; *kind != nullptr; ++kind)
        out.provides.emplace_back(*kind);
    return out;
}

std::shared_ptr<const Plugin> linked(const toile_entry& entry) {
    return Plugin::link(entry, manifest_for(*entry.describe(0)));
}

std::string bind_error(std::uint64_t revision, Job* job = nullptr) {
    Services services(2);
    Instance instance(linked(toile_plugin_entry_thrower), services);
    toile_body body{};
    body.size = sizeof(body);
    body.revision = revision;
    try {
        instance.call("bind", [&](auto* i) {
            return instance.table<toile_skinning>().bind(i, &body,
                                                         job == nullptr ? nullptr : job->handle());
        });
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(Sdk, EverythingThrownBecomesAStatusAndAText) {
    EXPECT_EQ(bind_error(0), "");
    EXPECT_EQ(bind_error(1), "test.thrower: bind: file.bin: is gone");
    EXPECT_EQ(bind_error(2), "test.thrower: bind: out of memory");
    EXPECT_EQ(bind_error(3), "test.thrower: bind: went wrong");
    EXPECT_EQ(bind_error(4), "test.thrower: bind: threw something that is not a std::exception");
    EXPECT_EQ(bind_error(5), "") << "a null job is nobody watching";
    Job job;
    job.cancel();
    EXPECT_EQ(bind_error(5, &job), "test.thrower: bind: cancelled");
    EXPECT_EQ(bind_error(6), "test.thrower: bind: 40") << "of several, the lowest range's";
}

TEST(Sdk, StatusesAndStructSizesPassThrough) {
    Services services(1);
    Instance instance(linked(toile_plugin_entry_thrower), services);
    const auto& table = instance.table<toile_skinning>();
    toile_body_state state{};
    EXPECT_EQ(table.pose(instance.handle(), &state, {}, {}), TOILE_E_ARGUMENT) << "no size";
    EXPECT_EQ(instance.take_error(), "state: no size");
    state.size = sizeof(state);
    EXPECT_EQ(table.pose(instance.handle(), &state, {}, {}), TOILE_NO_NEW_DATA);
    EXPECT_EQ(table.pose(nullptr, &state, {}, {}), TOILE_E_ARGUMENT);
    EXPECT_EQ(table.bind(instance.handle(), nullptr, nullptr), TOILE_E_ARGUMENT);
    EXPECT_EQ(instance.take_error(), "body: null");
}

TEST(Sdk, ParametersKeepTheirRanges) {
    Services services(1);
    Instance instance(linked(toile_plugin_entry_tuned), services);
    const auto& table = *instance.find<toile_parameters>();
    toile_instance* i = instance.handle();
    double value = 0;
    EXPECT_EQ(table.count(i), 2u);
    EXPECT_EQ(table.set(i, "stiffness", 7.5), TOILE_OK);
    EXPECT_EQ(table.get(i, "stiffness", &value), TOILE_OK);
    EXPECT_EQ(value, 7.5);
    for (const double bad : {-1.0, 11.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_EQ(table.set(i, "stiffness", bad), TOILE_E_ARGUMENT) << bad;
    EXPECT_EQ(table.set(i, "substeps", 2.5), TOILE_E_ARGUMENT);
    EXPECT_EQ(table.set(i, "nothing", 1), TOILE_E_ARGUMENT);
    EXPECT_EQ(instance.take_error(), "nothing: no such parameter");
}

TEST(Sdk, AConstructorThatThrowsIsAFailedInit) {
    Services services(1);
    Tuned::broken = true;
    try {
        const Instance instance(linked(toile_plugin_entry_tuned), services);
        ADD_FAILURE() << "made";
    } catch (const PluginRefused& e) {
        EXPECT_EQ(e.reason(), Refusal::init_failed);
        EXPECT_STREQ(e.what(),
                     "test.tuned: init failed with TOILE_E_INTERNAL: no table in my folder");
    }
    Tuned::broken = false;
}

TEST(Sdk, ViewsAreCheckedBeforeTheyBecomeSpans) {
    std::vector<sdk::Float3> rows(4);
    toile_view view = sdk::view_of(std::span<const sdk::Float3>(rows));
    EXPECT_EQ(sdk::span_of<sdk::Float3>(view, "rows").size(), 4u);
    const auto error = [&](std::size_t count) -> std::string {
        try {
            (void)sdk::span_of<sdk::Float3>(view, "rows", count);
        } catch (const sdk::Failure& e) {
            EXPECT_EQ(e.status(), TOILE_E_ARGUMENT);
            return e.what();
        }
        return "";
    };
    EXPECT_EQ(error(4), "");
    EXPECT_EQ(error(5), "rows: 4 elements, 5 wanted");
    view.format = TOILE_F32X4;
    EXPECT_EQ(error(4), "rows: wrong element format");
    view = sdk::view_of(std::span<const sdk::Float3>(rows));
    view.stride = 16;
    EXPECT_EQ(error(4), "rows: elements are not packed");
    view = sdk::view_of(std::span<const sdk::Float3>(rows));
    view.data = nullptr;
    EXPECT_EQ(error(4), "rows: null data");
    view.data = reinterpret_cast<const char*>(rows.data()) + 1;
    EXPECT_EQ(error(4), "rows: data is not aligned");
    EXPECT_TRUE(sdk::span_of<sdk::Float3>(toile_view{}, "rows").empty());
}

TEST(Sdk, StructsOfOtherLengthsAreReadAndWrittenWithinTheirSize) {
    toile_limits limits{};
    limits.size = offsetof(toile_limits, frame_budget_s); // an older writer
    limits.thread_count = 3;
    limits.random_seed = 7; // beyond what it gave
    const toile_limits known = sdk::read_struct(&limits, "limits");
    EXPECT_EQ(known.thread_count, 3u);
    EXPECT_EQ(known.random_seed, 0u);
    toile_limits out{};
    out.size = offsetof(toile_limits, thread_count); // an older reader
    toile_limits value{};
    value.size = sizeof(value);
    value.max_people = 2;
    value.thread_count = 9;
    sdk::write_struct(&out, value, "out");
    EXPECT_EQ(out.size, offsetof(toile_limits, thread_count));
    EXPECT_EQ(out.max_people, 2u);
    EXPECT_EQ(out.thread_count, 0u);
    EXPECT_THROW((void)sdk::read_struct<toile_limits>(nullptr, "limits"), sdk::Failure);
}

TEST(Sdk, ArraysOfStructsStepByTheSizeOfTheirFirst) {
    struct Newer {
        toile_person known;
        double later;
    };
    std::vector<Newer> people(3);
    for (std::uint32_t k = 0; k < 3; ++k) {
        people[k].known.size = sizeof(Newer);
        people[k].known.has_new_body = k;
    }
    const sdk::SizedArray<toile_person> array(&people[0].known, 3, "people");
    for (std::uint32_t k = 0; k < 3; ++k)
        EXPECT_EQ(array[k].has_new_body, k);
    people[0].known.size = 16;
    EXPECT_THROW(sdk::SizedArray<toile_person>(&people[0].known, 3, "people"), sdk::Failure);
}

TEST(Sdk, ToolsGetTheirArguments) {
    Services services(1);
    Instance instance(linked(toile_plugin_entry_tuned), services);
    const auto run = [&](std::vector<const char*> words, Job* job = nullptr) {
        return instance.call("run", [&](auto* i) {
            return instance.table<toile_tool>().run(i, static_cast<std::int32_t>(words.size()),
                                                    words.data(), job ? job->handle() : nullptr);
        });
    };
    EXPECT_EQ(run({}), TOILE_OK);
    EXPECT_EQ(Tuned::last, 440.0);
    EXPECT_EQ(run({"--pitch", "432", "--pitch", "415.5"}), TOILE_OK);
    EXPECT_EQ(Tuned::pitches, (std::vector<std::string>{"432", "415.5"}));
    EXPECT_EQ(Tuned::last, 415.5);
    EXPECT_THROW(run({"--pitch", "high"}), Error);
    EXPECT_THROW(run({nullptr}), Error);
    Job stopped;
    stopped.cancel();
    EXPECT_THROW(run({}, &stopped), Cancelled);
}

TEST(Sdk, LinkedPluginsStandInARegistry) {
    Services services(1);
    Registry registry(services, {.environment = false, .beside_program = false});
    registry.add(toile_plugin_entry_tuned, manifest_for(*toile_plugin_entry_tuned.describe(0)));
    registry.add(toile_plugin_entry_thrower, manifest_for(*toile_plugin_entry_thrower.describe(0)));
    EXPECT_EQ(registry.find(TOILE_SKINNING)->id(), "test.thrower");
    EXPECT_EQ(registry.find(TOILE_TOOL)->id(), "test.tuned");
}

} // namespace
} // namespace toile::host
