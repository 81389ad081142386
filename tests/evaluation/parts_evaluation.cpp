// Labels held-out noisy frames with our forest and with PCL's three trees, and compares both with
// the truth in P4's twelve parts; and how long a pixel takes.
//
//     parts_evaluation MODEL_FOLDER FILE.forest --motions FILE|DIR [--pcl DIR] [--frames N]
//         [--width N] [--json FILE]
//
// Poses are those of the motions as recorded, people are drawn with a seed of their own. What PCL
// leaves open (whose left is left, how far away nobody is) is taken as it suits PCL best.
#include "body_tracker/forest.h"
#include "body_tracker/parts_frames.h"
#include "core/bytes.h"
#include "core/error.h"
#include "evaluation/pcl_forest.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>

namespace {

namespace fs = std::filesystem;
namespace body = toile::body;
namespace tracker = toile::body_tracker;
namespace evaluation = toile::evaluation;
using body::Part;

constexpr std::size_t kParts = 13; // with invalid

struct Settings {
    fs::path model, forest, pcl, json;
    std::vector<fs::path> motions;
    int frames = 600, people = 100, width = 640, pixels = 400;
    std::uint64_t seed = 999;
};

double cpu_s() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Pixels right of all, and of each true part.
struct Tally {
    std::array<double, kParts> right{}, all{};

    void add(Part truth, bool is_right) {
        all[static_cast<std::size_t>(truth)] += 1.0;
        if (is_right) right[static_cast<std::size_t>(truth)] += 1.0;
    }
    [[nodiscard]] double share() const {
        double r = 0.0, n = 0.0;
        for (std::size_t p = 0; p < kParts; ++p)
            r += right[p], n += all[p];
        return r / std::max(n, 1.0);
    }
    [[nodiscard]] double mean_of_parts() const {
        double sum = 0.0, count = 0.0;
        for (std::size_t p = 0; p < kParts; ++p)
            if (all[p] > 0.0) sum += right[p] / all[p], count += 1.0;
        return sum / std::max(count, 1.0);
    }
};

struct Result {
    Tally parts;
    double seconds = 0.0, pixel_trees = 0.0;
    [[nodiscard]] double ns() const { return 1e9 * seconds / std::max(pixel_trees, 1.0); }
};

struct Pixel {
    int x, y;
    tracker::PartLabel truth;
};

std::vector<Pixel> pixels_of(const tracker::PartsFrame& frame, int wanted) {
    std::vector<Pixel> all, out;
    for (int y = 0; y < frame.height; ++y)
        for (int x = 0; x < frame.width; ++x)
            if (const auto label = frame.labels[static_cast<std::size_t>(y * frame.width + x)];
                label != tracker::PartLabel::invalid)
                all.push_back({x, y, label});
    const auto count = std::min(all.size(), static_cast<std::size_t>(wanted));
    for (std::size_t k = 0; k < count; ++k)
        out.push_back(all[(2 * k + 1) * all.size() / (2 * count)]);
    return out;
}

/// Ours; `fine` are all 22 parts.
void label_ours(const tracker::Forest& forest, const tracker::PartsFrame& frame,
                std::span<const Pixel> pixels, Result& out, double& fine, double& total) {
    const tracker::DepthView view{frame.width, frame.height, frame.focal_px, frame.mm.data()};
    std::array<std::uint16_t, tracker::kPartCount> sums{};
    std::vector<tracker::PartLabel> found(pixels.size());
    const double start = cpu_s();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        tracker::classify(forest, view, pixels[i].x, pixels[i].y, sums);
        found[i] = static_cast<tracker::PartLabel>(
            1 + (std::max_element(sums.begin(), sums.end()) - sums.begin()));
    }
    out.seconds += cpu_s() - start;
    out.pixel_trees += static_cast<double>(pixels.size() * forest.trees.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Part truth = tracker::p4_part(pixels[i].truth);
        out.parts.add(truth, tracker::p4_part(found[i]) == truth);
        fine += found[i] == pixels[i].truth ? 1.0 : 0.0;
        total += 1.0;
    }
}

/// One way to ask PCL's trees.
struct PclWay {
    bool mirrored = false; ///< its left is the picture's
    int away_mm = 32767;   ///< where nobody is
    Result result;

    [[nodiscard]] std::string text() const {
        return std::string(mirrored ? "left of the picture" : "left of the person") +
               ", nobody at " + std::to_string(away_mm) + " mm";
    }
};

Part other_side(Part part) {
    switch (part) {
    case Part::left_upper_arm:
        return Part::right_upper_arm;
    case Part::right_upper_arm:
        return Part::left_upper_arm;
    case Part::left_lower_arm:
        return Part::right_lower_arm;
    case Part::right_lower_arm:
        return Part::left_lower_arm;
    case Part::left_upper_leg:
        return Part::right_upper_leg;
    case Part::right_upper_leg:
        return Part::left_upper_leg;
    case Part::left_lower_leg:
        return Part::right_lower_leg;
    case Part::right_lower_leg:
        return Part::left_lower_leg;
    default:
        return part;
    }
}

void label_pcl(const std::vector<evaluation::PclTree>& trees, const tracker::PartsFrame& frame,
               std::span<const Pixel> pixels, PclWay& way) {
    std::vector<std::uint16_t> mm = frame.mm;
    std::replace(mm.begin(), mm.end(), std::uint16_t{0}, static_cast<std::uint16_t>(way.away_mm));
    std::vector<std::uint8_t> found(pixels.size());
    const double start = cpu_s();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        std::array<std::uint8_t, evaluation::kPclLabels> votes{};
        for (const evaluation::PclTree& tree : trees)
            ++votes[tree.label(mm.data(), frame.width, frame.height, frame.focal_px, pixels[i].x,
                               pixels[i].y)];
        found[i] =
            static_cast<std::uint8_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
    }
    way.result.seconds += cpu_s() - start;
    way.result.pixel_trees += static_cast<double>(pixels.size() * trees.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Part truth = tracker::p4_part(pixels[i].truth);
        const Part wanted = way.mirrored ? other_side(truth) : truth;
        const auto parts = evaluation::pcl_parts(found[i]);
        way.result.parts.add(truth, parts[0] == wanted || parts[1] == wanted);
    }
}

