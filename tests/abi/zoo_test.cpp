// The zoo: one bad plugin per refusal, each with its reason and its one line.
#include "abi/zoo.h"

#include "abi/skinning.h"
#include "host/registry.h"
#include "host/trial.h"

#include <gmock/gmock.h>
#include <set>
#include <span>

namespace toile::host {
namespace {

using test::Zoo;
using ::testing::HasSubstr;

struct Animal {
    const char* name;
    Refusal reason;
    const char* text; ///< the whole line, or its beginning where it ends with "..."
    double timeout_s = 20.0;
};

void expect_refused(const RefusedPlugin& refused, const Animal& animal) {
    EXPECT_EQ(refusal_name(refused.reason), refusal_name(animal.reason)) << refused.text;
    const std::string wanted = animal.text;
    if (wanted.ends_with("..."))
        EXPECT_THAT(refused.text, ::testing::StartsWith(wanted.substr(0, wanted.size() - 3)));
    else
        EXPECT_EQ(refused.text, wanted);
    EXPECT_EQ(refused.text.find('\n'), std::string::npos) << "more than one line";
}

RefusedPlugin checked(const std::filesystem::path& manifest, double timeout_s) {
    try {
        try_contract(read_manifest(manifest), timeout_s);
    } catch (const PluginRefused& e) {
        return {manifest, "", e.reason(), e.detail()};
    }
    return {};
}

// ---- wrong before the library is opened ----------------------------------------------------
struct WrongManifest {
    const char* name;
    const char* json; ///< what plugin.json holds
    Refusal reason;
    const char* text;
};

class ZooManifest : public ::testing::TestWithParam<WrongManifest> {};

TEST_P(ZooManifest, IsRefused) {
    const WrongManifest& wrong = GetParam();
    Zoo zoo;
    zoo.write_manifest(wrong.name, wrong.json);
    Services services(1);
    Registry registry(services,
                      {.folders = {zoo.folder()}, .environment = false, .beside_program = false});
    registry.load_all();
    ASSERT_EQ(registry.refused().size(), 1u);
    expect_refused(registry.refused()[0], {wrong.name, wrong.reason, wrong.text});
    EXPECT_TRUE(registry.manifests().empty());
}

#define HEAD R"({"id":"zoo.animal","version":"1.0.0","library":"libzoo.so",)"
#define ABI R"("abi":{"major":1,"minor":0},)"
#define KINDS R"("provides":["toile.skinning/1"])"

const WrongManifest kWrongManifests[] = {
    {"not_json", "{\"id\": ", Refusal::manifest_unreadable, "not valid JSON at byte 8"},
    {"empty", "", Refusal::manifest_unreadable, "not valid JSON at byte 1"},
    {"binary", "\x7f\x45\x4c\x46\x02", Refusal::manifest_unreadable, "not valid JSON at byte 1"},
    {"key_twice", R"({"id":"a","id":"b"})", Refusal::manifest_unreadable,
     "the key 'id' stands twice in one object"},
    {"not_object", "[]", Refusal::manifest_invalid, "/: must be an object"},
    {"abi_major", HEAD R"("abi":{"major":2,"minor":0},)" KINDS "}", Refusal::manifest_abi_major,
     "built for ABI 2.0, this engine has 1.0: build it against this engine's headers"},
    {"abi_newer", HEAD R"("abi":{"major":1,"minor":9},"later":1,)" KINDS "}",
     Refusal::manifest_abi_newer, "built for ABI 1.9, this engine has 1.0: update the engine"},
    {"abi_text", HEAD R"("abi":"1.0",)" KINDS "}", Refusal::manifest_invalid,
     "/abi: must be an object"},
    {"unknown_key", HEAD ABI R"("provide":1,)" KINDS "}", Refusal::manifest_unknown_key,
     "/provide: is not a known key"},
    {"no_version", R"({"id":"zoo.animal","library":"libzoo.so",)" ABI KINDS "}",
     Refusal::manifest_invalid, "/version: is missing"},
    {"bad_version", R"({"id":"zoo.animal","version":"one","library":"libzoo.so",)" ABI KINDS "}",
     Refusal::manifest_invalid, "/version: 'one' must read like 1.2.3"},
    {"bad_id", R"({"id":"Zoo Animal","version":"1.0.0","library":"libzoo.so",)" ABI KINDS "}",
     Refusal::manifest_invalid, "/id: 'Zoo Animal' must be lower case words joined by dots"},
    {"path_library",
     R"({"id":"zoo.animal","version":"1.0.0","library":"../libzoo.so",)" ABI KINDS "}",
     Refusal::manifest_invalid, "/library: must be the name of a file beside the manifest"},
    {"provides_nothing", HEAD ABI R"("provides":[]})", Refusal::manifest_invalid,
     "/provides: must name at least one kind"},
    {"kind_revision", HEAD ABI R"("provides":["toile.skinning/2"]})", Refusal::kind_unknown,
     "provides 'toile.skinning/2', a kind or revision that this engine does not know"},
    {"need", HEAD ABI R"("needs":["toile.gpu/1"],)" KINDS "}", Refusal::need_unknown,
     "needs 'toile.gpu/1', which this engine does not offer"},
    {"tool_without_command", HEAD ABI R"("provides":["toile.tool/1"]})", Refusal::manifest_invalid,
     "/command: must tell the words of what provides toile.tool/1"},
    {"scanner_without_method", HEAD ABI R"("provides":["toile.scanner/1"]})",
     Refusal::manifest_invalid, "/method: must name what provides toile.scanner/1"},
    {"method_without_scanner", HEAD ABI R"("method":"fusion",)" KINDS "}",
     Refusal::manifest_invalid, "/method: is for plugins that provide toile.scanner/1"},
    {"method_of_two_words", HEAD ABI R"("method":"Fuse It","provides":["toile.scanner/1"]})",
     Refusal::manifest_invalid, "/method: 'Fuse It' must be one word of a-z and -"},
    {"command_without_tool", HEAD ABI R"("command":{"words":"fly","summary":"Flies"},)" KINDS "}",
     Refusal::manifest_invalid, "/command: is for plugins that provide toile.tool/1"},
    {"command_of_wrong_words",
     HEAD ABI R"("command":{"words":"fly  High","summary":""},"provides":["toile.tool/1"]})",
     Refusal::manifest_invalid,
     "/command/words: 'fly  High' must be one to three words of a-z and -, joined by single "
     "blanks"},
    {"no_library", HEAD ABI KINDS "}", Refusal::library_missing,
     "library 'libzoo.so': no such file beside the manifest"},
};

INSTANTIATE_TEST_SUITE_P(All, ZooManifest, ::testing::ValuesIn(kWrongManifests),
                         [](const auto& tested) { return tested.param.name; });

TEST(Zoo, AManifestThatIsAFolderIsRefused) {
    Zoo zoo;
    std::filesystem::create_directories(zoo.folder() / "x" / "plugin.json");
    Services services(1);
    const Registry registry(
        services, {.folders = {zoo.folder()}, .environment = false, .beside_program = false});
    ASSERT_EQ(registry.refused().size(), 1u);
    expect_refused(registry.refused()[0],
                   {"", Refusal::manifest_unreadable, "is not a regular file"});
}

TEST(Zoo, ASecondPluginOfOneIdIsRefused) {
    Zoo zoo;
    zoo.add("good");
    zoo.add("good_copy");
    Services services(1);
    Registry registry(services,
                      {.folders = {zoo.folder()}, .environment = false, .beside_program = false});
    registry.load_all();
    ASSERT_EQ(registry.manifests().size(), 1u);
    ASSERT_EQ(registry.refused().size(), 1u);
    expect_refused(registry.refused()[0],
                   {"", Refusal::duplicate_id, "id 'zoo.animal' is taken by ..."});
}

// ---- wrong files ------------------------------------------------------------------------------
TEST(Zoo, TheFileOfALibraryIsCheckedBeforeItIsOpened) {
    Zoo zoo;
    const auto check = [&](const char* name, const std::string& bytes, Refusal reason,
                           const char* text) {
        SCOPED_TRACE(name);
        const auto manifest = zoo.add_file(name, bytes);
        RefusedPlugin got;
        try {
            (void)Plugin::load(read_manifest(manifest)); // in this process: must not crash it
        } catch (const PluginRefused& e) {
            got = {manifest, "", e.reason(), e.detail()};
        }
        expect_refused(got, {name, reason, text});
    };
    const std::string good = Zoo::library_bytes();
    const std::string lib = "library 'libzoo.so': ";
    check("text", "#!/bin/sh\necho hello\n", Refusal::library_not_shared_object,
          "library 'libzoo.so': is not a shared library");
    check("nothing", "", Refusal::library_truncated, "library 'libzoo.so': is empty");
    check("half", good.substr(0, good.size() / 2), Refusal::library_truncated,
          "library 'libzoo.so': is truncated: its headers want ...");
    check("forty_bytes", good.substr(0, 40), Refusal::library_truncated,
          "library 'libzoo.so': is truncated: its headers want 64 bytes, the file has 40: copy it "
          "again");
    std::string other = good;
    other[18] = static_cast<char>(183); // e_machine: AArch64
    check("arm", other, Refusal::library_wrong_architecture,
          "library 'libzoo.so': is built for another processor (ELF machine 183, this is x86-64)");
    other = good;
    other[4] = 1; // 32 bit
    check("thirty_two_bits", other, Refusal::library_wrong_architecture,
          "library 'libzoo.so': is built for another processor ...");
    other = good;
    other[16] = 1; // e_type: object file
    check("object_file", other, Refusal::library_not_shared_object,
          "library 'libzoo.so': is an ELF file, but not a shared library");
}

TEST(Zoo, EveryTruncationIsRefusedAndNoneCrashes) {
    Zoo zoo;
    const std::string good = Zoo::library_bytes();
    for (std::size_t cut = 1; cut < good.size();
         cut += std::max<std::size_t>(1, good.size() / 97)) {
        const auto manifest = zoo.add_file("cut", good.substr(0, good.size() - cut));
        try {
            (void)Plugin::load(read_manifest(manifest));
            ADD_FAILURE() << "loaded without its last " << cut << " bytes";
        } catch (const PluginRefused& e) {
            EXPECT_TRUE(e.reason() == Refusal::library_truncated) << e.what();
        }
    }
}

// ---- wrong entries, instances and tables: refused when opened -----------------------------------
const Animal kRefusedWhenOpened[] = {
    {"entry_none", Refusal::entry_missing, "library 'libzoo.so': exports no 'toile_plugin_entry'"},
    {"entry_function", Refusal::entry_missing,
     "library 'libzoo.so': 'toile_plugin_entry' is not a constant"},
    {"entry_symbol_short", Refusal::entry_short,
     "library 'libzoo.so': 'toile_plugin_entry' has 8 bytes, at least 56 wanted"},
    {"entry_undefined", Refusal::undefined_symbol,
     "library 'libzoo.so': undefined symbol: zoo_symbol_that_nobody_defines"},
    {"zeroed_tables", Refusal::library_unloadable, "library 'libzoo.so': ..."},
    {"entry_short", Refusal::entry_short, "entry has 16 bytes, at least 56 wanted"},
    {"entry_abi_major", Refusal::entry_abi_major,
     "entry built for ABI 2.0, this engine has 1.0: build it against this engine's headers"},
    {"entry_abi_newer", Refusal::entry_abi_newer,
     "entry built for ABI 1.7, this engine has 1.0: update the engine"},
    {"entry_incomplete", Refusal::entry_incomplete, "entry lacks 'describe'"},
    {"entry_init_fails", Refusal::init_failed, "entry's init failed with TOILE_E_IO"},
    {"entry_init_throws", Refusal::init_threw, "entry's init threw an exception"},
    {"descriptor_short", Refusal::descriptor_short, "descriptor 0 has 8 bytes, at least 48 wanted"},
    {"descriptor_id", Refusal::descriptor_disagrees,
     "the library describes no plugin 'zoo.animal'"},
    {"descriptor_version", Refusal::descriptor_disagrees,
     "descriptor says version '9.9.9', the manifest '1.0.0'"},
    {"descriptor_kinds", Refusal::descriptor_disagrees,
     "descriptor offers 'toile.cloth/1', the manifest does not"},
    {"create_fails", Refusal::create_failed, "create gave no instance"},
    {"instance_short", Refusal::instance_short, "instance has 16 bytes, at least 72 wanted"},
    {"instance_incomplete", Refusal::instance_incomplete, "instance lacks 'reset'"},
    {"init_fails", Refusal::init_failed,
     "init failed with TOILE_E_DEVICE: no licence for this shop"},
    {"init_throws", Refusal::init_threw, "init threw an exception"},
    {"kind_missing", Refusal::kind_missing, "the instance does not offer 'toile.skinning/1'"},
    {"table_short", Refusal::table_short,
     "table of 'toile.skinning/1' has 16 bytes, at least 24 wanted"},
    {"call_missing", Refusal::call_missing, "table of 'toile.skinning/1' lacks the call 'pose'"},
};

class ZooOpening : public ::testing::TestWithParam<Animal> {};

TEST_P(ZooOpening, IsRefusedHereAndInATrial) {
    const Animal& animal = GetParam();
    Zoo zoo;
    const auto manifest = zoo.add(animal.name);
    for (const bool trial : {false, true}) {
        SCOPED_TRACE(trial ? "tried in a child" : "opened at once");
        Services services(1);
        Registry registry(services, {.folders = {zoo.folder()},
                                     .environment = false,
                                     .beside_program = false,
                                     .trial = trial});
        registry.load_all();
        ASSERT_EQ(registry.refused().size(), 1u);
        expect_refused(registry.refused()[0], animal);
        EXPECT_THROW((void)registry.find(TOILE_SKINNING), Error);
    }
    expect_refused(checked(manifest, animal.timeout_s), animal);
}

INSTANTIATE_TEST_SUITE_P(All, ZooOpening, ::testing::ValuesIn(kRefusedWhenOpened),
                         [](const auto& tested) { return tested.param.name; });

// ---- would take the program with them: only the child dies
// ---------------------------------------
const Animal kKillers[] = {
    {"constructor_crashes", Refusal::crashed, "crashes in opening the library (SIGSEGV)"},
    {"constructor_throws", Refusal::aborted, "aborts in opening the library"},
    {"constructor_hangs", Refusal::hung, "hangs in opening the library (killed after 1 s)", 1.0},
    {"entry_init_exits", Refusal::exited,
     "ends the program in opening the library (exit status 0)"},
    {"init_crashes", Refusal::crashed, "crashes in making an instance (SIGSEGV)"},
    {"init_aborts", Refusal::aborted, "aborts in making an instance"},
    {"init_exits", Refusal::exited, "ends the program in making an instance (exit status 0)"},
    {"init_hangs", Refusal::hung, "hangs in making an instance (killed after 1 s)", 1.0},
    {"deinit_crashes", Refusal::crashed, "crashes in deinit (SIGSEGV)"},
    {"zeroed_code", Refusal::crashed, "crashes in opening the library (SIG..."},
};

class ZooKiller : public ::testing::TestWithParam<Animal> {};

TEST_P(ZooKiller, CostsOnlyTheChild) {
    const Animal& animal = GetParam();
    Zoo zoo;
    zoo.add(animal.name);
    Services services(1);
    Registry registry(services, {.folders = {zoo.folder()},
                                 .environment = false,
                                 .beside_program = false,
                                 .trial_timeout_s = animal.timeout_s});
    registry.load_all();
    ASSERT_EQ(registry.refused().size(), 1u);
    expect_refused(registry.refused()[0], animal);
}

INSTANTIATE_TEST_SUITE_P(All, ZooKiller, ::testing::ValuesIn(kKillers),
                         [](const auto& tested) { return tested.param.name; });

// ---- opens well, breaks the rules of its kind: found by `toile plugin check`
// ------------------------
#define RIGID "the rule 'skinning: the surface follows rigid motion, from the rest pose on'"

const Animal kRuleBreakers[] = {
    {"bind_fails", Refusal::call_failed, "bind: failed with TOILE_E_IO: the weights file is gone"},
    {"bind_hangs", Refusal::hung, "hangs in " RIGID " (killed after 1 s)", 1.0},
    {"pose_crashes", Refusal::crashed, "crashes in " RIGID " (SIGSEGV)"},
    {"pose_hangs", Refusal::hung, "hangs in " RIGID " (killed after 1 s)", 1.0},
    {"pose_aborts", Refusal::aborted, "aborts in " RIGID},
    {"pose_exits", Refusal::exited, "ends the program in " RIGID " (exit status 0)"},
    {"pose_throws", Refusal::call_threw, "pose: threw an exception across the boundary"},
    {"pose_nan", Refusal::non_finite, "pose: returns numbers that are not finite"},
    {"pose_overflows", Refusal::contract_broken, "pose: writes beyond its buffers"},
    {"pose_wrong", Refusal::contract_broken,
     "pose: the surface does not follow when all joints move as one"},
    {"fails_silently", Refusal::contract_broken, "pose: reports no text for its error before bind"},
};

class ZooRuleBreaker : public ::testing::TestWithParam<Animal> {};

TEST_P(ZooRuleBreaker, IsFoundByTheCheck) {
    const Animal& animal = GetParam();
    Zoo zoo;
    expect_refused(checked(zoo.add(animal.name), animal.timeout_s), animal);
}

INSTANTIATE_TEST_SUITE_P(All, ZooRuleBreaker, ::testing::ValuesIn(kRuleBreakers),
                         [](const auto& tested) { return tested.param.name; });

TEST(Zoo, TheControlIsGood) {
    Zoo zoo;
    const auto manifest = zoo.add("good");
    EXPECT_EQ(checked(manifest, 20).text, "");
    Services services(1);
    Registry registry(services,
                      {.folders = {zoo.folder()}, .environment = false, .beside_program = false});
    EXPECT_EQ(registry.find(TOILE_SKINNING)->id(), "zoo.animal");
    EXPECT_TRUE(registry.refused().empty());
}

TEST(Zoo, ARefusedPluginIsPassedOver) {
    Zoo zoo;
    zoo.add("good");
    zoo.add("call_missing", "zoo.animal2", 50);
    Services services(1);
    Registry registry(services,
                      {.folders = {zoo.folder()}, .environment = false, .beside_program = false});
    EXPECT_EQ(registry.find(TOILE_SKINNING)->id(), "zoo.animal");
    EXPECT_EQ(registry.refused().size(), 1u);
}

TEST(Zoo, ATrialThatCannotStartIsARefusal) {
    Zoo zoo;
    const Manifest manifest = read_manifest(zoo.add("good"));
    try {
        try_opening(manifest, 20, zoo.folder() / "no-such-program");
        ADD_FAILURE() << "tried without a program";
    } catch (const PluginRefused& e) {
        EXPECT_EQ(e.reason(), Refusal::trial_impossible);
        EXPECT_THAT(e.detail(), ::testing::EndsWith("no-such-program: No such file or directory"));
    }
}

TEST(Zoo, EveryReasonHasAnAnimal) {
    std::set<Refusal> shown = {Refusal::duplicate_id, Refusal::library_not_shared_object,
                               Refusal::library_wrong_architecture, Refusal::library_truncated,
                               Refusal::trial_impossible}; // ATrialThatCannotStartIsARefusal
    for (const auto& wrong : kWrongManifests)
        shown.insert(wrong.reason);
    for (const auto list :
         {std::span<const Animal>(kRefusedWhenOpened), std::span<const Animal>(kKillers),
          std::span<const Animal>(kRuleBreakers)})
        for (const Animal& animal : list)
            shown.insert(animal.reason);
    for (int value = 1; refusal_name(static_cast<Refusal>(value)) != "invalid"; ++value)
        EXPECT_TRUE(shown.contains(static_cast<Refusal>(value)))
            << refusal_name(static_cast<Refusal>(value));
}

} // namespace
} // namespace toile::host
