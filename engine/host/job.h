// A long call being watched: progress out, cancellation in.
#pragma once

#include "abi/base.h"
#include "core/error.h"

#include <atomic>
#include <functional>
#include <string_view>

namespace toile::host {

/// The work was cancelled; what was finished is kept.
class Cancelled : public Error {
  public:
    using Error::Error;
};

/// Lives until the call that it is handed to returns.
class Job {
  public:
    /// fraction in [0, 1], never falling. Called on the thread that does the work.
    using Progress = std::function<void(double fraction, std::string_view text)>;

    /// `stop`: a further flag that cancels, e.g. interrupt_flag(); must outlive the job, or null.
    explicit Job(Progress progress = {}, const std::atomic<bool>* stop = nullptr);
    Job(const Job&) = delete;
    Job& operator=(const Job&) = delete;

    /// [any thread]
    void cancel() noexcept { cancelled_ = true; }
    [[nodiscard]] bool cancelled() const noexcept {
        return cancelled_ || (stop_ != nullptr && *stop_);
    }
    [[nodiscard]] toile_job* handle() noexcept { return &job_; }

  private:
    static std::int32_t report(toile_job* job, double fraction, const char* text) noexcept;

    toile_job job_{};
    Progress progress_;
    const std::atomic<bool>* stop_;
    std::atomic<bool> cancelled_ = false;
    double fraction_ = 0.0;
};

/// Makes Ctrl-C and SIGTERM set `interrupt_flag` instead of ending the program; a second one ends
/// it. Called once by a command that can end cleanly with what it has.
void catch_interrupts();
[[nodiscard]] const std::atomic<bool>& interrupt_flag() noexcept;

} // namespace toile::host
