// The schedule of one frame with plugins that do little, and what happens when one of them fails.
#define TOILE_STATIC_PLUGIN
#include "pipeline/dressed_person.h"

#include "core/error.h"
#include "pipeline/frame_source.h"
#include "pipeline/try_on_run.h"
#include "sdk/cloth.h"
#include "sdk/garment.h"
#include "sdk/plugin.h"
#include "sdk/skinning.h"
#include "sdk/views.h"
#include "support/garments.h"
#include "support/meshes.h"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

namespace toile::pipeline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kLift = 0.25f; // what the fake cloth adds to its targets

// What the fake plugins are told to do, and what they saw.
struct Script {
    bool skinning_gives_nan = false;
    bool cloth_gives_nan = false;
    bool cloth_throws = false;
    std::vector<double> cloth_steps; // dt of each
    std::vector<std::uint32_t> cloth_flags;
};
Script script;

class FakeSkinning {
  public:
    static constexpr sdk::Info info{"test.skinning", "s", "1.0.0", "test"};
    using Kinds = sdk::Kinds<sdk::Skinning>;
    explicit FakeSkinning(sdk::Host) {}
    void bind(const toile_body& body, sdk::Job) {
        const auto rest = sdk::span_of<sdk::Float3>(body.rest.positions, "rest");
        rest_.assign(rest.begin(), rest.end());
    }
    // The whole surface follows the hips.
    void pose(const toile_body_state& state, toile_view_mut positions, toile_view_mut normals) {
        const auto joints = sdk::span_of<toile_joint>(state.joints, "joints");
        const auto out = sdk::span_of<sdk::Float3>(positions, "positions");
        for (std::size_t i = 0; i < out.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                out[i][k] = rest_[i][k] + joints[0].position[k];
        for (auto& n : sdk::span_of<sdk::Float3>(normals, "normals"))
            n = {0.0f, 1.0f, 0.0f};
        if (script.skinning_gives_nan) out[3][1] = kNaN;
    }

  private:
    std::vector<sdk::Float3> rest_;
};

class FakeGarment {
  public:
    static constexpr sdk::Info info{"test.garment", "g", "1.0.0", "test"};
    using Kinds = sdk::Kinds<sdk::Garment>;
    explicit FakeGarment(sdk::Host) {}
    void bind(const toile_body&, const toile_garment_package& package, sdk::Job,
              const toile_garment_binding& out) {
        const auto made = sdk::span_of<sdk::Float3>(package.simulation.positions, "simulation");
        bound_.assign(made.begin(), made.end());
        std::copy(made.begin(), made.end(),
                  sdk::span_of<sdk::Float3>(out.positions, "positions").begin());
        for (auto& weights : sdk::span_of<sdk::Float4>(out.joint_weights, "weights"))
            weights = {1.0f, 0.0f, 0.0f, 0.0f};
    }
    void targets(const toile_body_state& state, toile_view_mut positions) {
        const auto joints = sdk::span_of<toile_joint>(state.joints, "joints");
        const auto out = sdk::span_of<sdk::Float3>(positions, "positions");
        for (std::size_t i = 0; i < out.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                out[i][k] = bound_[i][k] + joints[0].position[k];
    }

  private:
    std::vector<sdk::Float3> bound_;
};

class FakeCloth {
  public:
    static constexpr sdk::Info info{"test.cloth", "c", "1.0.0", "test"};
    using Kinds = sdk::Kinds<sdk::Cloth>;
    explicit FakeCloth(sdk::Host) {}
    void set_body(const toile_body&, sdk::Job) {}
    std::uint32_t add_garment(const toile_cloth_garment&, sdk::Job) { return ++handles_; }
    void remove_garment(std::uint32_t) {}
    void step(const toile_cloth_step& step) {
        script.cloth_steps.push_back(step.dt_s);
        script.cloth_flags.push_back(step.flags);
        if (script.cloth_throws) throw std::runtime_error("the loom is torn");
        const auto targets = sdk::targets_of(step);
        const auto states = sdk::states_of(step);
        for (std::uint32_t g = 0; g < step.garment_count; ++g) {
            const auto in = sdk::span_of<sdk::Float3>(targets[g].positions, "targets");
            const auto out = sdk::span_of<sdk::Float3>(states[g].positions, "positions");
            for (std::size_t i = 0; i < in.size(); ++i)
                out[i] = {in[i][0], in[i][1] + kLift, in[i][2]};
            for (auto& n : sdk::span_of<sdk::Float3>(states[g].normals, "normals"))
                n = {0.0f, 0.0f, 1.0f};
            if (script.cloth_gives_nan) out[0][0] = kNaN;
        }
    }

  private:
    std::uint32_t handles_ = 0;
};

} // namespace
} // namespace toile::pipeline

