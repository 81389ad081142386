// toile report: one page that holds everything, opened, turned and read in a browser.
#include "imaging/image.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <regex>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class ReportTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new TemporaryFolder;
        made_ = run_toile({"report", "--body", "women-l", "--garment", "pencil-skirt", "--title",
                           "A <skirt> & more", "--out", page().string()});
        html_ = text_of(page());
    }
    static void TearDownTestSuite() { delete folder_; }
    static fs::path page() { return *folder_ / "report.html"; }

    /// Chromium without a window, on the page. Its profile is its own.
    static ProgramResult browse(const std::string& anchor, const std::vector<std::string>& more) {
        std::vector<std::string> words = {"timeout",
                                          "120",
                                          "chromium",
                                          "--headless=new",
                                          "--no-sandbox",
                                          "--use-angle=swiftshader",
                                          "--enable-unsafe-swiftshader",
                                          "--hide-scrollbars",
                                          "--window-size=1200,900",
                                          "--virtual-time-budget=20000",
                                          "--user-data-dir=" + (*folder_ / "profile").string()};
        words.insert(words.end(), more.begin(), more.end());
        words.push_back("file://" + page().string() + anchor);
        return run_program(words);
    }
    static imaging::Image screenshot(const std::string& anchor) {
        const fs::path file = *folder_ / "shot.png";
        fs::remove(file);
        const ProgramResult result = browse(anchor, {"--screenshot=" + file.string()});
        EXPECT_TRUE(fs::exists(file)) << result.output;
        return imaging::load_image(file);
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

TEST_F(ReportTest, ABrowserLoadsTheLookAndReadsThePage) {
    if (no_browser()) GTEST_SKIP() << "chromium is not installed";
    const ProgramResult dom = browse("", {"--dump-dom"});
    // Not as a matcher: the page is megabytes long.
    EXPECT_NE(dom.output.find("data-look=\"loaded\""), std::string::npos);
    EXPECT_NE(dom.output.find("The sizes side by side"), std::string::npos);
}

TEST_F(ReportTest, TheLookCanBeTurned) {
    if (no_browser()) GTEST_SKIP() << "chromium is not installed";
    const imaging::Image front = screenshot(""), again = screenshot("#turn=0"),
                         back = screenshot("#turn=180");
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
