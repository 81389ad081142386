// A mirror without a shop: a simulated shopper, and a script that presses the buttons.
#pragma once

#include "core/bytes.h"
#include "imaging/image.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>

namespace toile::test {

namespace fs = std::filesystem;

/// Somebody who turns once in four seconds, and a wall.
inline constexpr const char* kTurning = R"({"schema": 1, "frames": 400,
    "people": [{"body": {"avatar": "woman"}, "turntable_s": 4}],
    "scene": {"walls": [{"position": [0, 0, -1.4]}]},
    "cameras": [{"name": "front", "mount": "upright", "position": [0, 1.1, 2.0],
                 "look_at": [0, 0.95, 0]}]})";

class KioskTest : public testing::Test {
  protected:
    void SetUp() override {
        write("scenario.json", kTurning);
        configure(R"("people": 1)");
    }
    void write(const char* name, const std::string& text) { write_text(folder_ / name, text); }
    void configure(const std::string& more) {
        std::string text = R"({"schema": 1, "garments": ["tee", "dress"], "width": 270,
            "height": 480, "away_s": 0.5, )";
        if (more.find("measure") == std::string::npos) text += R"("measure": false, )";
        write("kiosk.json", text + more + "}");
    }
    [[nodiscard]] std::string at(const char* name) const { return (folder_ / name).string(); }
    [[nodiscard]] std::string simulated() const { return "simulated:" + at("scenario.json"); }
    ProgramResult kiosk(std::vector<std::string> more, const std::string& environment = "") {
        std::vector<std::string> words = {"kiosk",    "--config",  at("kiosk.json"),
                                          "--source", simulated(), "--headless"};
        words.insert(words.end(), more.begin(), more.end());
        return run_toile(words, environment);
    }
    [[nodiscard]] std::string text_of(const char* name) const {
        const auto bytes = read_bytes(folder_ / name, 1u << 20);
        return {bytes.begin(), bytes.end()};
    }

    TemporaryFolder folder_;
};

/// Share of pixels that differ by more than a little.
inline double difference(const fs::path& a, const fs::path& b) {
    const imaging::Image one = imaging::load_image(a);
    const imaging::Image two = imaging::load_image(b);
    if (one.pixels.size() != two.pixels.size()) return 1.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < one.pixels.size(); i += 4) {
        int most = 0;
        for (std::size_t k = 0; k < 3; ++k)
            most = std::max(most, std::abs(one.pixels[i + k] - two.pixels[i + k]));
        count += most > 40 ? 1 : 0;
    }
    return 4.0 * static_cast<double>(count) / static_cast<double>(one.pixels.size());
}

} // namespace toile::test
