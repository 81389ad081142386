// The log: one line a message, levels that can be silenced.
#include "core/log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace toile {
namespace {

using testing::HasSubstr;
using testing::Not;

// What `work` writes to standard error.
template <class Work>
std::string logged(const Work& work) {
    testing::internal::CaptureStderr();
    work();
    return testing::internal::GetCapturedStderr();
}

class LogTest : public testing::Test {
  protected:
    ~LogTest() override { log::set_level(log::Level::info); }
};

TEST_F(LogTest, ALineNamesTheProgramAndTheLevel) {
    EXPECT_EQ(logged([] { log::warning("the hem is loose"); }),
              "toile: warning: the hem is loose\n");
    EXPECT_EQ(logged([] { log::error("torn"); }), "toile: error: torn\n");
}

TEST_F(LogTest, TextIsNotTakenForAFormat) {
    EXPECT_THAT(logged([] { log::info("50 % {} {0} %s"); }), HasSubstr("50 % {} {0} %s\n"));
}

TEST_F(LogTest, LevelsBelowTheOneSetAreDropped) {
    const auto all = [] {
        log::debug("one");
        log::info("two");
        log::warning("three");
        log::error("four");
    };
    EXPECT_THAT(logged(all), Not(HasSubstr("one"))) << "info at start";
    log::set_level(log::Level::debug);
    EXPECT_THAT(logged(all), HasSubstr("one"));
    log::set_level(log::Level::error);
    EXPECT_EQ(logged(all), "toile: error: four\n");
}

} // namespace
} // namespace toile
