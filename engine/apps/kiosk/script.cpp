#include "apps/kiosk/script.h"

#include "core/json.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::apps::kiosk {
namespace {

constexpr std::array<const char*, 6> kFaults = {"camera", "clock", "picture",
                                                "disk",   "crash", "stall"};
constexpr std::int64_t kMostFrames = 100'000'000;

ScriptStep read_step(JsonObject& json) {
    using Kind = ScriptStep::Kind;
    ScriptStep step;
    step.frame = static_cast<std::uint64_t>(json.integer("frame", 0, kMostFrames));
    int kinds = 0;
    if (json.has("act")) {
        ++kinds;
        step.kind = Kind::act;
        step.action = action_from_name(json.text("act"));
        if (step.action == Action::invalid) throw json.error("act", "is no action of the mirror");
        step.person = static_cast<std::uint32_t>(json.integer_or("person", 1, 2, 1));
    }
    if (json.has("picture")) {
        ++kinds;
        step.kind = Kind::picture;
        step.name = json.file_name("picture");
    }
    if (json.has("mask")) {
        ++kinds;
        step.kind = Kind::mask;
        step.name = json.file_name("mask");
    }
    if (json.has("fault")) {
        ++kinds;
        step.kind = Kind::fault;
        step.name = json.text("fault");
        if (std::find(kFaults.begin(), kFaults.end(), step.name) == kFaults.end())
            throw json.error("fault", "is none of camera, clock, picture, disk, crash and stall");
    }
    if (json.has("quit")) {
        ++kinds;
        step.kind = json.boolean("quit") ? Kind::quit : Kind::invalid;
    }
    if (json.has("every_s")) step.every_s = json.number("every_s", 0.1, 86'400.0);
    if (kinds != 1 || step.kind == Kind::invalid)
        throw json.error("", "a step has one of act, picture, mask, fault and quit");
    json.finish();
    return step;
}

} // namespace

std::vector<ScriptStep> Script::at(std::uint64_t frame) const {
    std::vector<ScriptStep> out;
    for (const ScriptStep& step : steps)
        if (step.frame == frame) out.push_back(step);
    return out;
}

std::vector<ScriptStep> Script::between(const std::vector<double>& began_s, double before_s,
                                        double now_s) const {
    std::vector<ScriptStep> out;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const double every_s = steps[i].every_s;
        if (every_s <= 0.0 || began_s[i] < 0.0) continue;
        const double times = std::floor((now_s - began_s[i]) / every_s) -
                             std::floor((before_s - began_s[i]) / every_s);
        for (int k = 0; k < static_cast<int>(times); ++k)
            out.push_back(steps[i]);
    }
    return out;
}

Script load_script(const std::filesystem::path& file) {
    const nlohmann::json parsed = parse_json_file(file);
    JsonObject json(parsed, file.string());
    Script out;
    (void)json.integer("schema", 1, 1);
    for (JsonObject& step : json.objects("steps"))
        out.steps.push_back(read_step(step));
    json.finish();
    std::stable_sort(out.steps.begin(), out.steps.end(),
                     [](const ScriptStep& a, const ScriptStep& b) { return a.frame < b.frame; });
    return out;
}

} // namespace toile::apps::kiosk
