#include "kinect_log_source/kinect_log.h"

#include "core/error.h"
#include "support/shared_data.h"

#include <gtest/gtest.h>
#include <sstream>

namespace toile::kinect_log_source {
namespace {

/// A line of `joints` joints, all at (0.5, 1, 2) and tracked.
std::string line(std::int64_t time, std::size_t joints = 25) {
    std::string out = std::to_string(time);
    for (std::size_t j = 0; j < joints; ++j)
        out += ",0.5,1,2,2";
    return out + "\n";
}

std::string refusal(const std::string& text) {
    try {
        (void)parse_kinect_log(text, "a.csv");
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

TEST(KinectLog, ReadsBothJointCountsLineEndsAndATrailingComma) {
    for (const std::size_t joints : {std::size_t{20}, std::size_t{25}}) {
        std::string text = line(100, joints) + line(330100, joints);
        text.insert(text.find('\n'), ",\r");
        const KinectLog log = parse_kinect_log(text, "a.csv");
        EXPECT_EQ(log.joint_count, joints);
        ASSERT_EQ(log.frames.size(), 2u);
        EXPECT_EQ(log.frames[1].time_100ns, 330100);
        EXPECT_EQ(log.frames[0].joints[joints - 1].position, Vec3f(0.5f, 1.0f, 2.0f));
        EXPECT_EQ(log.frames[0].joints[joints - 1].state, 2);
    }
    const std::string text = line(1);
    EXPECT_EQ(parse_kinect_log(text.substr(0, text.size() - 1), "a.csv").frames.size(), 1u);
}

TEST(KinectLog, EveryBadLineIsNamed) {
    const std::string good = line(1) + line(2);
    EXPECT_EQ(refusal(""), "a.csv: is empty; a body log has a line per frame");
    EXPECT_NE(refusal(good + "\n" + line(3)).find("a.csv: line 3: blank"), std::string::npos);
    EXPECT_NE(refusal(good + "3,1,2\n").find("line 3: 3 fields"), std::string::npos);
    EXPECT_NE(refusal(good + line(3, 20)).find("line 3: 20 joints"), std::string::npos);
    EXPECT_NE(refusal(good + line(2)).find("line 3: the time 2 is not after"), std::string::npos);
    EXPECT_NE(refusal(good + line(1)).find("line 3: the time 1"), std::string::npos);
    EXPECT_NE(
        refusal(good + replaced(line(3), "0.5", "NaN")).find("line 3: SpineBase.x is not finite"),
        std::string::npos);
    EXPECT_NE(refusal(good + replaced(line(3), "0.5,1", "0.5,one")).find("SpineBase.y is 'one'"),
              std::string::npos);
    EXPECT_NE(refusal(good + replaced(line(3), "0.5", "")).find("is '', not a number"),
              std::string::npos);
    EXPECT_NE(refusal(good + replaced(line(3), "0.5", "500")).find("farther than 50 m"),
              std::string::npos);
    EXPECT_NE(refusal(good + replaced(line(3), "2,2", "2,3")).find("tracking state is 3"),
              std::string::npos);
    EXPECT_NE(refusal("time,x,y\n").find("line 1: 3 fields"), std::string::npos);
    EXPECT_NE(refusal(replaced(line(1), "1,", "x,")).find("line 1: the time is 'x'"),
              std::string::npos);
}

TEST(KinectLog, AMissingFileOrAFolderIsAnError) {
    EXPECT_THROW((void)load_kinect_log("/no/such/file.csv"), FileError);
    EXPECT_THROW((void)load_kinect_log("/"), FileError);
}

TEST(KinectLog, ReadsEverySharedLog) {
    TOILE_SHARED_DATA_OR_SKIP(folder, "kinect2_laban_gestures");
    std::size_t files = 0;
    std::size_t frames = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".csv") continue;
        const KinectLog log = load_kinect_log(entry.path());
        EXPECT_EQ(log.joint_count, 25u);
        frames += log.frames.size();
        ++files;
    }
    EXPECT_EQ(files, 7u);
    EXPECT_EQ(frames, 1421u);
}

} // namespace
} // namespace toile::kinect_log_source
