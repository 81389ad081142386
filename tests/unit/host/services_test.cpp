#include "host/services.h"

#include <atomic>
#include <gtest/gtest.h>
#include <mutex>
#include <set>
#include <utility>

namespace toile::host {
namespace {

using Range = std::pair<std::uint32_t, std::uint32_t>;

std::set<Range> ranges_of(Services& services, std::uint32_t count, std::uint32_t grain) {
    struct Seen {
        std::mutex mutex;
        std::set<Range> ranges;
    } seen;
    EXPECT_TRUE(services.parallel_for(count, grain, &seen,
                                      [](void* user, std::uint32_t begin, std::uint32_t end) {
                                          auto& all = *static_cast<Seen*>(user);
                                          const std::lock_guard lock(all.mutex);
                                          EXPECT_TRUE(all.ranges.emplace(begin, end).second);
                                      }));
    return seen.ranges;
}

TEST(Services, RangesDependOnCountAndGrainOnly) {
    Services one(1);
    Services four(4);
    EXPECT_EQ(one.thread_count(), 1u);
    EXPECT_EQ(four.thread_count(), 4u);
    const std::set<Range> wanted = {{0, 300}, {300, 600}, {600, 900}, {900, 1000}};
    EXPECT_EQ(ranges_of(one, 1000, 300), wanted);
    EXPECT_EQ(ranges_of(four, 1000, 300), wanted);
    EXPECT_EQ(ranges_of(four, 0, 300), std::set<Range>{});
    EXPECT_EQ(ranges_of(four, 3, 0).size(), 3u);
    EXPECT_EQ(ranges_of(four, UINT32_MAX, 1u << 31),
              (std::set<Range>{{0, 1u << 31}, {1u << 31, UINT32_MAX}}));
}

TEST(Services, ABodyThatThrowsIsContained) {
    Services services(2);
    EXPECT_FALSE(
        services.parallel_for(8, 1, nullptr, [](void*, std::uint32_t begin, std::uint32_t) {
            if (begin == 3) throw 1;
        }));
}

TEST(InstanceHost, CopiesTheErrorTextAsOneLine) {
    Services services(1);
    InstanceHost host(services, "test.plugin");
    const toile_host* handle = host.handle();
    {
        std::string text = "first\nsecond\x1b[31m";
        handle->report(handle, TOILE_LOG_ERROR, TOILE_E_IO, text.c_str());
        text.assign(text.size(), '?');
    }
    EXPECT_EQ(host.take_error(), "first second [31m");
    EXPECT_EQ(host.take_error(), "");
    handle->report(handle, TOILE_LOG_DEBUG, TOILE_OK, "not an error");
    handle->report(handle, TOILE_LOG_ERROR, TOILE_E_IO, nullptr);
    EXPECT_EQ(host.take_error(), "");
}

TEST(InstanceHost, OffersTheThreadPoolAndNothingElse) {
    Services services(3);
    const InstanceHost host(services, "test.plugin");
    const toile_host* handle = host.handle();
    EXPECT_EQ(handle->get_extension(handle, "toile.thread_pool/2"), nullptr);
    EXPECT_EQ(handle->get_extension(handle, nullptr), nullptr);
    const auto* pool =
        static_cast<const toile_thread_pool*>(handle->get_extension(handle, TOILE_THREAD_POOL));
    ASSERT_NE(pool, nullptr);
    EXPECT_EQ(pool->thread_count(handle), 3u);
    std::atomic<std::uint32_t> sum = 0;
    pool->parallel_for(handle, 100, 7, &sum,
                       [](void* user, std::uint32_t begin, std::uint32_t end) {
                           *static_cast<std::atomic<std::uint32_t>*>(user) += end - begin;
                       });
    EXPECT_EQ(sum, 100u);
}

} // namespace
} // namespace toile::host
