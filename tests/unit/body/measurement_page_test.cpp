// docs/measurements.md says of every landmark and measurement what the code says.
#include "body/landmarks.h"
#include "body/measurement.h"
#include "core/bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace toile::body {
namespace {

using testing::HasSubstr;

std::string page() {
    const auto bytes =
        read_bytes(std::filesystem::path(TOILE_SOURCE_DIR) / "docs/measurements.md", 1u << 20);
    return {bytes.begin(), bytes.end()};
}

TEST(MeasurementPage, HasARowForEveryMeasurement) {
    const std::string text = page();
    for (const MeasurementDefinition& definition : measurement_definitions()) {
        const std::string column = definition.ansur_column.empty()
                                       ? std::string()
                                       : "`" + std::string(definition.ansur_column) + "`";
        EXPECT_THAT(text, HasSubstr("| `" + std::string(definition.name) + "` | " +
                                    std::string(definition.text) + " | " + column + " |\n"));
    }
}

TEST(MeasurementPage, NamesEveryLandmark) {
    const std::string text = page();
    for (std::size_t i = 0; i < kLandmarkCount; ++i)
        EXPECT_THAT(text,
                    HasSubstr("`" + std::string(landmark_name(static_cast<Landmark>(i))) + "`"));
}

} // namespace
} // namespace toile::body
