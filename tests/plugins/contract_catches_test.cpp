// The rules can fail: a small plugin of three kinds keeps them all, and breaks one at a time.
#define TOILE_STATIC_PLUGIN
#include "host/contract.h"
#include "sdk/sdk.h"
#include "support/temporary_folder.h"

#include <cmath>
#include <fstream>
#include <gmock/gmock.h>
#include <limits>
#include <map>

namespace {

namespace sdk = toile::sdk;
using sdk::Float3;

std::string fault; // what the plugin below does wrong

bool is(const char* name) {
    return fault == name;
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
int calls = 0;

/// Garments follow the hips, cloth is where its targets are, the log has five frames, and so has
/// its one camera of two pixels.
class Puppet {
  public:
    static constexpr sdk::Info info{
        .id = "test.puppet", .name = "Puppet", .version = "1.0.0", .vendor = "Test"};
    using Kinds = sdk::Kinds<sdk::Garment, sdk::Cloth, sdk::BodySource, sdk::Sensor>;

    explicit Puppet(sdk::Host) {}

    // ---- garment
    void bind(const toile_body& body, const toile_garment_package& package, sdk::Job,
              const toile_garment_binding& out) {
        const auto from = sdk::span_of<Float3>(package.simulation.positions, "simulation");
        rest_.assign(from.begin(), from.end());
        if (is("bind moves")) rest_[3][1] += 1;
        hips_ = sdk::span_of<Float3>(body.rest_joints, "rest_joints", TOILE_JOINT_COUNT)[0];
        const auto positions = sdk::span_of<Float3>(out.positions, "positions", rest_.size());
        const auto joints = sdk::span_of<sdk::Index4>(out.joint_indices, "joints", rest_.size());
        const auto weights = sdk::span_of<sdk::Float4>(out.joint_weights, "weights", rest_.size());
        const auto attachment = sdk::span_of<float>(out.attachment, "attachment", rest_.size());
        for (std::size_t i = 0; i < rest_.size(); ++i) {
            positions[i] = rest_[i];
            joints[i] = {static_cast<std::uint16_t>(is("joint 22") ? 22 : 0), 0, 0, 0};
            weights[i] = {is("weights 0.5") ? 0.5f : 1.0f, 0, 0, 0};
            attachment[i] = is("attachment 2") ? 2.0f : 0.0f;
        }
        if (is("bind NaN")) positions[0][0] = kNan;
        if (is("bind leaves a row")) weights[5] = {kNan, kNan, kNan, kNan};
    }
    void targets(const toile_body_state& state, toile_view_mut positions) {
        const auto out = sdk::span_of<Float3>(positions, "positions", rest_.size());
        if (rest_.empty()) throw sdk::bad_argument("targets: called before bind");
        const auto joints = sdk::span_of<toile_joint>(state.joints, "joints", TOILE_JOINT_COUNT);
        const float* r = joints[0].rotation;
        const float s = is("targets stand still") ? 0 : 2 * r[1] * r[3];
        const float c = is("targets stand still") ? 1 : 1 - 2 * r[1] * r[1];
        for (std::size_t i = 0; i < out.size(); ++i) {
            const Float3 p{rest_[i][0] - hips_[0], rest_[i][1] - hips_[1], rest_[i][2] - hips_[2]};
            out[i] = {c * p[0] + s * p[2] + joints[0].position[0], p[1] + joints[0].position[1],
                      -s * p[0] + c * p[2] + joints[0].position[2]};
        }
        if (is("targets differ")) out[0][0] += 1e-6f * static_cast<float>(++calls);
    }

    // ---- cloth
    void set_body(const toile_body&, sdk::Job) {}
    std::uint32_t add_garment(const toile_cloth_garment& garment, sdk::Job) {
        if (is("handle 0")) return 0;
        if (!is("one handle")) ++last_;
        garments_[last_ == 0 ? 1 : last_] = garment.rest.positions.count;
        return last_ == 0 ? 1 : last_;
    }
    void remove_garment(std::uint32_t garment) {
        if (garments_.erase(garment) == 0 && !is("remove twice"))
            throw sdk::bad_argument("garment: no such garment");
    }
    void step(const toile_cloth_step& step) {
        const auto targets = sdk::targets_of(step);
        const auto states = sdk::states_of(step);
        for (std::uint32_t k = 0; k < states.size(); ++k) {
            const auto in = sdk::span_of<Float3>(targets[k].positions, "targets");
            const auto out = sdk::span_of<Float3>(states[k].positions, "positions", in.size());
            const auto normals = sdk::span_of<Float3>(states[k].normals, "normals", in.size());
            std::copy(in.begin(), in.end(), out.begin());
            std::fill(normals.begin(), normals.end(), Float3{0, 1, 0});
            if (is("cloth NaN")) out[1][1] = kNan;
            if (is("normals left out")) normals[2] = {kNan, 0, 0};
            if (is("pins slip")) out[0][1] -= 0.01f;
            if (is("cloth flies")) out[300][1] += 2;
            if (is("reset ignored") && (step.flags & TOILE_STEP_RESET) == 0) stray_ = true;
            if (stray_) out[300][0] += 0.2f;
            if (is("cloth overruns")) (out.data() + out.size())[0][0] = 1;
        }
    }

    // ---- body source
    toile_body_source_info describe() {
        static constexpr const char* schemes[] = {"puppet", nullptr};
        static constexpr const char* others[] = {"marionette", nullptr};
        return {sizeof(toile_body_source_info), TOILE_SOURCE_OWN,
                is("other schemes") ? others : schemes};
    }
    void begin(const toile_body_source_setup& setup, sdk::Job) {
        std::ifstream in(setup.uri == nullptr ? "" : setup.uri);
        std::string word;
        in >> word;
        if (word != "puppet" && !is("any file")) throw sdk::Failure(TOILE_E_IO, "not a puppet log");
        frame_ = 0;
    }
    toile_status feed(const toile_body_source_input&) {
        if (frame_ == 5) {
            if (is("goes on")) frame_ = 4;
            return is("goes on") ? TOILE_NO_NEW_DATA : TOILE_END_OF_STREAM;
        }
        ++frame_;
        return TOILE_OK;
    }
    std::uint32_t result(const sdk::SizedArray<toile_person>& people) {
        if (people.size() == 0) return 0;
        if (is("nobody")) return 0;
        toile_person& person = people[0];
        person.state.person_id = is("person 0") ? 0 : 1;
        person.state.tracking = is("tracking 9") ? 9 : TOILE_TRACKING_TRACKED;
        person.state.timestamp_ns = (is("time runs back") ? -frame_ : frame_) * 1000;
        for (toile_joint& joint : sdk::span_of<toile_joint>(person.joints, "joints")) {
            joint = {};
            joint.rotation[3] = is("rotation 2") ? 2.0f : 1.0f;
            joint.position[0] = is("joint NaN") ? kNan : 0.1f * static_cast<float>(frame_);
            if (is("source differs")) joint.position[1] = static_cast<float>(++calls);
        }
        return is("too many") ? 2 : 1;
    }
    void end() {}

    // ---- sensor
    void open(const char* uri, sdk::Job) {
        std::ifstream in(uri);
        std::string word;
        in >> word;
        if (word != "puppet" && !is("any recording"))
            throw sdk::Failure(TOILE_E_IO, "not a puppet recording");
        open_ = true;
        reset();
    }
    void reset() {
        if (!is("reset forgotten") || !seen_all_) polled_ = 0;
    }
    std::uint32_t stream_count() { return is("no cameras") ? 0 : 1; }
    toile_stream describe(std::uint32_t stream) {
        check_open(stream);
        toile_stream out{};
        out.depth = {2, 1, is("no focal length") ? 0.0 : 1.0, 1.0, 0.5, 0.0, {}};
        out.frame_period_s = 0.1;
        for (int k = 0; k < 4; ++k)
            out.world_from_camera[5 * k] = is("bent pose") ? 2.0 : 1.0;
        out.has_world = 1;
        return out;
    }
    toile_status poll(std::uint32_t stream, toile_frame& out) {
        check_open(stream);
        if (polled_ == 5) {
            seen_all_ = true;
            return is("camera goes on") ? TOILE_NO_NEW_DATA : TOILE_END_OF_STREAM;
        }
        out.sequence = is("sequence stays") ? 1 : polled_;
        out.timestamp_ns = is("camera time runs back") ? -polled_ : polled_;
        ++polled_;
        depth_ = {1.0f, is("depth 0") ? 0.0f : kNan};
        if (is("camera differs")) depth_[0] += static_cast<float>(++calls);
        out.depth_m = sdk::view_of<float>(depth_);
        if (is("pixel missing")) out.depth_m.count = 1;
        return TOILE_OK;
    }
    void release(const toile_frame&) {}

  private:
    void check_open(std::uint32_t stream) const {
        if (!open_ && !is("polled before open")) throw sdk::bad_argument("not open");
        if (stream > 0 && !is("second camera")) throw sdk::bad_argument("stream: no such camera");
    }

    bool open_ = false;
    bool seen_all_ = false;
    std::uint32_t polled_ = 0;
    std::array<float, 2> depth_{};

    std::vector<Float3> rest_;
    Float3 hips_{};
    std::map<std::uint32_t, std::uint32_t> garments_;
    std::uint32_t last_ = 0;
    bool stray_ = false;
    int frame_ = 0;
};

} // namespace

TOILE_PLUGIN(puppet, Puppet)

namespace toile::host {
namespace {

/// The first rule that the puppet breaks.
std::string broken_rule(const std::string& with) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "sample.txt") << "puppet";
    Manifest manifest;
    manifest.id = "test.puppet";
    manifest.version = "1.0.0";
    manifest.provides = {TOILE_GARMENT, TOILE_CLOTH, TOILE_BODY_SOURCE, TOILE_SENSOR};
    manifest.schemes = {"puppet"};
    manifest.sample = folder / "sample.txt";
    fault = with;
    const auto plugin = Plugin::link(toile_plugin_entry_puppet, manifest);
    try {
        for (const ContractCase& rule : contract_cases())
            if (applies(rule, manifest)) run_contract_case(rule, plugin);
    } catch (const PluginRefused& e) {
        return e.detail() + " [" + std::string(refusal_name(e.reason())) + "]";
    }
    return "";
}

TEST(Contract, APuppetKeepsEveryRule) {
    EXPECT_EQ(broken_rule("nothing"), "");
}

struct Broken {
    const char* fault;
    const char* text;
};

class ContractCatches : public ::testing::TestWithParam<Broken> {};

TEST_P(ContractCatches, TheFault) {
    EXPECT_EQ(broken_rule(GetParam().fault), GetParam().text);
}

const Broken kBroken[] = {
    {"bind moves",
     "bind: moves a garment by more than 5 cm on the body that it was made on [contract_broken]"},
    {"joint 22", "bind: a joint index beyond 21 [contract_broken]"},
    {"weights 0.5", "bind: joint weights do not sum to 1 [contract_broken]"},
    {"attachment 2", "bind: an attachment outside 0 to 1 [contract_broken]"},
    {"bind NaN", "bind: returns numbers that are not finite [non_finite]"},
    {"bind leaves a row", "bind: returns numbers that are not finite [non_finite]"},
    {"targets stand still", "targets: do not turn with the body [contract_broken]"},
    {"targets differ", "garment: two runs give different bytes [contract_broken]"},
    {"handle 0", "add_garment: gives the handle 0 [contract_broken]"},
    {"one handle", "add_garment: gives one handle twice [contract_broken]"},
    {"remove twice", "remove_garment: answers TOILE_OK for a garment that is gone, an error was "
                     "wanted [contract_broken]"},
    {"cloth NaN", "step: returns numbers that are not finite [non_finite]"},
    {"normals left out", "step: returns numbers that are not finite [non_finite]"},
    {"pins slip", "step: vertices with attachment 1 leave their targets [contract_broken]"},
    {"cloth flies", "step: the cloth flies away from a slowly walking body [contract_broken]"},
    {"reset ignored",
     "step: with TOILE_STEP_RESET it does not start from the targets [contract_broken]"},
    {"cloth overruns", "step: writes beyond its buffers [contract_broken]"},
    {"other schemes", "describe: the scheme 'marionette' is not in the manifest [contract_broken]"},
    {"any file", "begin: answers TOILE_OK for a file that is not there, an error was wanted "
                 "[contract_broken]"},
    {"goes on", "feed: goes on after the end of the recording [contract_broken]"},
    {"nobody", "result: gives nobody in the plugin's own sample [contract_broken]"},
    {"too many", "result: gives more people than there is room for [contract_broken]"},
    {"person 0", "result: gives the person the id 0 [contract_broken]"},
    {"tracking 9", "result: an unknown tracking state [contract_broken]"},
    {"time runs back", "result: time runs backwards [contract_broken]"},
    {"rotation 2", "result: a rotation that is not a unit quaternion [contract_broken]"},
    {"joint NaN", "result: returns numbers that are not finite [non_finite]"},
    {"source differs", "result: two runs give different bytes [contract_broken]"},
    {"any recording", "open: answers TOILE_OK for a file that is not there, an error was wanted "
                      "[contract_broken]"},
    {"polled before open",
     "poll: answers TOILE_OK before open, an error was wanted [contract_broken]"},
    {"no cameras", "stream_count: no cameras, or too many [contract_broken]"},
    {"no focal length", "describe: intrinsics that make no sense [contract_broken]"},
    {"bent pose", "describe: world_from_camera is not a rigid motion [contract_broken]"},
    {"second camera", "describe: answers TOILE_OK for a camera that is not there, an error was "
                      "wanted [contract_broken]"},
    {"sequence stays", "poll: sequence does not rise [contract_broken]"},
    {"camera time runs back", "poll: time does not rise [contract_broken]"},
    {"depth 0", "poll: a depth that is neither positive nor NaN [contract_broken]"},
    {"pixel missing", "poll: depth is not one float a pixel [contract_broken]"},
    {"camera differs", "poll: two runs give different bytes [contract_broken]"},
    {"camera goes on", "poll: goes on after the end of the recording [contract_broken]"},
    {"reset forgotten", "reset: the recording does not begin anew [contract_broken]"},
};

INSTANTIATE_TEST_SUITE_P(All, ContractCatches, ::testing::ValuesIn(kBroken),
                         [](const auto& tested) {
                             std::string name = tested.param.fault;
                             for (char& c : name)
                                 if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                             return name;
                         });

} // namespace
} // namespace toile::host
