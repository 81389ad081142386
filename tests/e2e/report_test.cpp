// toile report: one page that holds everything, opened, turned and read in a browser.
#include "imaging/image.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"
#include "support/text_file.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <regex>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ReportTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new TemporaryFolder;
        made_ = run_toile({"report", "--body", "women-l", "--garment", "pencil-skirt", "--title",
                           "A <skirt> & more", "--out", page().string()});
        html_ = file_text(page());
    }
    static void TearDownTestSuite() { delete folder_; }
    static fs::path page() { return *folder_ / "report.html"; }

    /// The page in Chromium, its look loaded: {look, text, requests}. `shots`: anchor=picture.
    static nlohmann::json browse(const std::vector<std::string>& shots) {
        std::vector<std::string> words = {
            "node", std::string(TOILE_SOURCE_DIR) + "/tests/e2e/browse.mjs",
            "file://" + page().string(), (*folder_ / "profile").string()};
        words.insert(words.end(), shots.begin(), shots.end());
        const ProgramResult result = run_program(words);
        EXPECT_EQ(result.status, 0) << result.output.substr(0, 400);
        return result.status == 0 ? nlohmann::json::parse(result.output) : nlohmann::json();
    }
    static bool no_browser() { return std::system("command -v chromium >/dev/null 2>&1") != 0; }

    static inline TemporaryFolder* folder_ = nullptr;
    static inline ProgramResult made_;
    static inline std::string html_;
};

bool holds(const std::string& page, const std::string& words) {
    return page.find(words) != std::string::npos;
}

/// Pixels that differ by more than 24 of 255, as a share of the picture's part with the look.
double changed_look(const imaging::Image& a, const imaging::Image& b) {
    std::size_t changed = 0, all = 0;
    for (int y = 200; y < 700; ++y)
        for (int x = 100; x < 560; ++x, ++all) {
            const std::size_t i = 4 * (std::size_t(y) * std::size_t(a.width) + std::size_t(x));
            int most = 0;
            for (std::size_t c = 0; c < 3; ++c)
                most = std::max(most, std::abs(int(a.pixels[i + c]) - int(b.pixels[i + c])));
            changed += most > 24 ? 1 : 0;
        }
    return double(changed) / double(all);
}

TEST_F(ReportTest, OneFileHoldsEverything) {
    ASSERT_EQ(made_.status, 0) << made_.output;
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder_->path()))
        files += entry.is_regular_file() ? 1 : 0;
    EXPECT_EQ(files, 1u) << "something was left beside the page";
    const std::string own = html_.substr(0, html_.find("<script"));
    EXPECT_TRUE(holds(own, "default-src 'none'"));
    EXPECT_FALSE(std::regex_search(own, std::regex(R"((src|href|poster)="(?!data:|#))")))
        << "the page reaches outside";
    EXPECT_TRUE(holds(own, "<title>A &lt;skirt&gt; &amp; more</title>"));
    EXPECT_TRUE(holds(own, "Size <b>L</b> is made for these measurements"));
    EXPECT_TRUE(holds(own, "<td>Hip</td>"));
    EXPECT_TRUE(holds(own, "<td>Waist girth</td>"));
    EXPECT_FALSE(holds(own, "{{"));
}

TEST_F(ReportTest, ABrowserLoadsTurnsAndReadsIt) {
    if (no_browser()) GTEST_SKIP() << "chromium is not installed";
    const auto shot = [](const char* name) { return (*folder_ / name).string(); };
    const nlohmann::json seen =
        browse({"#turn=0=" + shot("front.png"), "#turn=180=" + shot("back.png"),
                "#turn=360=" + shot("again.png")});
    ASSERT_TRUE(seen.is_object());
    EXPECT_EQ(seen["look"], "loaded");
    const auto text = seen["text"].get<std::string>();
    EXPECT_TRUE(holds(text, "The sizes side by side"));
    EXPECT_TRUE(holds(text, "A <skirt> & more"));
    for (const auto& request : seen["requests"]) {
        const auto address = request.get<std::string>();
        EXPECT_TRUE(address.starts_with("data:") || address.starts_with("blob:")) << address;
    }
    const auto front = imaging::load_image(shot("front.png")),
               back = imaging::load_image(shot("back.png")),
               again = imaging::load_image(shot("again.png"));
    EXPECT_LT(changed_look(front, again), 0.002);
    EXPECT_GT(changed_look(front, back), 0.02) << "the back looks like the front";
}

TEST_F(ReportTest, BadCallsAreRefused) {
    const ProgramResult named =
        run_toile({"report", "--garment", "pencil-skirt", "--out", "report.pdf"});
    EXPECT_EQ(named.status, 2);
    EXPECT_THAT(named.output, HasSubstr("a report is written as .html"));
    const ProgramResult none =
        run_toile({"report", "--garment", "nosuch", "--out", (*folder_ / "none.html").string()});
    EXPECT_EQ(none.status, 1);
    EXPECT_FALSE(fs::exists(*folder_ / "none.html"));
}

} // namespace
} // namespace toile::test