tracker::FrameRange range_of(const Settings& settings, double facing) {
    tracker::FrameRange out;
    const double scale = settings.width / static_cast<double>(out.width);
    out.width = settings.width;
    out.height = static_cast<int>(out.height * scale);
    out.focal_px = static_cast<float>(static_cast<double>(out.focal_px) * scale);
    out.upright_share = 0.0;
    out.facing_share = facing;
    out.poses = {1.0, 0.0, 0.0};
    return out;
}

nlohmann::ordered_json row(const char* name, const Result& result) {
    nlohmann::ordered_json out{{"forest", name},
                               {"right", result.parts.share()},
                               {"mean_of_parts", result.parts.mean_of_parts()},
                               {"ns_per_pixel_and_tree", result.ns()}};
    for (std::size_t p = 1; p < kParts; ++p)
        out["parts"][std::string(body::part_label(static_cast<Part>(p)))] =
            result.parts.right[p] / std::max(result.parts.all[p], 1.0);
    std::printf("  %-6s %6.1f %% of pixels, %6.1f %% mean of parts, %6.1f ns a pixel and tree\n",
                name, 100.0 * result.parts.share(), 100.0 * result.parts.mean_of_parts(),
                result.ns());
    for (std::size_t p = 1; p < kParts; ++p)
        std::printf("%s%s %.0f", p == 1 ? "         " : ", ",
                    std::string(body::part_label(static_cast<Part>(p))).c_str(),
                    100.0 * result.parts.right[p] / std::max(result.parts.all[p], 1.0));
    std::printf("\n");
    return out;
}

nlohmann::ordered_json evaluate(const Settings& settings, const body::BodySpace& space,
                                const tracker::Forest& forest,
                                const std::vector<evaluation::PclTree>& trees, bool facing) {
    const tracker::FrameMaker maker(space, settings.people, settings.seed,
                                    range_of(settings, facing ? 1.0 : 0.0),
                                    tracker::read_poses(settings.motions, space.model().skeleton));
    Result ours;
    double fine = 0.0, total = 0.0;
    std::vector<PclWay> ways;
    if (!trees.empty())
        for (const bool mirrored : {false, true})
            for (const int away : {10000, 32767})
                ways.push_back({mirrored, away, {}});
    for (int f = 0; f < settings.frames; ++f) {
        const tracker::PartsFrame frame = maker.make(static_cast<std::uint32_t>(f));
        const auto pixels = pixels_of(frame, settings.pixels);
        label_ours(forest, frame, pixels, ours, fine, total);
        for (PclWay& way : ways)
            label_pcl(trees, frame, pixels, way);
    }
    std::printf("%s, %d frames of %d x %d:\n",
                facing ? "people within 60 degrees of the camera" : "people of any facing",
                settings.frames, maker.make(0).width, maker.make(0).height);
    nlohmann::ordered_json out{{"facing", facing}, {"frames", settings.frames}};
    out["rows"].push_back(row("Toile", ours));
    out["fine_right"] = fine / std::max(total, 1.0);
    std::printf("         of all 22 parts %.1f %%\n", 100.0 * fine / std::max(total, 1.0));
    if (ways.empty()) return out;
    const auto best = std::max_element(ways.begin(), ways.end(), [](const auto& a, const auto& b) {
        return a.result.parts.mean_of_parts() < b.result.parts.mean_of_parts();
    });
    out["rows"].push_back(row("PCL", best->result));
    std::printf("         taken as: %s\n", best->text().c_str());
    return out;
}

void run(const Settings& settings) {
    const auto space = body::BodySpace::load(settings.model);
    const tracker::Forest forest = tracker::load_forest(settings.forest);
    if (forest.class_count != tracker::kPartCount)
        throw toile::Error(settings.forest.string() + ": is not of the 22 body parts");
    std::vector<evaluation::PclTree> trees;
    if (!settings.pcl.empty())
        for (const int t : {1, 2, 3})
            trees.emplace_back(settings.pcl / ("forest" + std::to_string(t) + "_tree_20.txt.bz2"));
    nlohmann::ordered_json out;
    for (const bool facing : {true, false})
        out.push_back(evaluate(settings, space, forest, trees, facing));
    if (!settings.json.empty()) toile::write_text(settings.json, out.dump(2) + "\n");
}

} // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Body-part labels against the truth and against PCL's forests");
    app.add_option("model", settings.model)->required()->check(CLI::ExistingDirectory);
    app.add_option("forest", settings.forest)->required()->check(CLI::ExistingFile);
    app.add_option("--motions", settings.motions)->required()->check(CLI::ExistingPath);
    app.add_option("--pcl", settings.pcl)->check(CLI::ExistingDirectory);
    app.add_option("--frames", settings.frames);
    app.add_option("--people", settings.people);
    app.add_option("--pixels", settings.pixels);
    app.add_option("--width", settings.width);
    app.add_option("--seed", settings.seed);
    app.add_option("--json", settings.json);
    CLI11_PARSE(app, argc, argv);
    try {
        run(settings);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "parts_evaluation: %s\n", e.what());
        return 1;
    }
    return 0;
}
