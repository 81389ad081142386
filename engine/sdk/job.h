// Progress of a long call, and whether somebody wants it to stop.
#pragma once

#include "sdk/failure.h"

namespace toile::sdk {

/// Borrowed for the call; a null job means that nobody watches. [any thread]
class Job {
  public:
    explicit Job(toile_job* job = nullptr) noexcept : job_(job) {}

    /// Says how far the work is, `fraction` in [0, 1]. \throw Failure TOILE_CANCELLED when the
    /// work shall stop; let it pass through
    void progress(double fraction, const char* text = nullptr) const {
        if (cancelled(fraction, text)) throw Failure(TOILE_CANCELLED, "cancelled");
    }
    /// The same for code that must stop in its own way.
    [[nodiscard]] bool cancelled(double fraction, const char* text = nullptr) const noexcept {
        return job_ != nullptr && job_->progress(job_, fraction, text) != 0;
    }
    [[nodiscard]] toile_job* handle() const noexcept { return job_; }

  private:
    toile_job* job_;
};

} // namespace toile::sdk
