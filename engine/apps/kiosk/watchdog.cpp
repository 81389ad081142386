#include "apps/kiosk/watchdog.h"

#include "apps/kiosk/restart_policy.h"
#include "core/error.h"
#include "core/log.h"
#include "host/job.h"
#include "pipeline/stage_clock.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <optional>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

extern char** environ; // NOLINT(readability-redundant-declaration): POSIX asks for it

namespace toile::apps::kiosk {
namespace {

constexpr int kPoll_ms = 50;
// Of one turn of the loop: when this process itself does not get to run, nobody has stalled.
constexpr double kMostOfATurn_s = 0.1;
constexpr double kLeastOfATurn = 0.2; // counts, however starved the mirror is

/// One run of the mirror.
class Child {
  public:
    explicit Child(const std::vector<std::string>& arguments) {
        std::array<int, 2> ends{-1, -1};
        if (pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC) != 0)
            throw Error(std::string("the watchdog has no pipe: ") + std::strerror(errno));
        read_end_ = ends[0];
        std::vector<std::string> words = arguments;
        constexpr int kChildEnd = 3;
        words.insert(words.end(), {"--heartbeat", std::to_string(kChildEnd)});
        std::vector<char*> argv;
        argv.reserve(words.size() + 1);
        for (std::string& word : words)
            argv.push_back(word.data());
        argv.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, ends[1], kChildEnd);
        const int code = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[1]);
        if (code != 0) {
            close(read_end_);
            throw Error("cannot start '" + words.front() + "': " + std::strerror(code));
        }
    }
    ~Child() {
        if (pid_ > 0) end(SIGKILL);
        close(read_end_);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Waits a little for a sign of life; the last one.
    std::optional<LifeSign> sign() {
        pollfd fd{read_end_, POLLIN, 0};
        (void)poll(&fd, 1, kPoll_ms);
        std::array<char, 256> bytes{};
        const ssize_t count = read(read_end_, bytes.data(), bytes.size());
        if (count <= 0) return std::nullopt;
        return static_cast<LifeSign>(bytes[static_cast<std::size_t>(count) - 1]);
    }
    /// Seconds that its threads were ready to run and the machine had no core for them.
    [[nodiscard]] double starved_s() const {
        double out = 0.0;
        std::error_code none;
        const std::string tasks = "/proc/" + std::to_string(pid_) + "/task";
        for (const auto& task : std::filesystem::directory_iterator(tasks, none)) {
            std::ifstream in(task.path() / "schedstat");
            double ran_ns = 0.0;
            double waited_ns = 0.0;
            if (in >> ran_ns >> waited_ns) out += 1e-9 * waited_ns;
        }
        return out;
    }
    /// True once it has ended.
    bool ended(int& status) {
        if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
        pid_ = -1;
        return true;
    }
    int end(int signal) {
        int status = 0;
        kill(pid_, signal);
        while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
        }
        pid_ = -1;
        return status;
    }

  private:
    pid_t pid_ = -1;
    int read_end_ = -1;
};

std::string milliseconds(double seconds) {
    return std::to_string(static_cast<int>(1000.0 * seconds)) + " ms";
}

struct Outcome {
    bool over = false; ///< by itself or interrupted
    int status = 0;
    std::string why; ///< of a crash or stall
};

/// Seconds of the watchdog's clock; 0 at the first start.
struct Down {
    double noticed_s = 0.0;
    double last_sign_s = 0.0; ///< of the mirror that ended
};

Outcome run_once(const std::vector<std::string>& arguments, const WatchdogOptions& options,
                 const RestartPolicy& policy, Down& down) {
    Child child(arguments);
    double turn_s = pipeline::wall_seconds();
    double silent_s = 0.0;
    double starved_s = 0.0;
    double allowed_s = options.start_s;
    bool signed_once = false;
    for (;;) {
        const auto sign = child.sign();
        const double now_s = pipeline::wall_seconds();
        // A machine with other work to do is no stall, but not for ever.
        const double starved_now_s = child.starved_s();
        const double waited_s = starved_now_s - std::exchange(starved_s, starved_now_s);
        const double turn = std::min(now_s - turn_s, kMostOfATurn_s);
        silent_s += std::clamp(turn - std::max(0.0, waited_s), kLeastOfATurn * turn, turn);
        turn_s = now_s;
        if (sign) {
            silent_s = 0.0;
            if (!signed_once && down.noticed_s > 0.0)
                log::info("the mirror is up again after " + milliseconds(now_s - down.noticed_s) +
                          ", " + milliseconds(now_s - down.last_sign_s) + " since its last sign");
            signed_once = true;
            down.last_sign_s = now_s;
            allowed_s = *sign == LifeSign::patience ? std::max(options.patience_s, options.stall_s)
                                                    : options.stall_s;
        }
        int status = 0;
        if (child.ended(status)) {
            if (WIFEXITED(status) && (signed_once || WEXITSTATUS(status) == 2))
                return {WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 2, WEXITSTATUS(status),
                        "it ended with status " + std::to_string(WEXITSTATUS(status))};
            if (WIFEXITED(status)) // it never came up: starting it again would not help
                return {true, WEXITSTATUS(status), ""};
            return {false, 1, std::string("it crashed: ") + strsignal(WTERMSIG(status))};
        }
        if (host::interrupt_flag()) return {true, child.end(SIGTERM) == 0 ? 0 : 1, ""};
        if (silent_s > allowed_s) {
            child.end(SIGKILL);
            return {false, 1, "it gave no sign of life for " + milliseconds(silent_s)};
        }
        if (policy.recovered(pipeline::wall_seconds())) {
            child.end(SIGTERM);
            return {false, 0, ""};
        }
    }
}

} // namespace

int watch(const std::vector<std::string>& arguments, const WatchdogOptions& options) {
    host::catch_interrupts();
    RestartPolicy policy;
    Down down;
    for (;;) {
        std::vector<std::string> words = arguments;
        words.insert(words.end(), {"--restarts", std::to_string(policy.restarts())});
        if (policy.stock()) words.emplace_back("--stock");
        if (policy.safe()) words.emplace_back("--safe");
        const Outcome outcome = run_once(words, options, policy, down);
        if (outcome.over) return outcome.status;
        down.noticed_s = pipeline::wall_seconds();
        if (outcome.why.empty()) {
            log::info("the whole mirror is tried again, with all plugins");
            policy.leave_safe_mode();
            continue;
        }
        const auto decision = policy.crashed(pipeline::wall_seconds());
        log::error("the mirror is started again" +
                   std::string(decision.safe    ? " in safe mode"
                               : decision.stock ? " with the stock plugins only"
                                                : "") +
                   ": " + outcome.why);
        std::this_thread::sleep_for(std::chrono::duration<double>(decision.pause_s));
    }
}

} // namespace toile::apps::kiosk
