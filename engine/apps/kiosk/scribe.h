// The only one who writes files for a running mirror: metrics, and pictures that were asked for.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace toile::apps::kiosk {

/// Writes whole files on a thread of its own, so that a slow or full disk never holds a frame.
class Scribe {
  public:
    /// `at_once`: when they are given (lock-step).
    explicit Scribe(bool at_once);
    ~Scribe();
    Scribe(const Scribe&) = delete;
    Scribe& operator=(const Scribe&) = delete;

    void write(std::filesystem::path file, std::string bytes);
    /// What could not be written since the last call, one line each. Never waits.
    [[nodiscard]] std::vector<std::string> take_errors();
    /// The next file is not written, as on a full disk; for tests of faults.
    void fail_next() { fail_next_ = true; }

  private:
    struct Sheet {
        std::filesystem::path file;
        std::string bytes;
    };
    void run();
    void put(const Sheet& sheet);

    bool at_once_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Sheet> sheets_;
    std::vector<std::string> errors_;
    std::atomic<bool> fail_next_{false};
    bool stop_ = false;
    std::thread thread_;
};

} // namespace toile::apps::kiosk
