#include "host/trial.h"

#include "core/paths.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace toile::host {
namespace {

// The child writes lines here: "at WHAT", "refused REASON TEXT" and at last "good".
constexpr int kReportDescriptor = 3;

using Clock = std::chrono::steady_clock;

struct Outcome {
    std::string text; ///< all that the child wrote
    bool timed_out = false;
    int wait_status = 0;
};

class Child {
  public:
    Child(const std::filesystem::path& program, const Manifest& manifest, const char* mode) {
        const std::string shown = manifest.file.string();
        std::array<int, 2> ends{};
        if (pipe2(ends.data(), O_CLOEXEC) != 0)
            throw PluginRefused(Refusal::trial_impossible, shown, "no pipe to a trial process");
        report_ = ends[0];
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&actions, ends[1], kReportDescriptor);
        std::string name = program.string();
        std::string mode_text = mode;
        std::string file = shown;
        std::array<char*, 4> arguments{name.data(), mode_text.data(), file.data(), nullptr};
        const int error =
            posix_spawn(&pid_, name.c_str(), &actions, nullptr, arguments.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[1]);
        if (error == 0) return;
        close(report_);
        throw PluginRefused(Refusal::trial_impossible, shown,
                            "cannot be tried: " + name + ": " + std::strerror(error));
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() { close(report_); }

    Outcome wait(double timeout_s) {
        Outcome out;
        const auto end =
            Clock::now() + std::chrono::milliseconds(static_cast<long>(timeout_s * 1e3));
        bool ended = false;
        while (!ended && !out.timed_out) {
            out.timed_out = !read_until(end, out.text);
            // The pipe is closed but the process may still run (or have handed the pipe on).
            while (!out.timed_out && !(ended = waitpid(pid_, &out.wait_status, WNOHANG) == pid_)) {
                out.timed_out = Clock::now() > end;
                usleep(1000);
            }
        }
        if (ended) return out;
        kill(pid_, SIGKILL);
        waitpid(pid_, &out.wait_status, 0);
        return out;
    }

  private:
    // False when the time is over before the pipe's end.
    bool read_until(Clock::time_point end, std::string& text) const {
        std::array<char, 4096> buffer{};
        for (;;) {
            const auto left =
                std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
            pollfd wait{report_, POLLIN, 0};
            if (left <= 0 || poll(&wait, 1, static_cast<int>(left)) == 0) return false;
            const ssize_t got = read(report_, buffer.data(), buffer.size());
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) return true;
            if (text.size() < (64u << 10))
                text.append(buffer.data(), static_cast<std::size_t>(got));
        }
    }

    pid_t pid_ = -1;
    int report_ = -1;
};

// What the child said: the stage it was at last, and its verdict.
struct Report {
    std::string at = "start";
    std::string reason;
    std::string text;
    bool good = false;
};

Report parse(const std::string& text) {
    Report out;
    for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos;
         begin = end + 1) {
        const std::string line = text.substr(begin, end - begin);
        if (line.starts_with("at ")) out.at = line.substr(3);
        if (line == "good") out.good = true;
        if (!line.starts_with("refused ")) continue;
        const std::size_t space = std::min(line.find(' ', 8), line.size() - 1);
        out.reason = line.substr(8, space - 8);
        out.text = line.substr(space + 1);
    }
    return out;
}

std::string seconds_text(double seconds) {
    std::string text = std::to_string(seconds);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text + " s";
}

void judge(const Outcome& outcome, const Manifest& manifest, double timeout_s) {
    const Report report = parse(outcome.text);
    const auto refuse = [&](Refusal reason, const std::string& what) {
        return PluginRefused(reason, manifest.file.string(), what);
    };
    if (!report.reason.empty()) throw refuse(refusal_from_name(report.reason), report.text);
    if (outcome.timed_out)
        throw refuse(Refusal::hung,
                     "hangs in " + report.at + " (killed after " + seconds_text(timeout_s) + ")");
    const int status = outcome.wait_status;
    if (WIFSIGNALED(status)) {
        const int signal = WTERMSIG(status);
        if (signal == SIGABRT) throw refuse(Refusal::aborted, "aborts in " + report.at);
        throw refuse(Refusal::crashed,
                     "crashes in " + report.at + " (SIG" + sigabbrev_np(signal) + ")");
    }
    if (!report.good || WEXITSTATUS(status) != 0)
        throw refuse(Refusal::exited, "ends the program in " + report.at + " (exit status " +
                                          std::to_string(WEXITSTATUS(status)) + ")");
}

} // namespace

std::filesystem::path trial_program() {
    return program_folder() / "toile-plugin-trial";
}

void try_opening(const Manifest& manifest, double timeout_s, const std::filesystem::path& program) {
    judge(Child(program, manifest, "open").wait(timeout_s), manifest, timeout_s);
}

void try_contract(const Manifest& manifest, double timeout_s,
                  const std::filesystem::path& program) {
    judge(Child(program, manifest, "contract").wait(timeout_s), manifest, timeout_s);
}

std::vector<std::filesystem::path> manifests_of(const std::filesystem::path& path) {
    const std::string shown = path.string();
    std::error_code code;
    if (std::filesystem::is_directory(path, code)) {
        auto found = manifests_in(path);
        if (!found.empty()) return found;
        throw PluginRefused(Refusal::manifest_unreadable, shown, "holds no plugin.json");
    }
    if (path.extension() == ".json") return {path};
    if (!std::filesystem::exists(path, code))
        throw PluginRefused(Refusal::library_missing, shown, "no such file");
    // A library: whoever names it. A manifest that cannot be read is told about itself.
    std::vector<std::filesystem::path> out;
    const auto folder = path.has_parent_path() ? path.parent_path() : ".";
    for (const auto& file : manifests_in(folder))
        if (read_manifest(file).library.filename() == path.filename()) out.push_back(file);
    if (out.empty())
        throw PluginRefused(Refusal::manifest_unreadable, shown,
                            "no plugin.json beside it names this library");
    return out;
}

} // namespace toile::host
