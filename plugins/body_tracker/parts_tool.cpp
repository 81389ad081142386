#include "body_tracker/parts_tool.h"

#include "body_tracker/parts_poses.h"
#include "body_tracker/parts_training.h"
#include "core/error.h"

namespace toile::body_tracker {
namespace {

constexpr std::uint32_t kSize = sizeof(toile_tool_option);

constexpr std::array kOptions{
    toile_tool_option{kSize, TOILE_OPTION_PATH, TOILE_OPTION_REQUIRED, 0, "model", "DIR",
                      "The body space whose people are drawn", nullptr, 0, 0},
    toile_tool_option{kSize, TOILE_OPTION_OUTPUT, TOILE_OPTION_REQUIRED, 0, "out", "FILE.forest",
                      "Gets the forest", nullptr, 0, 0},
    toile_tool_option{kSize, TOILE_OPTION_PATH, TOILE_OPTION_REPEATED, 0, "motions", "FILE|DIR",
                      "Recorded motions whose poses are mixed in; may be given again", nullptr, 0,
                      0},
    toile_tool_option{kSize, TOILE_OPTION_INTEGER, 0, 0, "frames", nullptr, "Depth frames drawn",
                      "20000", 1, 1000000},
    toile_tool_option{kSize, TOILE_OPTION_INTEGER, 0, 0, "people", nullptr,
                      "Different bodies in them", "600", 1, 100000},
    toile_tool_option{kSize, TOILE_OPTION_INTEGER, 0, 0, "pixels", nullptr,
                      "Pixels taken of a frame", "200", 1, 19200},
    toile_tool_option{kSize, TOILE_OPTION_INTEGER, 0, 0, "trees", nullptr, "Trees", "3", 1,
                      kMaxTrees},
    toile_tool_option{kSize, TOILE_OPTION_INTEGER, 0, 0, "depth", nullptr,
                      "Questions from the root to a leaf, at most", "18", 1, 30},
    toile_tool_option{kSize, TOILE_OPTION_INTEGER, 0, 0, "leaves", nullptr,
                      "Leaves of a tree, at most", "60000", 2, 1000000},
    toile_tool_option{kSize, TOILE_OPTION_INTEGER, 0, 0, "candidates", nullptr,
                      "Questions tried at a node", "250", 1, 10000},
    toile_tool_option{kSize, TOILE_OPTION_REAL, 0, 0, "balance", nullptr,
                      "0: pixels count the same, 1: parts do", "0.5", 0, 1},
    toile_tool_option{kSize, TOILE_OPTION_OUTPUT, 0, 0, "checkpoint", "FILE",
                      "Keeps the levels that are done; the same call goes on from it", nullptr, 0,
                      0},
};

PartsTrainingOptions read_options(const sdk::ToolArguments& arguments, std::uint64_t seed) {
    PartsTrainingOptions out;
    out.frames = arguments.number("frames", out.frames);
    out.people = arguments.number("people", out.people);
    out.pixels = arguments.number("pixels", out.pixels);
    TrainerOptions& trainer = out.trainer;
    trainer.seed = seed;
    trainer.tree_count = arguments.number("trees", trainer.tree_count);
    trainer.depth = arguments.number("depth", trainer.depth);
    trainer.max_leaves = arguments.number("leaves", trainer.max_leaves);
    trainer.candidates = arguments.number("candidates", trainer.candidates);
    trainer.balance = arguments.number("balance", trainer.balance);
    trainer.checkpoint = arguments.text("checkpoint").value_or("");
    return out;
}

} // namespace

toile_tool_info parts_tool_info() {
    return {sizeof(toile_tool_info),
            static_cast<std::uint32_t>(kOptions.size()),
            "avatar train-parts",
            "Train the forest that finds body parts in depth frames",
            "toile avatar train-parts --model avatars/adult --motions walk.bvh "
            "--out adult.forest --checkpoint adult.checkpoint",
            kOptions.data()};
}

std::string train_parts_by(const sdk::ToolArguments& arguments, const PartsToolSetting& setting,
                           sdk::Job job) {
    const auto wanted = [&](const char* name) {
        const auto given = arguments.text(name);
        if (!given) throw sdk::bad_argument(std::string("--") + name + " is missing");
        return std::filesystem::path(*given);
    };
    const std::filesystem::path model = wanted("model"), out = wanted("out");
    // Told before hours of work, not after.
    if (!out.parent_path().empty() && !std::filesystem::is_directory(out.parent_path()))
        throw sdk::Failure(TOILE_E_IO, out.string() + ": there is no folder " +
                                           out.parent_path().string() + "; make it first");
    const auto space = body::BodySpace::load(model);
    const auto named = arguments.values("motions");
    const std::vector<std::filesystem::path> motions(named.begin(), named.end());
    const auto forest = train_parts(
        space, read_poses(motions, space.model().skeleton), read_options(arguments, setting.seed),
        setting.rows,
        [&](double share, const std::string& text) { return !job.cancelled(share, text.c_str()); });
    if (!forest) throw sdk::Failure(TOILE_CANCELLED, "stopped");
    save_forest(*forest, out);
    std::size_t leaves = 0;
    for (const ForestTree& tree : forest->trees)
        leaves += tree.leaves.size() / kPartCount;
    return out.string() + ": " + std::to_string(forest->trees.size()) + " trees with " +
           std::to_string(leaves) + " leaves";
}

} // namespace toile::body_tracker
