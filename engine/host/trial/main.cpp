// toile-plugin-trial open|contract MANIFEST: the child of host/trial.cpp. Says on descriptor 3
// where it is ("at ..."), what is wrong ("refused REASON TEXT") or that nothing is ("good").
#include "host/contract.h"
#include "host/instance.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace {

using namespace toile::host;

constexpr int kReportDescriptor = 3;

void say(const std::string& line) {
    const std::string text = line + "\n";
    if (write(kReportDescriptor, text.data(), text.size()) < 0) _exit(2);
}

int run(const std::string& mode, const char* file) {
    try {
        say("at opening the library");
        const auto plugin = Plugin::load(read_manifest(file));
        say("at making an instance");
        Services services(2);
        { const Instance instance(plugin, services); }
        if (mode == "contract")
            for (const ContractCase& rule : contract_cases()) {
                if (!applies(rule, plugin->manifest())) continue;
                say("at the rule '" + std::string(rule.name) + "'");
                run_contract_case(rule, plugin);
            }
        say("at deinit");
        plugin->entry().deinit();
    } catch (const PluginRefused& e) {
        say("refused " + std::string(refusal_name(e.reason())) + " " + e.detail());
        return 1;
    } catch (const std::exception& e) {
        say(std::string("refused contract_broken ") + e.what());
        return 1;
    }
    say("at the end");
    return 0;
}

} // namespace

// A crash shall end this process by its signal, also where sanitizers would report it.
extern "C" [[gnu::visibility("default")]] const char* __asan_default_options() { // NOLINT
    return "handle_segv=0:handle_sigbus=0:handle_sigill=0:handle_sigfpe=0:detect_leaks=0";
}

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fputs("toile-plugin-trial is run by `toile plugin check`\n", stderr);
        return 2;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    const int status = run(argv[1], argv[2]);
    if (status == 0) say("good");
    return status;
}
