// scan_evaluation CAPTURE TRUTH.obj [OPTION=VALUE ...]: how right fusion is on one recorded turn.
// Options: the filter's and the fusion's switches (see `set`), heights=a,b,c for girths (metres),
// out=FILE.ply. Shares of time on stderr.
#include "assets/colored_mesh.h"
#include "assets/files.h"
#include "core/error.h"
#include "scan/fusion.h"
#include "scan/subject.h"
#include "scan_errors.h"
#include "scan_pictures.h"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace {

using namespace toile;

struct Settings {
    scan::FilterOptions filter;
    scan::FusionOptions fusion;
    std::vector<float> heights;
    std::string out;
    bool known_poses = false; ///< from truth.jsonl
};

/// The first camera from each, of a subject that turned before it.
std::vector<scan::Pose> true_poses(const std::string& folder) {
    std::ifstream in(folder + "/truth.jsonl");
    std::vector<scan::Pose> out;
    for (std::string line; std::getline(in, line);) {
        const auto m =
            nlohmann::json::parse(line).at("body_from_camera").get<std::vector<double>>();
        scan::Pose pose = scan::Pose::Identity();
        std::copy_n(m.begin(), 16, pose.matrix().data());
        out.push_back(pose);
    }
    for (std::size_t i = out.size(); i-- > 0;)
        out[i] = out.front().inverse() * out[i];
    return out;
}

void set(Settings& s, const std::string& name, const std::string& value) {
    const double number = std::atof(value.c_str());
    if (name == "flying")
        s.filter.flying_pixels = number != 0;
    else if (name == "edges")
        s.filter.edge_pixels = static_cast<int>(number);
    else if (name == "bilateral")
        s.filter.joint_bilateral = number != 0;
    else if (name == "radius")
        s.filter.radius = static_cast<int>(number);
    else if (name == "steepest")
        s.filter.steepest = number;
    else if (name == "loop")
        s.fusion.close_loop = number != 0;
    else if (name == "joint")
        s.fusion.refine_jointly = number != 0;
    else if (name == "bias")
        s.fusion.bias_rounds = static_cast<int>(number);
    else if (name == "voxel")
        s.fusion.voxel_m = static_cast<float>(number);
    else if (name == "truncation")
        s.fusion.truncation_m = static_cast<float>(number);
    else if (name == "pair_angle")
        s.fusion.pair_angle = number;
    else if (name == "pairs")
        s.fusion.pairs = static_cast<std::size_t>(number);
    else if (name == "smooth")
        s.fusion.smoothing_rounds = static_cast<int>(number);
    else if (name == "out")
        s.out = value;
    else if (name == "known")
        s.known_poses = number != 0;
    else if (name == "heights") {
        std::istringstream in(value);
        for (std::string word; std::getline(in, word, ',');)
            s.heights.push_back(static_cast<float>(std::atof(word.c_str())));
    } else
        throw Error(name + ": no such option");
}

class Clock {
  public:
    void lap(const char* what) {
        const auto now = std::chrono::steady_clock::now();
        std::fprintf(stderr, "%-10s %6.2f s\n", what,
                     std::chrono::duration<double>(now - last_).count());
        last_ = now;
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void run(const std::string& folder, const std::string& truth_file, const Settings& s) {
    Clock clock;
    const imaging::CaptureCamera capture = imaging::open_capture(folder).cameras.at(0);
    const Eigen::Isometry3d world =
        capture.world_from_camera.value_or(Eigen::Isometry3d::Identity());
    const Vec3f up = (world.linear().transpose() * Vec3d::UnitY()).cast<float>();
    scan::RigidFusion fusion(s.fusion, evaluation::rows_on_all);
    std::optional<geometry::Plane> floor;
    const auto poses = s.known_poses ? true_poses(folder) : std::vector<scan::Pose>{};
    double load = 0, filter = 0, track = 0;
    for (std::uint32_t i = 0; i < capture.frames.size(); ++i) {
        const auto t0 = std::chrono::steady_clock::now();
        const imaging::DepthImage depth = capture.load_depth(i);
        const auto t1 = std::chrono::steady_clock::now();
        const auto colors = evaluation::colors_of(capture, i);
        const scan::Picture picture{capture.intrinsics, depth.metres, colors};
        const scan::Subject subject = scan::find_subject(picture, up);
        if (!subject.trouble.empty()) throw Error(subject.trouble);
        if (i == 0) floor = subject.floor;
        scan::DepthView view =
            scan::filtered_view(picture, subject.mask, s.filter, evaluation::rows_on_all);
        const auto t2 = std::chrono::steady_clock::now();
        if (s.known_poses)
            fusion.add_at(std::move(view), poses.at(i));
        else
            fusion.add(std::move(view));
        const auto t3 = std::chrono::steady_clock::now();
        load += std::chrono::duration<double>(t1 - t0).count();
        filter += std::chrono::duration<double>(t2 - t1).count();
        track += std::chrono::duration<double>(t3 - t2).count();
    }
    std::fprintf(stderr, "load %.2f filter %.2f track %.2f s\n", load, filter, track);
    clock.lap("frames");
    scan::FusedSurface fused = fusion.finish(floor, [](double) {});
    clock.lap("finish");
    const auto& r = fused.report;
    std::printf("frames %zu lost %zu turn %.1f deg loop %d gap %.2f mm error %.2f mm joint rms "
                "%.2f surface rms %.2f mm guessed %.1f %% floor %d, %zu triangles\n",
                r.frames, r.lost_frames, r.turn_rad * 57.29578, r.loop_closed, 1e3 * r.loop_gap_m,
                1e3 * r.loop_error_m, 1e3 * r.joint_rms_m, 1e3 * r.surface_rms_m,
                100 * r.guessed_share, floor.has_value(), fused.mesh.triangles.size());
    for (Vec3f& p : fused.mesh.positions)
        p = (world * p.cast<double>()).cast<float>();
    if (!s.out.empty()) {
        assets::ColoredMesh mesh{fused.mesh, fused.colors};
        assets::save_scene(assets::scene_of(mesh, "scan"), s.out);
    }
    evaluation::compare(fused.mesh, evaluation::load_truth(truth_file), s.heights);
    clock.lap("compare");
}

} // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 3) throw toile::Error("scan_evaluation CAPTURE TRUTH.obj [OPTION=VALUE ...]");
        Settings settings;
        for (int i = 3; i < argc; ++i) {
            const std::string word = argv[i];
            const auto at = word.find('=');
            set(settings, word.substr(0, at), at == std::string::npos ? "1" : word.substr(at + 1));
        }
        settings.fusion.filter = settings.filter;
        run(argv[1], argv[2], settings);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}
