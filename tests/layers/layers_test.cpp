// The arrows between the folders, and that adding a forbidden one is noticed.
#include "layers/layer_rules.h"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LayersTest : public testing::Test {
  protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        root_ = fs::path(testing::TempDir()) / (std::string("toile_layers_") + info->name());
        fs::remove_all(root_);
        fs::create_directories(root_ / "engine");
        fs::create_directories(root_ / "plugins");
    }
    void TearDown() override { fs::remove_all(root_); }

    void write(const std::string& file, const std::string& text) {
        fs::create_directories((root_ / file).parent_path());
        std::ofstream(root_ / file) << text;
    }

    fs::path root_;
};

TEST(Layers, TheTreeHasOnlyTheArrowsOfTheDesign) {
    EXPECT_THAT(check_layers(TOILE_SOURCE_DIR), IsEmpty());
}

TEST_F(LayersTest, AnAllowedTransitiveArrowPasses) {
    write("engine/body/a.h",
          "#include \"core/types.h\"\n#include <vector>\n#include <Eigen/Core>\n");
    EXPECT_THAT(check_layers(root_), IsEmpty());
}

TEST_F(LayersTest, AnUpwardIncludeIsFound) {
    write("engine/core/a.h", "#pragma once\n#include \"geometry/mesh.h\"\n");
    EXPECT_THAT(check_layers(root_),
                ElementsAre(HasSubstr("engine/core/a.h:2: core may not include geometry")));
}

TEST_F(LayersTest, ASidewaysIncludeIsFound) {
    write("engine/host/a.cpp", "#include \"body/skeleton.h\"\n");
    EXPECT_THAT(check_layers(root_), ElementsAre(HasSubstr("host may not include body")));
}

TEST_F(LayersTest, AnUpwardLinkLineIsFound) {
    write("engine/geometry/CMakeLists.txt", "toile_add_layer(geometry DEPENDS core body)\n");
    EXPECT_THAT(check_layers(root_), ElementsAre(HasSubstr("geometry may not link body")));
}

TEST_F(LayersTest, AThirdPartyLibraryOutsideItsLayerIsFound) {
    write("engine/garment/a.cpp", "#include <embree3/rtcore.h>\n");
    write("engine/body/CMakeLists.txt", "toile_add_layer(body DEPENDS assets LINK glfw)\n");
    EXPECT_THAT(check_layers(root_), ElementsAre(HasSubstr("body may not link GLFW"),
                                                 HasSubstr("garment may not include Embree")));
}

TEST_F(LayersTest, APluginMayNotReachTheHostNorAnotherPlugin) {
    write("plugins/one/a.cpp",
          "#include \"host/registry.h\"\n#include \"two/b.h\"\n#include \"one/b.h\"\n");
    EXPECT_THAT(check_layers(root_), ElementsAre(HasSubstr("one may not include host"),
                                                 HasSubstr("unknown header two/b.h")));
}

TEST_F(LayersTest, AFolderThatIsNoLayerIsFound) {
    write("engine/util/a.h", "#pragma once\n");
    EXPECT_THAT(check_layers(root_), ElementsAre(HasSubstr("engine/util")));
}

} // namespace
} // namespace toile::test
