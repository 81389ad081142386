// rig_evaluation CAPTURE RIG.json [SCAN]: how right a calibration of simulated cameras is, and a
// surface that was scanned with it. CAPTURE holds one folder a camera, with truth_camera.json.
#include "assets/colored_mesh.h"
#include "core/error.h"
#include "imaging/rig_file.h"
#include "scan_errors.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace {

using namespace toile;
namespace fs = std::filesystem;

std::vector<Eigen::Isometry3d> true_places(const fs::path& capture) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(capture))
        if (fs::exists(entry.path() / "truth_camera.json"))
            files.push_back(entry.path() / "truth_camera.json");
    std::sort(files.begin(), files.end());
    std::vector<Eigen::Isometry3d> out;
    for (const fs::path& file : files) {
        const nlohmann::json json = parse_json_file(file);
        JsonObject root(json, file.string());
        out.push_back(imaging::read_rigid_motion(root, "world_from_camera"));
    }
    return out;
}

/// Of each camera as the first one has it; and how far apart truth and estimate have the middle of
/// what they look at.
void print_errors(const std::vector<Eigen::Isometry3d>& truth, const imaging::RigFile& rig) {
    const Vec3d middle(0.0, 0.9, 0.0); // where people stand, world
    double most_mm = 0.0, most_deg = 0.0, most_there = 0.0;
    for (std::size_t c = 1; c < truth.size(); ++c) {
        const Eigen::Isometry3d wanted = truth[0].inverse() * truth[c];
        const Eigen::Isometry3d found =
            rig.cameras[0].world_from_camera.inverse() * rig.cameras[c].world_from_camera;
        const double mm = 1e3 * (wanted.translation() - found.translation()).norm();
        const double deg =
            Eigen::AngleAxisd(wanted.linear().transpose() * found.linear()).angle() * 57.29578;
        const Vec3d seen = truth[c].inverse() * middle;
        const double there = 1e3 * (wanted * seen - found * seen).norm();
        std::printf("  %-10s %5.2f mm %6.3f deg; at the subject %5.2f mm\n",
                    rig.cameras[c].name.c_str(), mm, deg, there);
        most_mm = std::max(most_mm, mm), most_deg = std::max(most_deg, deg);
        most_there = std::max(most_there, there);
    }
    std::printf("  worst      %5.2f mm %6.3f deg; at the subject %5.2f mm\n", most_mm, most_deg,
                most_there);
}

void print(const char* what, const evaluation::Deviation& d) {
    std::printf("  %-26s mean %5.2f  95 %% %5.2f  most %6.2f mm\n", what, 1e3 * d.mean_m,
                1e3 * d.p95_m, 1e3 * d.most_m);
}

void run(const fs::path& capture, const fs::path& rig_file, const fs::path& scan_file) {
    const auto truth = true_places(capture);
    const imaging::RigFile rig = imaging::load_rig(rig_file);
    if (truth.size() != rig.cameras.size()) throw Error("another number of cameras");
    print_errors(truth, rig);
    if (scan_file.empty()) return;
    auto scan = assets::load_colored_mesh(scan_file).mesh;
    const auto body = assets::load_colored_mesh(capture / "truth" / "surfaces.glb").mesh;
    const Eigen::Isometry3d world = truth[0] * rig.cameras[0].world_from_camera.inverse();
    for (Vec3f& p : scan.positions)
        p = (world * p.cast<double>()).cast<float>();
    print("from the first camera", evaluation::deviation(scan.positions, body));
    const Eigen::Isometry3d move = evaluation::best_motion(scan.positions, body);
    for (Vec3f& p : scan.positions)
        p = (move * p.cast<double>()).cast<float>();
    print("laid on the truth", evaluation::deviation(scan.positions, body));
    print("truth to scan", evaluation::deviation(body.positions, scan));
}

} // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 3) throw toile::Error("rig_evaluation CAPTURE RIG.json [SCAN]");
        run(argv[1], argv[2], argc > 3 ? argv[3] : "");
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}
