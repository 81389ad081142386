#include "apps/child_process.h"

#include "core/error.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ; // NOLINT(readability-redundant-declaration): POSIX asks for it

namespace toile::apps {
namespace {

constexpr std::size_t kMostOutput = std::size_t{64} << 20;

class Pipe {
  public:
    Pipe() {
        if (pipe2(ends_.data(), O_CLOEXEC) != 0) {
            throw Error(std::string("no pipe to another program: ") + std::strerror(errno));
        }
    }
    ~Pipe() {
        close_end(0);
        close_end(1);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    [[nodiscard]] int end(const std::size_t i) const { return ends_[i]; }
    void close_end(const std::size_t i) {
        if (ends_[i] >= 0) {
            close(ends_[i]);
            ends_[i] = -1;
        }
    }

  private:
    std::array<int, 2> ends_{-1, -1};
};

// Reads what is there; false at the end.
bool take(Pipe& pipe, std::string& text) {
    std::array<char, 65536> buffer{};
    const ssize_t n = read(pipe.end(0), buffer.data(), buffer.size());
    if (n > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(n));
    }
    return n > 0 || (n < 0 && errno == EINTR);
}

// Writes what fits; false when all is written or nobody reads.
bool give(Pipe& pipe, const std::string& text, std::size_t& written) {
    const ssize_t n = write(pipe.end(1), text.data() + written, text.size() - written);
    if (n > 0) {
        written += static_cast<std::size_t>(n);
    }
    return (n >= 0 || errno == EINTR || errno == EAGAIN) && written < text.size();
}

void exchange(Pipe& in, Pipe& out, Pipe& err, const std::string& input, ChildResult& result) {
    std::size_t written = 0;
    fcntl(in.end(1), F_SETFL, O_NONBLOCK);
    if (input.empty()) {
        in.close_end(1);
    }
    while (out.end(0) >= 0 || err.end(0) >= 0) {
        std::array<pollfd, 3> fds = {pollfd{in.end(1), POLLOUT, 0}, pollfd{out.end(0), POLLIN, 0},
                                     pollfd{err.end(0), POLLIN, 0}};
        if (poll(fds.data(), fds.size(), -1) < 0 && errno != EINTR) {
            throw Error(std::string("waiting for another program: ") + std::strerror(errno));
        }
        if (fds[0].revents != 0 && !give(in, input, written)) {
            in.close_end(1);
        }
        if (fds[1].revents != 0 && !take(out, result.out)) {
            out.close_end(0);
        }
        if (fds[2].revents != 0 && !take(err, result.err)) {
            err.close_end(0);
        }
        if (result.out.size() + result.err.size() > kMostOutput) {
            throw Error("another program wrote more than 64 MiB");
        }
    }
}

// Without it a child that ends before it has read all would end this program too.
class NoBrokenPipe {
  public:
    NoBrokenPipe() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
    ~NoBrokenPipe() { std::signal(SIGPIPE, before_); }
    NoBrokenPipe(const NoBrokenPipe&) = delete;
    NoBrokenPipe& operator=(const NoBrokenPipe&) = delete;

  private:
    void (*before_)(int);
};

} // namespace

ChildResult run_child(const std::vector<std::string>& arguments, const std::string& input) {
    const NoBrokenPipe quiet;
    Pipe in;
    Pipe out;
    Pipe err;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in.end(0), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out.end(1), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err.end(1), STDERR_FILENO);
    std::vector<char*> argv;
    for (const std::string& argument : arguments) {
        argv.push_back(const_cast<char*>(argument.c_str())); // posix_spawnp does not write to it
    }
    argv.push_back(nullptr);
    pid_t pid = 0;
    const int code = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) {
        throw Error("cannot run '" + arguments.front() + "': " + std::strerror(code));
    }
    in.close_end(0);
    out.close_end(1);
    err.close_end(1);
    ChildResult result;
    try {
        exchange(in, out, err, input, result);
    } catch (...) {
        kill(pid, SIGKILL);
        waitpid(pid, nullptr, 0);
        throw;
    }
    int status = 0;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

} // namespace toile::apps
