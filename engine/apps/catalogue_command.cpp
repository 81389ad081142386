// toile catalogue: many looks at once, to pictures, 3D files and figures.
#include "apps/catalogue_results.h"
#include "apps/catalogue_run.h"
#include "apps/commands.h"
#include "apps/slurm.h"
#include "core/error.h"
#include "core/log.h"
#include "host/job.h"

#include <charconv>
#include <iostream>

namespace toile::apps {
namespace {

struct CatalogueOptions {
    std::string plan, out, only, share;
    bool list = false, merge = false, fresh = false, slurm = false;
    SlurmOptions jobs;
};

CatalogueShare share_from(const std::string& text) {
    CatalogueShare out;
    if (text.empty()) return out;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, out.index);
    if (first.ec == std::errc() && first.ptr != end && *first.ptr == '/') {
        const auto second = std::from_chars(first.ptr + 1, end, out.count);
        if (second.ec == std::errc() && second.ptr == end && out.index < out.count) return out;
    }
    throw UsageError("--share '" + text + "' is not of the form 0/4 .. 3/4");
}

const CatalogueItem& item_named(const std::vector<CatalogueItem>& items, const std::string& id,
                                const CataloguePlan& plan) {
    for (const CatalogueItem& item : items)
        if (item.id == id) return item;
    throw UsageError("--only '" + id + "': is no item of " + plan.file.string() +
                     "; --list tells them");
}

/// False when something is wanting.
bool merge(const CataloguePlan& plan, const std::vector<CatalogueItem>& items) {
    const CatalogueCounts counts = write_results(plan, items);
    write_sheets(plan, items);
    std::cout << counts.done << " of " << counts.items << " items in " << plan.out.string();
    if (counts.failed > 0) std::cout << ", " << counts.failed << " failed";
    if (counts.missing > 0) std::cout << ", " << counts.missing << " not made";
    if (counts.beyond > 0) std::cout << ", " << counts.beyond << " beyond the plan's limits";
    std::cout << "; summary.md names them\n";
    return counts.failed == 0 && counts.missing == 0;
}

void make_catalogue(const CatalogueOptions& options, const GlobalOptions& global) {
    CataloguePlan plan = load_catalogue_plan(options.plan);
    if (!options.out.empty()) plan.out = options.out;
    const std::vector<CatalogueItem> items = items_of(plan);
    if (options.list) {
        for (const CatalogueItem& item : items)
            std::cout << item.id << "\n";
        return;
    }
    if (options.slurm) return submit_to_slurm(plan, global, options.jobs);
    host::catch_interrupts();
    if (!options.only.empty())
        return make_item(plan, item_named(items, options.only, plan), global);
    if (!options.merge) {
        const CatalogueShare share = share_from(options.share);
        const CatalogueRun run = make_items(plan, items, share, global, options.fresh);
        if (run.kept > 0) log::info(std::to_string(run.kept) + " items were there already");
        if (!options.share.empty()) {
            if (run.failed > 0 || run.interrupted) throw Error("not every item was made");
            return;
        }
    }
    if (!merge(plan, items)) throw Error("not every item was made; call the same again to go on");
}

} // namespace

void add_catalogue_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command = app.add_subcommand(
        "catalogue", "Makes pictures, 3D files and fit reports of many looks by a plan");
    auto options = std::make_shared<CatalogueOptions>();
    command->add_option("plan", options->plan, "The plan")->type_name("PLAN.json")->required();
    command->add_option("--out", options->out, "Folder of the results; else as the plan says")
        ->type_name("DIR");
    command->add_flag("--list", options->list, "Only lists the items");
    command->add_flag("--fresh", options->fresh, "Makes everything anew");
    command->add_option("--only", options->only, "Makes one item")->type_name("ITEM");
    command->add_option("--share", options->share, "Makes every Nth item and merges nothing")
        ->type_name("I/N");
    command->add_flag("--merge", options->merge, "Makes nothing, puts together what is there");
    command->add_flag("--slurm", options->slurm, "Splits the work over machines by Slurm");
    command->add_option("--slurm-tasks", options->jobs.tasks, "Tasks of the job array")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--slurm-cpus", options->jobs.cpus_per_task, "Processors of each task")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    command->add_option("--slurm-partition", options->jobs.partition, "Partition of the jobs")
        ->check(CLI::Validator(
            [](const std::string& name) {
                const bool sound =
                    name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMN"
                                           "OPQRSTUVWXYZ0123456789_,.-") == std::string::npos;
                return sound ? std::string() : "'" + name + "' is no partition's name";
            },
            "NAME"));
    command->add_flag("--wait", options->jobs.wait, "With --slurm: until all is merged");
    command->footer("Example: toile catalogue autumn.json --out autumn");
    command->callback([options, &global] { make_catalogue(*options, global); });
}

} // namespace toile::apps