TOILE_PLUGIN(test_skinning, toile::pipeline::FakeSkinning)
TOILE_PLUGIN(test_garment, toile::pipeline::FakeGarment)
TOILE_PLUGIN(test_cloth, toile::pipeline::FakeCloth)

namespace toile::pipeline {
namespace {

host::Manifest manifest_of(const toile_entry& entry) {
    const toile_descriptor& descriptor = *entry.describe(0);
    host::Manifest out;
    out.id = descriptor.id;
    out.version = descriptor.version;
    for (const char* const* kind = descriptor.kinds; *kind != nullptr; ++kind)
        out.provides.emplace_back(*kind);
    return out;
}

host::RegistryOptions no_discovery() {
    host::RegistryOptions out;
    out.environment = false;
    out.beside_program = false;
    return out;
}

// A box for a body, all of it on the hips.
std::shared_ptr<const BoundaryBody> box_body() {
    auto model = std::make_shared<body::BodyModel>();
    model->id = "box";
    model->rest = test::box(Vec3f(-0.2f, 0.0f, -0.1f), Vec3f(0.2f, 1.7f, 0.1f));
    model->rest.normals.assign(8, Vec3f::UnitY());
    model->skin.joints.assign(8, {0, 0, 0, 0});
    model->skin.weights.assign(8, {1.0f, 0.0f, 0.0f, 0.0f});
    model->parts.assign(8, body::Part::torso);
    model->skeleton.rest_positions.fill(Vec3f::Zero());
    return std::make_shared<const BoundaryBody>(std::move(model), 7);
}

// A flat square metre in front of it.
std::shared_ptr<const BoundaryGarment> sheet() {
    auto package = std::make_shared<garment::GarmentPackage>();
    package->manifest.id = "sheet";
    garment::GarmentSize size;
    size.entry.name = "M";
    size.simulation = test::grid(1.0f, 1.0f, 4, 4);
    for (const Triangle& t : size.simulation.triangles)
        for (const std::uint32_t v : t)
            size.material_coords.push_back(size.simulation.positions[v].head<2>());
    assets::Primitive primitive;
    primitive.positions = size.simulation.positions;
    primitive.triangles = size.simulation.triangles;
    size.render.meshes.emplace_back();
    size.render.meshes.back().primitives.push_back(primitive);
    package->sizes.push_back(std::move(size));
    return std::make_shared<const BoundaryGarment>(package, package->sizes[0], nullptr);
}

// A tube around it; `alpha` of its material.
std::shared_ptr<const BoundaryGarment> tube(const std::string& id, float radius, float low,
                                            float high, float alpha = 1.0f) {
    auto package = std::make_shared<garment::GarmentPackage>();
    package->manifest.id = id;
    package->sizes.push_back(test::tube_size("M", radius, low, high, 24, 30));
    for (assets::Material& material : package->sizes[0].render.materials)
        material.base_color.w() = alpha;
    return std::make_shared<const BoundaryGarment>(package, package->sizes[0], nullptr);
}

BodyFrame frame_at(float x, double time_s) {
    BodyFrame frame;
    frame.timestamp_ns = static_cast<std::int64_t>(time_s * 1e9);
    body::Pose pose;
    pose.hips_position = Vec3f(x, 0.0f, 0.0f);
    body::Skeleton skeleton;
    skeleton.rest_positions.fill(Vec3f::Zero());
    frame.joints = joints_of(body::forward_kinematics(skeleton, pose), 1.0f);
    return frame;
}

class DressedPersonTest : public testing::Test {
  protected:
    DressedPersonTest() {
        script = Script();
        for (const toile_entry* entry :
             {&toile_plugin_entry_test_skinning, &toile_plugin_entry_test_garment,
              &toile_plugin_entry_test_cloth})
            registry_.add(*entry, manifest_of(*entry));
    }

    DressedPerson& dress(std::vector<std::shared_ptr<const BoundaryGarment>> garments) {
        DressingOptions options;
        options.limits = host::sized<toile_limits>();
        options.limits.max_people = 1;
        options.limits.max_vertices = 1000;
        options.limits.max_triangles = 1000;
        options.limits.thread_count = 1;
        person_ = std::make_unique<DressedPerson>(registry_, services_, box_body(),
                                                  std::move(garments), options, job_);
        return *person_;
    }
    DressedPerson& person() { return person_ ? *person_ : dress({sheet()}); }
    void start_at_rest() {
        person().start(frame_at(0.0f, 0.0), clock_);
        script.cloth_steps.clear();
        script.cloth_flags.clear();
    }
    [[nodiscard]] float garment_x() { return person().garments()[0].positions[0].x(); }
    [[nodiscard]] float garment_y() { return person().garments()[0].positions[0].y(); }

