// Discovery and choice: folders, priorities, schemes.
#include "abi/zoo.h"
#include "host/instance.h"
#include "host/registry.h"
#include "host/trial.h"

#include <cstdlib>
#include <functional>
#include <gmock/gmock.h>

namespace toile::host {
namespace {

using test::Zoo;
using ::testing::HasSubstr;

RegistryOptions only(const Zoo& zoo) {
    return {.folders = {zoo.folder()}, .environment = false, .beside_program = false};
}

std::string error_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

std::string manifest(const std::string& id, const std::string& more) {
    return R"({"id":")" + id +
           R"(","version":"1.0.0","abi":{"major":1,"minor":0},"library":"libzoo.so",)" + more + "}";
}

TEST(Registry, RanksByPriorityThenById) {
    Zoo zoo;
    const std::string kind = R"("provides":["toile.cloth/1"])";
    zoo.write_manifest("c", manifest("acme.c", kind));
    zoo.write_manifest("b", manifest("acme.b", kind));
    zoo.write_manifest("a", manifest("acme.a", kind + R"(,"priority":-5)"));
    zoo.write_manifest("d", manifest("acme.d", kind + R"(,"priority":7)"));
    zoo.write_manifest("e", manifest("acme.e", R"("provides":["toile.skinning/1"])"));
    Services services(1);
    const Registry registry(services, only(zoo));
    std::vector<std::string> ids;
    for (const Manifest& m : registry.manifests(TOILE_CLOTH))
        ids.push_back(m.id);
    EXPECT_THAT(ids, ::testing::ElementsAre("acme.d", "acme.b", "acme.c", "acme.a"));
    EXPECT_EQ(registry.manifests().size(), 5u);
}

TEST(Registry, FindsThePluginOfAScheme) {
    Zoo zoo;
    zoo.add("good");
    zoo.write_manifest("good", manifest("zoo.animal", R"("provides":["toile.skinning/1"],)"
                                                      R"("schemes":["zoo-log"])"));
    Services services(1);
    Registry registry(services, only(zoo));
    EXPECT_EQ(registry.find_scheme("zoo-log")->id(), "zoo.animal");
    EXPECT_EQ(error_of([&] { (void)registry.find_scheme("tape"); }),
              "no plugin serves the source 'tape:'; known are zoo-log:");
}

TEST(Registry, SaysWhatIsMissing) {
    Zoo zoo;
    zoo.add("call_missing");
    Services services(1);
    Registry registry(services, only(zoo));
    EXPECT_THAT(error_of([&] { (void)registry.find(TOILE_SKINNING); }),
                HasSubstr("no plugin for 'toile.skinning/1'; see `toile plugin list`"));
    EXPECT_THAT(error_of([&] { (void)registry.find(TOILE_SKINNING, "zoo.animal"); }),
                HasSubstr("lacks the call 'pose'"));
    EXPECT_THAT(
        error_of([&] { const Registry lost(services, {.folders = {zoo.folder() / "nowhere"}}); }),
        HasSubstr("no such folder to look for plugins in"));
}

TEST(Registry, LooksWhereTheEnvironmentSays) {
    Zoo first;
    Zoo second;
    first.add("good");
    second.add("good", "zoo.animal", 9);
    const std::string path = first.folder().string() + ":" + second.folder().string();
    setenv("TOILE_PLUGIN_PATH", path.c_str(), 1);
    Services services(1);
    const Registry registry(services, {.beside_program = false});
    unsetenv("TOILE_PLUGIN_PATH");
    ASSERT_EQ(registry.manifests().size(), 1u);
    EXPECT_EQ(registry.manifests()[0].priority, 0) << "the first found counts";
    ASSERT_EQ(registry.refused().size(), 1u);
    EXPECT_EQ(registry.refused()[0].reason, Refusal::duplicate_id);
}

TEST(Registry, ManifestsAreFoundFromLibrariesAndFolders) {
    Zoo zoo;
    const auto file = zoo.add("good");
    const auto folder = file.parent_path();
    for (const auto& path : {file, folder, folder / "libzoo.so"})
        EXPECT_THAT(manifests_of(path), ::testing::ElementsAre(file)) << path;
    EXPECT_THAT(error_of([&] { (void)manifests_of(zoo.folder()); }),
                HasSubstr("holds no plugin.json"));
    EXPECT_THAT(error_of([&] { (void)manifests_of(folder / "x.so"); }), HasSubstr("no such file"));
    std::ofstream(folder / "libother.so") << "x";
    EXPECT_THAT(error_of([&] { (void)manifests_of(folder / "libother.so"); }),
                HasSubstr("no plugin.json beside it names this library"));
}

TEST(Instance, TurnsStatusesIntoErrorsWithTheReportedText) {
    Zoo zoo;
    Services services(1);
    Registry registry(services, only(zoo));
    const auto plugin = Plugin::load(read_manifest(zoo.add("bind_fails")));
    Instance instance(plugin, services);
    const auto& table = instance.table<toile_skinning>();
    EXPECT_EQ(error_of([&] {
                  instance.call("bind", [&](auto* i) { return table.bind(i, nullptr, nullptr); });
              }),
              "zoo.animal: bind: the weights file is gone");
    EXPECT_EQ(error_of([&] { instance.call("bind", [](auto*) -> toile_status { throw 1; }); }),
              "zoo.animal: bind: threw an exception across the boundary");
    EXPECT_THROW(instance.call("bind", [](auto*) -> toile_status { return TOILE_CANCELLED; }),
                 Cancelled);
    EXPECT_EQ(instance.frame([](auto*) -> toile_status { throw 1; }), TOILE_E_INTERNAL);
    EXPECT_EQ(instance.find<toile_cloth>(), nullptr);
    EXPECT_EQ(error_of([&] { (void)instance.table<toile_cloth>(); }),
              "zoo.animal: does not offer 'toile.cloth/1'");
}

} // namespace
} // namespace toile::host
