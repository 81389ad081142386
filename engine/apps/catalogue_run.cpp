#include "apps/catalogue_run.h"

#include "apps/child_process.h"
#include "core/error.h"
#include "core/log.h"
#include "core/paths.h"
#include "host/job.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

namespace toile::apps {
namespace {

struct Task {
    const CatalogueItem* item = nullptr;
    std::string inputs;
};

/// The last line that a child called an error, else how it ended.
std::string reason_of(const ChildResult& child) {
    const std::string mark = "toile: error: ";
    const std::size_t at = child.err.rfind(mark);
    if (at != std::string::npos) {
        const std::size_t from = at + mark.size();
        return child.err.substr(from, child.err.find('\n', from) - from);
    }
    if (child.status > 128)
        return "the process died of signal " + std::to_string(child.status - 128);
    return "the process ended with status " + std::to_string(child.status);
}

class Crew {
  public:
    Crew(const CataloguePlan& plan, const GlobalOptions& global, std::vector<Task> tasks,
         CatalogueRun& run)
        : plan_(plan), global_(global), tasks_(std::move(tasks)), run_(run) {}

    void work() {
        const std::size_t cores = global_.threads > 0
                                      ? global_.threads
                                      : std::max(1u, std::thread::hardware_concurrency());
        std::vector<std::thread> workers;
        for (std::size_t i = 0; i < std::min(cores, tasks_.size()); ++i)
            workers.emplace_back([this] { work_off(); });
        for (std::thread& worker : workers)
            worker.join();
        if (fault_) std::rethrow_exception(fault_);
    }

  private:
    void work_off() noexcept {
        try {
            while (!host::interrupt_flag() && !stop_) {
                const std::size_t next = next_++;
                if (next >= tasks_.size()) return;
                make(tasks_[next]);
            }
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!fault_) fault_ = std::current_exception();
            stop_ = true;
        }
    }

    void make(const Task& task) {
        std::vector<std::string> words = {program_};
        for (const std::string& word : same_options(global_))
            words.push_back(word);
        for (const std::string& word :
             {std::string("--threads"), std::string("1"), std::string("catalogue"),
              plan_.file.string(), std::string("--out"), plan_.out.string(), std::string("--only"),
              task.item->id})
            words.push_back(word);
        const auto start = std::chrono::steady_clock::now();
        const ChildResult child = run_child(words, "");
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (child.status != 0 && host::interrupt_flag()) return;
        if (child.status != 0) keep_failure(plan_, *task.item, task.inputs, reason_of(child));
        tell(task, child, seconds);
    }

    void tell(const Task& task, const ChildResult& child, double seconds) {
        const std::lock_guard lock(mutex_);
        ++(child.status == 0 ? run_.made : run_.failed);
        const std::string count = "[" + std::to_string(run_.made + run_.failed) + "/" +
                                  std::to_string(tasks_.size()) + "] " + task.item->id;
        if (child.status != 0)
            log::error(count + ": " + reason_of(child));
        else
            log::info(count + " " + std::to_string(seconds).substr(0, 4) + " s");
    }

    const CataloguePlan& plan_;
    const GlobalOptions& global_;
    std::vector<Task> tasks_;
    CatalogueRun& run_;
    std::string program_ = program_file().string();
    std::atomic<std::size_t> next_ = 0;
    std::atomic<bool> stop_ = false;
    std::mutex mutex_;
    std::exception_ptr fault_;
};

} // namespace

std::vector<std::string> same_options(const GlobalOptions& global) {
    std::vector<std::string> out = {"--seed", std::to_string(global.seed)};
    for (const std::filesystem::path& folder : global.plugin_folders) {
        out.emplace_back("--plugins");
        out.push_back(std::filesystem::absolute(folder).string());
    }
    return out;
}

CatalogueRun make_items(const CataloguePlan& plan, const std::vector<CatalogueItem>& items,
                        const CatalogueShare& share, const GlobalOptions& global, bool fresh) {
    CatalogueRun run;
    CatalogueInputs inputs(plan, global.seed);
    std::vector<Task> tasks;
    for (std::size_t i = share.index; i < items.size(); i += share.count) {
        Task task{&items[i], inputs.digest(items[i])};
        const ItemRecord record = fresh ? ItemRecord{} : read_record(plan, items[i]);
        if (record.state == ItemState::done && record.inputs == task.inputs)
            ++run.kept;
        else
            tasks.push_back(std::move(task));
    }
    Crew(plan, global, std::move(tasks), run).work();
    run.interrupted = host::interrupt_flag();
    return run;
}

} // namespace toile::apps
