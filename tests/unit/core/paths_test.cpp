// Where data is looked for, and in which order.
#include "core/paths.h"

#include "support/temporary_folder.h"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>
#include <optional>

namespace toile {
namespace {

namespace fs = std::filesystem;

// TOILE_DATA_PATH as a test wants it; what it was comes back at the end.
class DataPath {
  public:
    explicit DataPath(const std::optional<std::string>& value) {
        if (const char* old = std::getenv("TOILE_DATA_PATH")) old_ = old;
        set(value);
    }
    ~DataPath() { set(old_); }
    DataPath(const DataPath&) = delete;
    DataPath& operator=(const DataPath&) = delete;

  private:
    static void set(const std::optional<std::string>& value) {
        if (value)
            setenv("TOILE_DATA_PATH", value->c_str(), 1);
        else
            unsetenv("TOILE_DATA_PATH");
    }
    std::optional<std::string> old_;
};

TEST(Paths, TheProgramStandsInItsFolder) {
    const fs::path folder = program_folder();
    EXPECT_TRUE(folder.is_absolute());
    EXPECT_TRUE(
        fs::equivalent(folder / fs::read_symlink("/proc/self/exe").filename(), "/proc/self/exe"));
}

TEST(Paths, DataOfTheEnvironmentComesFirstInItsOrder) {
    const test::TemporaryFolder a;
    const test::TemporaryFolder b;
    const test::TemporaryFolder without;
    fs::create_directory(a / "avatars");
    fs::create_directory(b / "avatars");
    const DataPath path(b.path().string() + ":" + without.path().string() +
                        "::/no/such/root:" + a.path().string());
    const auto folders = data_folders("avatars");
    ASSERT_GE(folders.size(), 2u);
    EXPECT_EQ(folders[0], b / "avatars");
    EXPECT_EQ(folders[1], a / "avatars");
    for (const fs::path& folder : folders)
        EXPECT_TRUE(fs::is_directory(folder)) << folder;
}

TEST(Paths, AFileIsNoDataFolder) {
    const test::TemporaryFolder root;
    fs::copy_file("/proc/self/comm", root / "avatars"); // any file
    const DataPath path(root.path().string());
    const auto folders = data_folders("avatars");
    EXPECT_EQ(std::count(folders.begin(), folders.end(), root / "avatars"), 0);
}

TEST(Paths, WithoutTheEnvironmentDataStandsBesideTheProgram) {
    const DataPath path(std::nullopt);
    for (const fs::path& folder : data_folders("avatars"))
        EXPECT_EQ(folder.string().rfind(program_folder().string(), 0), 0u) << folder;
    EXPECT_TRUE(data_folders("no such kind").empty());
}

} // namespace
} // namespace toile
