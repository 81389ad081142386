// Subcommands that plugins add. The help lists them from their manifests; a library is opened when
// its command is called.
#include "apps/commands.h"
#include "apps/plugin_limits.h"
#include "core/error.h"
#include "core/log.h"
#include "host/instance.h"
#include "host/registry.h"
#include "host/views.h"

#include <cstdio>
#include <iterator>
#include <list>
#include <memory>
#include <sstream>
#include <unistd.h>

namespace toile::apps {
namespace {

/// One tool: its command, and once that is called its plugin.
class ToolCommand {
  public:
    ToolCommand(const host::Manifest& manifest, const GlobalOptions& global)
        : manifest_(manifest), global_(global) {}

    /// Opens the plugin and adds its options. \throw Error
    void open(CLI::App& command) {
        services_ = std::make_unique<host::Services>(global_.threads);
        host::Registry registry(*services_, {.folders = folders_});
        instance_ =
            std::make_unique<host::Instance>(registry.find(TOILE_TOOL, manifest_.id), *services_);
        auto info = host::sized<toile_tool_info>();
        instance_->call("describe",
                        [&](auto* i) { return instance_->table<toile_tool>().describe(i, &info); });
        if (info.command == nullptr || manifest_.command != info.command)
            throw Error(manifest_.file.string() + ": command: is not what the library describes");
        command.footer("Example: " + std::string(info.example == nullptr ? "" : info.example));
        const auto* bytes = reinterpret_cast<const char*>(info.options);
        for (std::uint32_t k = 0; k < info.option_count; ++k)
            add_option(command, *reinterpret_cast<const toile_tool_option*>(
                                    bytes + std::size_t{k} * info.options->size));
    }

    /// \throw Error, UsageError
    void run() {
        host::catch_interrupts();
        instance_->activate(limits_of(global_, *services_, {}));
        std::vector<const char*> argv;
        for (const CLI::Option* option : options_)
            add_words(*option, argv);
        const bool terminal = isatty(STDERR_FILENO) != 0;
        host::Job job(
            [terminal](double share, std::string_view text) {
                if (terminal)
                    std::fprintf(stderr, "\r%5.1f %% %-60.60s", 100.0 * share,
                                 std::string(text).c_str());
            },
            &host::interrupt_flag());
        toile_status status = TOILE_OK;
        const auto finish = [&] {
            if (terminal) std::fputs("\n", stderr);
        };
        try {
            instance_->call("run", [&](auto* i) {
                status = instance_->table<toile_tool>().run(
                    i, static_cast<std::int32_t>(argv.size()), argv.data(), job.handle());
                return status;
            });
        } catch (const Error& e) {
            finish();
            if (status == TOILE_E_ARGUMENT) throw UsageError(e.what());
            throw;
        }
        finish();
    }

    void set_folders(std::vector<std::filesystem::path> folders) { folders_ = std::move(folders); }

  private:
    void add_option(CLI::App& command, const toile_tool_option& option) {
        const std::string name = std::string("--") + option.name;
        if (option.type == TOILE_OPTION_SWITCH) {
            options_.push_back(command.add_flag(name, option.text));
            return;
        }
        CLI::Option* added = command.add_option(name, option.text);
        added->required((option.flags & TOILE_OPTION_REQUIRED) != 0);
        if ((option.flags & TOILE_OPTION_REPEATED) != 0)
            added->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
        if (option.default_value != nullptr) added->default_str(option.default_value);
        switch (option.type) {
        case TOILE_OPTION_INTEGER:
            added->check(CLI::Range(static_cast<long long>(option.minimum),
                                    static_cast<long long>(option.maximum)));
            break;
        case TOILE_OPTION_REAL:
            added->check(CLI::Range(option.minimum, option.maximum));
            break;
        case TOILE_OPTION_PATH:
            added->check(CLI::ExistingPath)->type_name("PATH");
            break;
        case TOILE_OPTION_OUTPUT:
            added->type_name("FILE");
            break;
        default:
            added->type_name("TEXT");
        }
        if (option.value_name != nullptr) added->type_name(option.value_name);
        options_.push_back(added);
    }

    void add_words(const CLI::Option& option, std::vector<const char*>& argv) {
        if (option.count() == 0) return;
        const std::string& name = words_.emplace_back("--" + option.get_lnames().front());
        if (option.get_items_expected_max() == 0) { // a switch
            argv.push_back(name.c_str());
            return;
        }
        for (const std::string& value : option.results()) {
            argv.push_back(name.c_str());
            argv.push_back(words_.emplace_back(value).c_str());
        }
    }

    host::Manifest manifest_;
    const GlobalOptions& global_;
    std::vector<std::filesystem::path> folders_;
    std::unique_ptr<host::Services> services_;
    std::unique_ptr<host::Instance> instance_;
    std::vector<CLI::Option*> options_;
    std::list<std::string> words_; ///< what argv points to
};

/// --plugins before the command line is read: which commands there are hangs on it.
std::vector<std::filesystem::path> folders_in(std::span<const char* const> words) {
    constexpr std::string_view kName = "--plugins";
    std::vector<std::filesystem::path> out;
    std::error_code code;
    const auto add = [&](std::string_view folder) {
        // One that does not exist is told of by whatever uses it.
        if (std::filesystem::is_directory(folder, code)) out.emplace_back(folder);
    };
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string_view word = words[i];
        if (word == kName && i + 1 < words.size())
            add(words[++i]);
        else if (word.starts_with(kName) && word.substr(kName.size()).starts_with('='))
            add(word.substr(kName.size() + 1));
    }
    return out;
}

CLI::App* find_command(CLI::App& group, const std::string& word) {
    for (CLI::App* command : group.get_subcommands([](CLI::App*) { return true; }))
        if (command->check_name(word)) return command;
    return nullptr;
}

void add_command(CLI::App& app, const host::Manifest& manifest, const GlobalOptions& global,
                 const std::vector<std::filesystem::path>& folders) {
    std::istringstream in(manifest.command);
    std::vector<std::string> words(std::istream_iterator<std::string>(in), {});
    CLI::App* group = &app;
    for (std::size_t w = 0; w + 1 < words.size(); ++w) {
        CLI::App* inner = find_command(*group, words[w]);
        if (inner == nullptr) {
            inner = group->add_subcommand(words[w], "Added by plugins");
            inner->require_subcommand(1);
        }
        group = inner;
    }
    if (find_command(*group, words.back()) != nullptr) {
        log::warning(manifest.file.string() + ": there is a command '" + manifest.command +
                     "' already; this one is not added");
        return;
    }
    CLI::App* command = group->add_subcommand(words.back(), manifest.command_summary);
    const auto tool = std::make_shared<ToolCommand>(manifest, global);
    tool->set_folders(folders);
    command->preparse_callback([tool, command](std::size_t) { tool->open(*command); });
    command->callback([tool] { tool->run(); });
}

} // namespace

void add_tool_commands(CLI::App& app, const GlobalOptions& global,
                       std::span<const char* const> words) {
    const auto folders = folders_in(words);
    host::Services services(1);
    const host::Registry registry(services, {.folders = folders});
    for (const host::Manifest& manifest : registry.manifests(TOILE_TOOL))
        add_command(app, manifest, global, folders);
}

} // namespace toile::apps
