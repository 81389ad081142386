#include "body/skeleton_tables.h"

#include "support/shared_data.h"

#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <set>

namespace toile::body {
namespace {

std::string_view first_name(const SkeletonTable& table, Joint joint) {
    return table.joints[table.sources[static_cast<std::size_t>(joint)].first];
}

TEST(SkeletonTables, EveryJointHasASourceInRangeAndEveryNameIsUnique) {
    for (const SkeletonTable* table : all_tables()) {
        EXPECT_EQ(std::set(table->joints.begin(), table->joints.end()).size(), table->joints.size())
            << table->name;
        for (std::size_t i = 0; i < kJointCount; ++i) {
            const JointBlend& blend = table->sources[i];
            EXPECT_LT(blend.first, table->joints.size()) << table->name << " " << i;
            EXPECT_LT(blend.second, table->joints.size()) << table->name << " " << i;
            EXPECT_EQ(blend.direct(), blend.fraction == 0.0f);
        }
        for (const std::string_view joint : table->joints)
            EXPECT_TRUE(table->find(joint));
        EXPECT_FALSE(table->find("no such joint"));
    }
}

TEST(SkeletonTables, HaveTheSizesOfTheirSystems) {
    EXPECT_EQ(kinect_v1_table().joints.size(), 20u);
    EXPECT_EQ(kinect_v2_table().joints.size(), 25u);
    EXPECT_EQ(azure_kinect_table().joints.size(), 32u);
    EXPECT_EQ(kinect_v2_table().find("SpineShoulder"), 20u);
    EXPECT_EQ(kinect_v2_table().find("FootRight"), 19u);
    EXPECT_EQ(kinect_v1_table().find("FootRight"), 19u);
    EXPECT_EQ(azure_kinect_table().find("HEAD"), 26u);
}

TEST(SkeletonTables, LeftStaysLeftAndLimbsMapDirectly) {
    const auto lower = [](std::string_view text) {
        std::string out(text);
        std::transform(out.begin(), out.end(), out.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        return out;
    };
    for (const SkeletonTable* table : all_tables()) {
        for (std::size_t i = 0; i < kJointCount; ++i) {
            const auto joint = static_cast<Joint>(i);
            const std::string ours(joint_name(joint));
            for (const std::string side : {"left", "right"}) {
                if (!ours.starts_with(side)) continue;
                const JointBlend& blend = table->sources[i];
                EXPECT_NE(lower(table->joints[blend.second]).find(side), std::string::npos)
                    << table->name << " " << ours;
                if (!ours.ends_with("Shoulder")) {
                    EXPECT_TRUE(blend.direct()) << table->name << " " << ours;
                }
            }
        }
    }
    EXPECT_EQ(first_name(kinect_v2_table(), Joint::left_hand), "WristLeft");
    EXPECT_EQ(first_name(azure_kinect_table(), Joint::right_foot), "ANKLE_RIGHT");
    EXPECT_EQ(first_name(mixamo_table(), Joint::left_upper_arm), "LeftArm");
}

TEST(SkeletonTables, APrefixIsIgnoredAndAMissingJointIsNoticed) {
    std::vector<std::string> names;
    for (const std::string_view joint : mixamo_table().joints)
        names.push_back("mixamorig:" + std::string(joint));
    names.emplace_back("mixamorig:LeftHandThumb1");
    EXPECT_EQ(find_table(names), &mixamo_table());
    names.erase(names.begin() + 3);
    EXPECT_EQ(find_table(names), nullptr);
}

TEST(SkeletonTables, KnowEveryMotionOfTheSharedSet) {
    TOILE_SHARED_DATA_OR_SKIP(folder, "bvh_motions");
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".bvh") continue;
        std::ifstream in(entry.path());
        std::vector<std::string> names;
        for (std::string word; in >> word && word != "MOTION";) {
            if (word == "ROOT" || word == "JOINT") names.emplace_back((in >> word, word));
        }
        const SkeletonTable* const table = find_table(names);
        ASSERT_NE(table, nullptr) << entry.path();
        const bool arm_is_shoulder = std::count(names.begin(), names.end(), "LeftCollar") > 0;
        EXPECT_EQ(first_name(*table, Joint::left_upper_arm),
                  arm_is_shoulder ? "LeftShoulder" : "LeftArm");
        ++files;
    }
    EXPECT_GE(files, 5u);
}

} // namespace
} // namespace toile::body