    host::Services services_{1};
    host::Registry registry_{services_, no_discovery()};
    host::Job job_;
    StageClock clock_;
    std::unique_ptr<DressedPerson> person_;
};

TEST_F(DressedPersonTest, WhatOthersCoverIsNotDrawnButStillThere) {
    DressedPerson& person =
        dress({tube("shirt", 0.26f, 0.5f, 1.3f), tube("coat", 0.27f, 0.7f, 1.5f)});
    const WornGarment& shirt = person.garments()[0];
    const auto hidden = std::count(shirt.hidden.begin(), shirt.hidden.end(), 1);
    EXPECT_GT(hidden, 100);
    EXPECT_LT(hidden, static_cast<std::ptrdiff_t>(shirt.hidden.size()));
    EXPECT_LT(shirt.drawn_triangles(0).size(), shirt.surfaces[0].primitive->triangles.size());
    EXPECT_TRUE(person.garments()[1].hidden.empty()) << "nothing is worn over the coat";
    EXPECT_EQ(person.garments()[1].drawn_triangles(0).size(),
              person.garments()[1].surfaces[0].primitive->triangles.size());
    EXPECT_EQ(shirt.positions.size(), shirt.garment().size().simulation.positions.size());
}

TEST_F(DressedPersonTest, BeneathClothThatLetsLightThroughAllIsDrawn) {
    const auto lace = tube("lace", 0.27f, 0.3f, 1.5f, 0.4f);
    const DressedPerson& person = dress({tube("shirt", 0.26f, 0.5f, 1.3f), lace});
    const auto& hidden = person.garments()[0].hidden;
    EXPECT_EQ(std::count(hidden.begin(), hidden.end(), 1), 0);
}

TEST_F(DressedPersonTest, AFifthGarmentIsRefused) {
    std::vector<std::shared_ptr<const BoundaryGarment>> garments;
    for (const char* id : {"leggings", "skirt", "shirt", "coat", "cape"})
        garments.push_back(tube(id, 0.26f, 0.5f, 1.3f));
    const std::vector<std::shared_ptr<const BoundaryGarment>> four(garments.begin(),
                                                                   garments.end() - 1);
    EXPECT_EQ(dress(four).garments().size(), 4u);
    try {
        dress(garments);
        FAIL() << "five garments were put on";
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), testing::AllOf(HasSubstr("at most 4"), HasSubstr("cape")));
    }
}

TEST_F(DressedPersonTest, AFramePassesThroughEveryStage) {
    start_at_rest();
    person().step(frame_at(0.5f, 0.033), 0.033, clock_);
    EXPECT_FLOAT_EQ(person().posed().positions[0].x(), -0.2f + 0.5f);
    EXPECT_FLOAT_EQ(garment_x(), 0.5f);
    EXPECT_FLOAT_EQ(garment_y(), kLift);
    EXPECT_FLOAT_EQ(person().garments()[0].surfaces[0].positions[0].y(), kLift);
    EXPECT_THAT(person().faults(), IsEmpty());
}

TEST_F(DressedPersonTest, OnlyTheVeryFirstStepResets) {
    person().start(frame_at(0.0f, 0.0), clock_);
    ASSERT_GT(script.cloth_flags.size(), 30u); // one second of motion at least
    EXPECT_EQ(script.cloth_flags[0], TOILE_STEP_RESET);
    for (std::size_t i = 1; i < script.cloth_flags.size(); ++i)
        EXPECT_EQ(script.cloth_flags[i], TOILE_STEP_NONE);
}

TEST_F(DressedPersonTest, ALongIntervalIsDividedAndAVeryLongOneShortened) {
    start_at_rest();
    person().step(frame_at(0.1f, 0.1), 0.1, clock_);
    EXPECT_THAT(script.cloth_steps, testing::SizeIs(3));
    EXPECT_NEAR(script.cloth_steps[0] * 3.0, 0.1, 1e-12);
    script.cloth_steps.clear();
    person().step(frame_at(0.2f, 60.0), 60.0, clock_);
    EXPECT_THAT(script.cloth_steps, testing::SizeIs(16));
    EXPECT_LE(script.cloth_steps[0], 0.045);
}

TEST_F(DressedPersonTest, NaNFromSkinningSwitchesItOffAndPlainSkinningGoesOn) {
    start_at_rest();
    script.skinning_gives_nan = true;
    person().step(frame_at(0.5f, 0.033), 0.033, clock_);
    script.skinning_gives_nan = false;
    person().step(frame_at(0.75f, 0.066), 0.033, clock_);
    EXPECT_FLOAT_EQ(person().posed().positions[3].y(), 1.7f);
    EXPECT_FLOAT_EQ(person().posed().positions[0].x(), -0.2f + 0.75f);
    EXPECT_THAT(person().faults(), ElementsAre(HasSubstr("test.skinning is switched off")));
}

