#include "host/job.h"

#include <csignal>
#include <cstdlib>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

namespace toile::host {
namespace {

TEST(Job, ProgressNeverFallsAndStaysInRange) {
    std::vector<double> seen;
    std::string last;
    Job job([&](double fraction, std::string_view text) {
        seen.push_back(fraction);
        last = text;
    });
    toile_job* handle = job.handle();
    for (const double fraction : {-1.0, 0.25, 0.1, std::numeric_limits<double>::quiet_NaN(), 7.0})
        EXPECT_EQ(handle->progress(handle, fraction, fraction == 0.25 ? "binding" : nullptr), 0);
    EXPECT_EQ(seen, (std::vector<double>{0.0, 0.25, 0.25, 0.25, 1.0}));
    EXPECT_EQ(last, "");
}

TEST(Job, IsCancelledByItselfOrByAFlag) {
    std::atomic<bool> stop = false;
    Job job({}, &stop);
    EXPECT_EQ(job.handle()->progress(job.handle(), 0.5, nullptr), 0);
    stop = true;
    EXPECT_NE(job.handle()->progress(job.handle(), 0.5, nullptr), 0);
    stop = false;
    job.cancel();
    EXPECT_TRUE(job.cancelled());
}

TEST(Job, AWatcherThatThrowsDoesNotReachThePlugin) {
    Job job([](double, std::string_view) { throw 1; });
    EXPECT_EQ(job.handle()->progress(job.handle(), 0.5, nullptr), 0);
}

TEST(Interrupts, CtrlCSetsTheFlagAndCancels) {
    EXPECT_EXIT(
        {
            catch_interrupts();
            const Job job({}, &interrupt_flag());
            if (job.cancelled()) std::exit(1);
            std::raise(SIGINT);
            std::exit(job.cancelled() ? 0 : 1);
        },
        ::testing::ExitedWithCode(0), "");
}

TEST(Interrupts, ASecondCtrlCEndsTheProgram) {
    EXPECT_EXIT(
        {
            catch_interrupts();
            std::raise(SIGINT);
            std::raise(SIGINT);
        },
        ::testing::KilledBySignal(SIGINT), "");
}

} // namespace
} // namespace toile::host
