#include "apps/kiosk/texts.h"

#include "core/json.h"
#include "core/paths.h"

#include <algorithm>

namespace toile::apps::kiosk {
namespace {

constexpr std::array<const char*, kTextCount> kKeys = {
    "attract_title",
    "attract_line",
    "consent_title",
    "consent_camera",
    "consent_measure",
    "consent_kept",
    "consent_network",
    "agree",
    "decline",
    "measure_title",
    "measure_front",
    "measure_left",
    "measure_back",
    "measure_right",
    "measure_working",
    "measure_done",
    "measure_failed",
    "skip",
    "try_again",
    "next_garment",
    "previous_garment",
    "size",
    "size_auto",
    "colour",
    "freeze",
    "turn",
    "live",
    "compare",
    "compare_done",
    "snapshot",
    "snapshot_kept",
    "finish",
    "dressing",
    "fits",
    "between_sizes",
    "not_measured",
    "frozen_title",
    "goodbye_title",
    "goodbye_line",
    "declined_line",
    "come_closer",
    "hand_hint",
    "setup_title",
    "setup_sensor",
    "setup_no_sensor",
    "setup_floor",
    "setup_no_floor",
    "setup_camera",
    "setup_mirror",
    "setup_light",
    "setup_light_good",
    "setup_light_dark",
    "setup_light_bright",
    "setup_keys",
    "setup_saved",
    "safe_title",
    "safe_line",
    "camera_lost",
    "camera_back",
    "garment_changed",
    "garment_refused",
    "plugin_off",
    "disk_full",
    "picture_lost",
    "clock_changed",
    "restarted",
    "stock_plugins",
};

} // namespace

const char* text_key(Text text) {
    return kKeys.at(static_cast<std::size_t>(text));
}

std::vector<std::string> list_languages() {
    std::vector<std::string> out;
    for (const std::filesystem::path& folder : data_folders("kiosk")) {
        std::error_code code;
        for (const auto& entry : std::filesystem::directory_iterator(folder / "texts", code))
            if (entry.path().extension() == ".json") out.push_back(entry.path().stem().string());
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

Texts Texts::load(const std::string& language) {
    const std::filesystem::path name(language);
    if (name == name.filename())
        for (const std::filesystem::path& folder : data_folders("kiosk")) {
            const std::filesystem::path file = folder / "texts" / (language + ".json");
            if (std::filesystem::is_regular_file(file)) return load_file(file);
        }
    std::string known;
    for (const std::string& one : list_languages())
        known += (known.empty() ? "" : ", ") + one;
    throw UsageError("language '" + language + "': there are only " + known);
}

Texts Texts::load_file(const std::filesystem::path& file) {
    const nlohmann::json parsed = parse_json_file(file);
    JsonObject json(parsed, file.string());
    Texts out;
    for (std::size_t i = 0; i < kTextCount; ++i) {
        out.texts_[i] = json.text(kKeys[i]);
        if (out.texts_[i].empty()) throw json.error(kKeys[i], "is empty");
    }
    json.finish();
    return out;
}

std::string
Texts::with(Text text,
            std::initializer_list<std::pair<const char*, std::string>> replacements) const {
    std::string out = (*this)[text];
    for (const auto& [name, words] : replacements) {
        const std::string mark = "{" + std::string(name) + "}";
        const std::size_t at = out.find(mark);
        if (at != std::string::npos) out.replace(at, mark.size(), words);
    }
    return out;
}

std::string shortened(const std::string& words) {
    constexpr std::size_t kFewer = 8; // bytes
    std::size_t end = words.size() - std::min(kFewer, words.size());
    const auto inside_letter = [&](std::size_t at) {
        return at > 0 && (static_cast<unsigned char>(words[at]) & 0xC0u) == 0x80u;
    };
    while (inside_letter(end))
        --end;
    return words.substr(0, end) + "...";
}

} // namespace toile::apps::kiosk
