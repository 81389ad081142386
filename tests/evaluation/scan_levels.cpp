// scan_levels SCAN.ply: what coarser versions of a scan cost and lose (P1 4.5's table).
#include "assets/colored_mesh.h"
#include "assets/files.h"
#include "geometry/decimate.h"
#include "scan_errors.h"

#include <chrono>
#include <cstdio>
#include <filesystem>

namespace {

using namespace toile;
namespace fs = std::filesystem;

/// Milliseconds of the quickest of five readings.
double import_ms(const fs::path& file) {
    double best = 1e9;
    for (int k = 0; k < 5; ++k) {
        const auto start = std::chrono::steady_clock::now();
        (void)assets::load_scene(file);
        best = std::min(best, std::chrono::duration<double, std::milli>(
                                  std::chrono::steady_clock::now() - start)
                                  .count());
    }
    return best;
}

void level(const assets::ColoredMesh& full, const assets::ColoredMesh& mesh,
           const fs::path& folder) {
    const auto off = evaluation::deviation(full.mesh.positions, mesh.mesh);
    std::printf("| %zu |", mesh.mesh.triangles.size());
    for (const char* kind : {".ply", ".glb"}) {
        const fs::path file = folder / (std::string("level") + kind);
        assets::save_scene(assets::scene_of(mesh, "scan"), file);
        std::printf(" %.2f | %.0f |", 1e-6 * static_cast<double>(fs::file_size(file)),
                    import_ms(file));
    }
    std::printf(" %.2f | %.2f | %.1f |\n", 1e3 * off.mean_m, 1e3 * off.p95_m, 1e3 * off.most_m);
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fputs("scan_levels SCAN.ply\n", stderr), 2;
    try {
        const fs::path folder = fs::temp_directory_path() / "toile_scan_levels";
        fs::create_directories(folder);
        assets::ColoredMesh mesh = assets::load_colored_mesh(argv[1]);
        std::puts("| triangles | .ply MB | import ms | .glb MB | import ms | error mean mm | 95 % "
                  "| most |\n"
                  "|---|---|---|---|---|---|---|---|");
        const assets::ColoredMesh full = mesh;
        level(full, full, folder);
        for (const std::size_t count : {200'000, 100'000, 50'000, 20'000, 10'000, 5'000, 2'000})
            if (count < full.mesh.triangles.size()) {
                mesh = assets::decimated(mesh, count);
                level(full, mesh, folder);
            }
        fs::remove_all(folder);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}
