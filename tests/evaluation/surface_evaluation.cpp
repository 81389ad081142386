// surface_evaluation SCAN TRUTH [HEIGHT ...] [write=FILE]: how far a scan is from the true surface,
// and its girths at heights in metres. TRUTH: a mesh, or the folder of a recording's truth, whose
// first surface goes to FILE.
#include "assets/colored_mesh.h"
#include "assets/files.h"
#include "core/error.h"
#include "scan_errors.h"

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    using namespace toile;
    try {
        if (argc < 3) throw Error("surface_evaluation SCAN TRUTH [HEIGHT ...] [write=FILE]");
        const geometry::TriangleMesh truth = evaluation::load_truth(argv[2]);
        std::vector<float> heights;
        for (int i = 3; i < argc; ++i) {
            const std::string word = argv[i];
            if (word.starts_with("write="))
                assets::save_scene(assets::scene_of({truth, {}}, "truth"), word.substr(6));
            else
                heights.push_back(static_cast<float>(std::atof(argv[i])));
        }
        evaluation::compare(assets::load_colored_mesh(argv[1]).mesh, truth, heights);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}
