// surface_evaluation SCAN TRUTH [HEIGHT ...]: how far a scan is from the true surface, and its
// girths at heights in metres. TRUTH: a mesh, or the folder of a recording's truth.
#include "assets/colored_mesh.h"
#include "core/error.h"
#include "scan_errors.h"

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    using namespace toile;
    try {
        if (argc < 3) throw Error("surface_evaluation SCAN TRUTH [HEIGHT ...]");
        std::vector<float> heights;
        for (int i = 3; i < argc; ++i)
            heights.push_back(static_cast<float>(std::atof(argv[i])));
        evaluation::compare(assets::load_colored_mesh(argv[1]).mesh,
                            evaluation::load_truth(argv[2]), heights);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}
