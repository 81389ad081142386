#include "host/job.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <mutex>

namespace toile::host {
namespace {

// A signal handler can reach nothing but this.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

// Progress may come from any thread; watchers share one terminal, so one lock serves all jobs.
std::mutex& progress_mutex() {
    static std::mutex mutex;
    return mutex;
}

extern "C" void toile_on_interrupt(int signal) {
    if (interrupted.exchange(true)) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

} // namespace

Job::Job(Progress progress, const std::atomic<bool>* stop)
    : progress_(std::move(progress)), stop_(stop) {
    job_.size = sizeof(toile_job);
    job_.job_data = this;
    job_.progress = &report;
}

std::int32_t Job::report(toile_job* job, double fraction, const char* text) noexcept {
    if (job == nullptr) return 0;
    Job& self = *static_cast<Job*>(job->job_data);
    const std::lock_guard lock(progress_mutex());
    if (std::isfinite(fraction)) self.fraction_ = std::clamp(fraction, self.fraction_, 1.0);
    try {
        if (self.progress_) self.progress_(self.fraction_, text == nullptr ? "" : text);
    } catch (...) { // a watcher that cannot show progress does not stop the work
    }
    return self.cancelled() ? 1 : 0;
}

void catch_interrupts() {
    std::signal(SIGINT, &toile_on_interrupt);
    std::signal(SIGTERM, &toile_on_interrupt);
}

const std::atomic<bool>& interrupt_flag() noexcept {
    return interrupted;
}

} // namespace toile::host
