// Between a recording and the surfaces to be drawn nothing allocates, once the first frames are
// over: the stock plugins with a dressed avatar.
#include "allocations/allocation_counter.h"
#include "body/motion.h"
#include "garment/cloth_strain.h"
#include "garment/size_choice.h"
#include "garment/skin_gap.h"
#include "pipeline/motion_source.h"
#include "pipeline/try_on_run.h"

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace toile::pipeline {
namespace {

using testing::IsEmpty;

const std::filesystem::path kRoot = TOILE_SOURCE_DIR;

TEST(AllocationCount, SeesEveryWayOfAllocating) {
    test::AllocationCount count;
    const auto number = std::make_unique<int>(1);
    const std::vector<double> values(100, 1.0);
    const Eigen::VectorXf vector = Eigen::VectorXf::Zero(100); // by malloc, not by new
    struct alignas(64) Line {
        std::array<char, 64> bytes{};
    };
    const auto line = std::make_unique<Line>(); // by aligned_alloc
    EXPECT_EQ(count.stop(), 4u);
    EXPECT_FALSE(test::AllocationCount::first().empty());
    EXPECT_EQ(static_cast<float>(*number + line->bytes[0]) + vector[0], values[0]);
}

TEST(AllocationCount, NothingIsCountedAfterTheEnd) {
    test::AllocationCount count;
    EXPECT_EQ(count.stop(), 0u) << test::AllocationCount::first();
    const std::vector<double> values(100);
    EXPECT_EQ(count.stop(), 0u) << values.size();
}

/// A woman in a T-shirt and a skirt, by the plugins beside this program; two threads.
struct FittingRoom {
    FittingRoom() {
        options.limits = host::sized<toile_limits>();
        options.limits.max_people = 1;
        options.limits.max_vertices = 100'000;
        options.limits.max_triangles = 200'000;
        options.limits.thread_count = services.thread_count();
        options.limits.frame_budget_s = 1.0 / 30.0;
        options.limits.random_seed = 1;
        std::vector<std::shared_ptr<const BoundaryGarment>> garments = {garment("t-shirt"),
                                                                        garment("skirt")};
        person = std::make_unique<DressedPerson>(registry, services, body, std::move(garments),
                                                 options, job);
    }

    std::shared_ptr<const BoundaryGarment> garment(const std::string& id) {
        auto package = garment::load_package(kRoot / "garments" / id);
        const auto choice = garment::choose_size(*package, body->model().measurements);
        const garment::GarmentSize& size = package->sizes[choice.index];
        EXPECT_EQ(size.entry.made_on, "woman") << "the size chart chooses another avatar's size";
        return std::make_shared<const BoundaryGarment>(std::move(package), size, body);
    }

    host::Services services{2};
    host::Registry registry{services};
    host::Job job;
    DressingOptions options;
    std::shared_ptr<const BoundaryBody> body = std::make_shared<const BoundaryBody>(
        std::make_shared<const body::BodyModel>(body::load_body_model(kRoot / "avatars/woman")), 1);
    std::unique_ptr<DressedPerson> person;
};

class FramePath : public testing::Test {
  protected:
    static void SetUpTestSuite() { room_ = std::make_unique<FittingRoom>(); }
    static void TearDownTestSuite() { room_.reset(); }

    /// The walk as a source that does not end; its last pose is held.
    static MotionSource walk(double frames_per_second) {
        const body::Skeleton& skeleton = room_->body->model().skeleton;
        return {body::load_motion(kRoot / "avatars/motions/walk.json", skeleton), skeleton,
                frames_per_second, 3600.0};
    }

    /// No allocation in `frames` frames, after a few that may still allocate.
    static void expect_none(FrameSource& source, int frames, RunOptions options = {}) {
        constexpr int kWarmUp = 3;
        TryOnRun run(source, *room_->person, std::move(options));
        for (int i = 0; i < kWarmUp; ++i)
            ASSERT_TRUE(run.next());
        for (int i = 0; i < frames; ++i) {
            test::AllocationCount count;
            const bool there = run.next();
            const std::uint64_t allocations = count.stop();
            ASSERT_TRUE(there) << "the source ended after " << i << " frames";
            ASSERT_EQ(allocations, 0u) << "frame " << kWarmUp + i << ", first from\n"
                                       << test::AllocationCount::first();
        }
        EXPECT_THAT(room_->person->faults(), IsEmpty());
    }

    static inline std::unique_ptr<FittingRoom> room_;
};

TEST_F(FramePath, ARecordedSkeletonIsDressedWithoutAllocating) {
    const auto log = kRoot / "plugins/kinect_log_source/sample.csv";
    const auto source = open_source("kinect-log:" + log.string(), room_->registry, room_->services,
                                    *room_->body, room_->options.limits, room_->job);
    expect_none(*source, 20);
}

TEST_F(FramePath, AFastMotionIsDressedWithoutAllocating) {
    MotionSource source = walk(30.0);
    expect_none(source, 40);
}

TEST_F(FramePath, LongIntervalsAreDividedWithoutAllocating) {
    MotionSource source = walk(8.0);
    expect_none(source, 10);
}

TEST_F(FramePath, TheLiveClockDropsFramesWithoutAllocating) {
    MotionSource source = walk(60.0);
    RunOptions options;
    options.realtime = true;
    expect_none(source, 10, std::move(options));
}

TEST_F(FramePath, TheFitMapsNumbersAreMeasuredWithoutAllocating) {
    MotionSource source = walk(30.0);
    TryOnRun run(source, *room_->person, {});
    ASSERT_TRUE(run.next());
    const auto& body = room_->body->model().rest;
    for (const WornGarment& worn : room_->person->garments()) {
        const auto& size = worn.garment().size();
        const auto& posed = room_->person->posed();
        garment::SkinGap gap(body.triangles, body.positions.size(), worn.positions.size());
        garment::ClothStrain strain(worn.triangles(), size.material_coords, worn.positions.size());
        std::vector<float> spread(worn.surfaces[0].positions.size());
        gap.find({posed.positions, posed.normals}, worn.positions);
        for (int i = 0; i < 3; ++i) {
            ASSERT_TRUE(run.next());
            test::AllocationCount count;
            gap.follow({posed.positions, posed.normals}, worn.positions);
            strain.measure(worn.positions);
            strain.measure_pressure(worn.positions, worn.normals, {300.0, 200.0});
            worn.on_surface(0, gap.gaps(), spread);
            EXPECT_EQ(count.stop(), 0u) << test::AllocationCount::first();
        }
    }
}

} // namespace
} // namespace toile::pipeline
