// `toile compare`: are two pictures the same up to a tolerance?
#include "apps/commands.h"
#include "apps/picture_comparison.h"
#include "core/error.h"
#include "core/log.h"

#include <cstdio>
#include <memory>

namespace toile::apps {
namespace {

struct CompareOptions {
    std::string first;
    std::string second;
    std::string difference;
    PictureTolerance tolerance;
    double share_percent = 0.1;
};

void compare(const CompareOptions& o) {
    PictureTolerance tolerance = o.tolerance;
    tolerance.share = o.share_percent / 100.0;
    const PictureComparison result = compare_pictures(o.first, o.second, tolerance, o.difference);
    if (!result.equal) throw Error(o.first + " and " + o.second + " differ: " + result.text);
    if (result.beyond_warn > 0) {
        log::warning(std::to_string(result.beyond_warn) + " pixels differ by more than --warn");
    }
    std::printf("equal within tolerance: %s\n", result.text.c_str());
}

} // namespace

void add_compare_commands(CLI::App& app, const GlobalOptions&) {
    auto o = std::make_shared<CompareOptions>();
    CLI::App* const command = app.add_subcommand(
        "compare", "Compare two pictures: exit status 0 when equal within tolerance, 1 when not");
    command->add_option("first", o->first, "A picture")->required()->type_name("A.png");
    command->add_option("second", o->second, "Another")->required()->type_name("B.png");
    command
        ->add_option("--fail", o->tolerance.small,
                     "Small limit: a share of the pixels may differ by more (0 to 1)")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    command->add_option("--fail-percent", o->share_percent, "That share, percent of the pixels")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    command->add_option("--max", o->tolerance.largest, "Hard limit: no pixel may differ by more")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    command->add_option("--warn", o->tolerance.warn, "Warn about pixels that differ by more")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    command->add_option("--diff", o->difference, "Write the differences, eight times as strong")
        ->type_name("OUT.png");
    command->footer("Example: toile compare look.png reference.png --fail 0.02 --fail-percent 0.1 "
                    "--max 0.5 --diff difference.png");
    command->callback([o] { compare(*o); });
}

} // namespace toile::apps