TEST_F(DressedPersonTest, NaNFromClothLeavesTheGarmentOnItsTargets) {
    start_at_rest();
    script.cloth_gives_nan = true;
    person().step(frame_at(0.5f, 0.033), 0.033, clock_);
    EXPECT_FLOAT_EQ(garment_x(), 0.5f);
    EXPECT_FLOAT_EQ(garment_y(), 0.0f); // the target, not what the cloth would add
    EXPECT_THAT(person().faults(), ElementsAre(HasSubstr("test.cloth is switched off")));
    const std::size_t steps = script.cloth_steps.size();
    person().step(frame_at(0.6f, 0.066), 0.033, clock_);
    EXPECT_EQ(script.cloth_steps.size(), steps) << "a plugin that is off was called";
    EXPECT_FLOAT_EQ(garment_x(), 0.6f);
}

TEST_F(DressedPersonTest, AThrowingClothLosesItsFrameOnlyUntilItDoesSoAgainAndAgain) {
    start_at_rest();
    script.cloth_throws = true;
    person().step(frame_at(0.1f, 0.033), 0.033, clock_);
    EXPECT_FLOAT_EQ(garment_y(), 0.0f);
    EXPECT_THAT(person().faults(), IsEmpty());
    script.cloth_throws = false;
    person().step(frame_at(0.2f, 0.066), 0.033, clock_);
    EXPECT_FLOAT_EQ(garment_y(), kLift);
    EXPECT_EQ(script.cloth_flags.back(), TOILE_STEP_RESET) << "it starts afresh";
    script.cloth_throws = true;
    for (int i = 3; i < 40; ++i)
        person().step(frame_at(0.2f, 0.033 * i), 0.033, clock_);
    EXPECT_THAT(person().faults(), ElementsAre(HasSubstr("the loom is torn")));
}

// A source of `count` frames, `period_s` apart.
class CountingSource : public FrameSource {
  public:
    CountingSource(int count, double period_s) : count_(count), period_s_(period_s) {}
    toile_status next(BodyFrame& out) noexcept override {
        if (next_ >= count_) return TOILE_END_OF_STREAM;
        out = frame_at(0.01f * static_cast<float>(next_), period_s_ * next_);
        out.sequence = static_cast<std::uint32_t>(next_++);
        return TOILE_OK;
    }
    std::string error() override { return "counting"; }

  private:
    int count_;
    double period_s_;
    int next_ = 0;
};

TEST_F(DressedPersonTest, ALockStepRunUsesEveryFrameAndRepeatsItself) {
    std::string digest;
    for (int repeat = 0; repeat < 2; ++repeat) {
        person_.reset();
        CountingSource source(10, 1.0 / 30.0);
        TryOnRun run(source, person(), {});
        while (run.next()) {
        }
        const RunReport report = run.report();
        EXPECT_EQ(report.frames, 10u);
        EXPECT_EQ(report.dropped, 0u);
        EXPECT_FALSE(report.garment_state_latency.has_value());
        if (repeat == 0) digest = report.positions_digest;
        EXPECT_EQ(report.positions_digest, digest);
    }
}

TEST_F(DressedPersonTest, ARunStopsAfterAsManyFramesAsAskedFor) {
    CountingSource source(10, 1.0 / 30.0);
    RunOptions options;
    options.most_frames = 4;
    TryOnRun run(source, person(), options);
    int frames = 0;
    while (run.next())
        ++frames;
    EXPECT_EQ(frames, 4);
}

TEST_F(DressedPersonTest, ALiveRunDropsWhatComesTooLate) {
    CountingSource source(100, 0.001); // a thousand a second
    RunOptions options;
    options.realtime = true;
    TryOnRun run(source, person(), options);
    while (run.next()) {
        run.begin_drawing();
        const double start = wall_seconds();
        while (wall_seconds() - start < 0.03) {
        }
        run.end_drawing();
    }
    const RunReport report = run.report();
    EXPECT_GT(report.dropped, 0u);
    EXPECT_LE(report.frames + report.dropped, 100u);
    ASSERT_TRUE(report.picture_latency.has_value());
    EXPECT_GE(report.picture_latency->median_ms, 29.0);
}

TEST_F(DressedPersonTest, ASourceWhoseTimeStandsStillIsRefused) {
    CountingSource source(3, 0.0);
    TryOnRun run(source, person(), {});
    ASSERT_TRUE(run.next());
    EXPECT_THROW((void)run.next(), Error);
}

} // namespace
} // namespace toile::pipeline
