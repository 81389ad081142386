#include "apps/slurm.h"

#include "apps/catalogue_run.h"
#include "apps/child_process.h"
#include "core/bytes.h"
#include "core/error.h"
#include "core/log.h"
#include "core/paths.h"

#include <algorithm>
#include <cctype>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

/// As one word of a shell.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text)
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

std::string command(const CataloguePlan& plan, const GlobalOptions& global) {
    std::string out = quoted(program_file().string());
    for (const std::string& word : same_options(global))
        out += " " + quoted(word);
    return out + " catalogue " + quoted(fs::absolute(plan.file).string()) + " --out " +
           quoted(fs::absolute(plan.out).string());
}

std::string script(const std::string& name, const fs::path& log, const SlurmOptions& options,
                   const std::string& more, const std::string& work) {
    std::string out = "#!/bin/sh\n#SBATCH --job-name=" + name +
                      "\n#SBATCH --output=" + log.string() +
                      "\n#SBATCH --cpus-per-task=" + std::to_string(options.cpus_per_task) + "\n";
    if (!options.partition.empty()) out += "#SBATCH --partition=" + options.partition + "\n";
    return out + more + "cd " + quoted(fs::current_path().string()) + "\n" + work + "\n";
}

/// The number of a submitted job.
std::string submit(const std::vector<std::string>& words) {
    ChildResult child;
    try {
        child = run_child(words, "");
    } catch (const Error&) {
        throw Error("there is no sbatch here: install Slurm (Debian: slurm-wlm), or call --slurm "
                    "where jobs are submitted; the scripts are kept beside the items");
    }
    if (child.status != 0)
        throw Error("sbatch refused the catalogue: " + child.err.substr(0, child.err.find('\n')));
    std::string id = child.out.substr(0, child.out.find_first_of(";\n"));
    if (id.empty() ||
        !std::all_of(id.begin(), id.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
        throw Error("sbatch told no job's number but '" + child.out + "'");
    return id;
}

} // namespace

void submit_to_slurm(const CataloguePlan& plan, const GlobalOptions& global,
                     const SlurmOptions& options) {
    const fs::path out = fs::absolute(plan.out);
    std::error_code code;
    fs::create_directories(out, code);
    if (code) throw FileError(out.string(), "cannot be made: " + code.message());
    const std::string call = command(plan, global);
    const std::string count = std::to_string(options.tasks);
    write_text(out / "make.sbatch",
               script("toile-catalogue", out / "make-%a.log", options,
                      "#SBATCH --array=0-" + std::to_string(options.tasks - 1) + "\n",
                      call + " --threads \"$SLURM_CPUS_PER_TASK\" --share \"$SLURM_ARRAY_TASK_ID/" +
                          count + "\""));
    write_text(out / "merge.sbatch",
               script("toile-merge", out / "merge.log", options, "", call + " --merge"));
    const std::string job = submit({"sbatch", "--parsable", (out / "make.sbatch").string()});
    log::info("job " + job + ": " + count + " tasks make the items of " + plan.file.string());
    std::vector<std::string> merge = {"sbatch", "--parsable", "--dependency=afterany:" + job};
    if (options.wait) merge.emplace_back("--wait");
    merge.push_back((out / "merge.sbatch").string());
    if (options.wait) {
        const ChildResult child = run_child(merge, "");
        if (child.status != 0)
            throw Error("not every item was made; " + (out / "merge.log").string() +
                        " and summary.md name them");
        log::info("merged: " + (out / "summary.md").string());
        return;
    }
    log::info("job " + submit(merge) + ": merges them into " + out.string());
}

} // namespace toile::apps
