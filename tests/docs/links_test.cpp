// No page of the repository points at nothing; and such a link is noticed.
#include "docs/link_rules.h"

#include "support/temporary_folder.h"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(Links, EveryLinkOfTheRepositoryLeadsSomewhere) {
    EXPECT_THAT(broken_links(TOILE_SOURCE_DIR), IsEmpty());
}

/// The name of a page that this file may say without the page being there.
std::string page(const std::string& name) {
    return "docs/" + name + ".md";
}

class LinksTest : public testing::Test {
  protected:
    void write(const std::string& file, const std::string& text) {
        fs::create_directories((folder_ / file).parent_path());
        std::ofstream(folder_ / file) << text;
    }
    [[nodiscard]] std::vector<std::string> broken() const { return broken_links(folder_.path()); }

    TemporaryFolder folder_;
};

TEST_F(LinksTest, FilesFoldersHeadingsAndOtherHostsPass) {
    write("README.md", "# Top\n[a](" + page("a") + ") [b](docs/) [c](" + page("a") +
                           "#how-it-s-done) [d](#top)\n"
                           "[e](https://example.org/none.md) [f](mailto:a@b.c)\n");
    write(page("a"), "text\n\n## How it s done\n[back](../README.md)\n");
    EXPECT_THAT(broken(), IsEmpty());
}

TEST_F(LinksTest, AMissingFileIsFoundWithItsLine) {
    write("README.md", "fine\n[a](docs/), [b](a/none.md), ![c](c.png)\n");
    fs::create_directories(folder_ / "docs");
    EXPECT_THAT(broken(), ElementsAre("README.md:2: links to a/none.md, which is not there",
                                      "README.md:2: links to c.png, which is not there"));
}

TEST_F(LinksTest, LinksAreRelativeToTheirPage) {
    write("pages/a.md", "[a](a.md) [b](pages/a.md)\n");
    EXPECT_THAT(broken(), ElementsAre("pages/a.md:1: links to pages/a.md, which is not there"));
}

TEST_F(LinksTest, AMissingHeadingIsFound) {
    write("a.md", "# One\n[a](#two)\n");
    EXPECT_THAT(broken(), ElementsAre("a.md:2: links to #two, but that page has no such heading"));
}

TEST_F(LinksTest, WhatIsCodeIsNoLink) {
    write("a.md", "`f[i](x.y)` and\n```\ng[i](x.y)\n```\n[a](x.y)\n");
    EXPECT_THAT(broken(), ElementsAre("a.md:5: links to x.y, which is not there"));
}

TEST_F(LinksTest, AMentionInASourceOrScriptIsFollowed) {
    write("engine/a.h", "// see " + page("none") + "\n");
    write("scripts/run", "# " + page("gone") + "\n");
    write(page("there"), "");
    write("engine/b.h", "// see " + page("there") + ".\n");
    EXPECT_THAT(broken(),
                ElementsAre("engine/a.h:1: names " + page("none") + ", which is not there",
                            "scripts/run:1: names " + page("gone") + ", which is not there"));
}

TEST_F(LinksTest, WhatIsBuiltOrFetchedIsSkipped) {
    for (const char* folder : {"build", "out/demo", "x/node_modules/y", ".cache"})
        write(std::string(folder) + "/README.md", "[a](none.md)\n");
    EXPECT_THAT(broken(), IsEmpty());
}

} // namespace
} // namespace toile::test
