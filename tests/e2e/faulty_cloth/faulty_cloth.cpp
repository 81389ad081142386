// Cloth that hangs as plain skinning has it, until its sixtieth step after each dressing: then it
// does what its folder's name says. The mirror must go on (kiosk_faults_test.cpp).
#include "sdk/sdk.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <limits>
#include <stdexcept>
#include <string>
#include <unistd.h>

namespace {

namespace sdk = toile::sdk;
using sdk::Float3;

constexpr int kSoundSteps = 60; // 47 of them move it from rest into the first frame's pose

std::string folder_name() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&folder_name), &info) == 0) return "";
    const std::string file = info.dli_fname;
    const std::size_t end = file.rfind('/');
    return file.substr(0, end).substr(file.substr(0, end).rfind('/') + 1);
}

class FaultyCloth {
  public:
    static constexpr sdk::Info info{
        .id = "test.faulty_cloth", .name = "Faulty", .version = "1.0.0", .vendor = "Test"};
    using Kinds = sdk::Kinds<sdk::Cloth>;

    explicit FaultyCloth(sdk::Host) : fault_(folder_name()) {}

    void set_body(const toile_body&, sdk::Job) {}
    std::uint32_t add_garment(const toile_cloth_garment&, sdk::Job) { return ++last_; }
    void remove_garment(std::uint32_t) {}
    void step(const toile_cloth_step& step) {
        const auto targets = sdk::targets_of(step);
        const auto states = sdk::states_of(step);
        for (std::uint32_t k = 0; k < states.size(); ++k) {
            const auto in = sdk::span_of<Float3>(targets[k].positions, "targets");
            const auto out = sdk::span_of<Float3>(states[k].positions, "positions", in.size());
            const auto normals = sdk::span_of<Float3>(states[k].normals, "normals", in.size());
            std::copy(in.begin(), in.end(), out.begin());
            std::fill(normals.begin(), normals.end(), Float3{0, 0, 1});
        }
        if (++steps_ > kSoundSteps) fail(sdk::span_of<Float3>(states[0].positions, "positions"));
    }

  private:
    void fail(std::span<Float3> positions) const {
        if (fault_ == "errors") throw sdk::Failure(TOILE_E_DEVICE, "the cloth tore");
        if (fault_ == "throws") throw std::runtime_error("the cloth burst");
        if (fault_ == "not_finite") positions[0][1] = std::numeric_limits<float>::quiet_NaN();
        if (fault_ == "crashes") std::raise(SIGSEGV);
        if (fault_ == "hangs")
            for (;;)
                pause();
    }

    std::string fault_;
    std::uint32_t last_ = 0;
    int steps_ = 0;
};

} // namespace

TOILE_PLUGIN(faulty_cloth, FaultyCloth)
