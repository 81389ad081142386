// toile garment new: a retailer's mesh and size chart.
#include "core/bytes.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <filesystem>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace toile::test {
namespace {

using testing::HasSubstr;

class GarmentNew : public testing::Test {
  protected:
    void SetUp() override {
        write_text(folder_ / "sizes.csv", "size,bust,hip\nM,96-104,\nL,,110\n");
    }
    [[nodiscard]] std::string at(const char* name) const { return (folder_ / name).string(); }
    ProgramResult make(const std::string& size, const char* out) {
        return run_toile({"garment", "new", "--mesh", TOILE_SOURCE_DIR "/garments/tee/tee-M.glb",
                          "--id", out, "--kind", "t-shirt", "--size", size, "--chart",
                          at("sizes.csv"), "--made-on", "men-m", "--out", at(out)});
    }
    TemporaryFolder folder_;
};

TEST_F(GarmentNew, AMeshAndAChartAreAPackageThatIsWorn) {
    const ProgramResult made = make("M", "shop-tee");
    ASSERT_EQ(made.status, 0) << made.output;
    EXPECT_THAT(made.output, HasSubstr("of the chart's L there is none"));
    EXPECT_THAT(made.output, HasSubstr("its mesh 'simulation' is the cloth"));
    const auto bytes = read_bytes(folder_ / "shop-tee" / "garment.json", 1u << 20);
    const auto size = nlohmann::json::parse(bytes.begin(), bytes.end())["sizes"][0];
    EXPECT_EQ(size["name"], "M");
    ASSERT_EQ(size["chart"].size(), 1u);
    EXPECT_DOUBLE_EQ(size["chart"]["bust_girth"]["min"], 0.96);
    EXPECT_DOUBLE_EQ(size["chart"]["bust_girth"]["max"], 1.04);
    ASSERT_EQ(run_toile({"garment", "check", at("shop-tee")}).status, 0);
    const ProgramResult worn =
        run_toile({"tryon", "--body", "men-m", "--garment", at("shop-tee"), "--quality", "fast",
                   "--picture", "180x240", "--out", at("look.png")});
    EXPECT_EQ(worn.status, 0) << worn.output;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "look.png"));
}

TEST_F(GarmentNew, ASizeThatTheChartHasNotIsRefusedAndNothingWritten) {
    const ProgramResult made = make("XL", "shop-tee");
    EXPECT_EQ(made.status, 2);
    EXPECT_THAT(made.output, HasSubstr("--size XL"));
    EXPECT_THAT(made.output, HasSubstr("M, L"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "shop-tee"));
}

} // namespace
} // namespace toile::test
