// moving_scan_evaluation CAPTURE TRUTH guide=FILE [OPTION=VALUE ...]: how right the scan of a
// person who moves is. The body fitted to some of the frames is kept in FILE and read from there
// the next time. Options: see `set`; heights=a,b,c for girths (metres), out=FILE.ply.
#include "assets/colored_mesh.h"
#include "assets/files.h"
#include "core/error.h"
#include "host/views.h"
#include "pipeline/body_fit.h"
#include "scan/warp_session.h"
#include "scan_errors.h"
#include "scan_pictures.h"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace {

using namespace toile;

constexpr std::size_t kInstants = 13;

struct Settings {
    scan::WarpSessionOptions session;
    std::vector<float> heights;
    std::string guide, out;
    std::uint32_t every = 1; ///< of the frames
};

/// A body at some frames.
struct Guide {
    std::vector<std::uint32_t> numbers;
    std::vector<geometry::TriangleMesh> bodies;
    std::vector<std::uint8_t> labels;
};

template <class T>
void put(std::ostream& out, const std::vector<T>& rows) {
    const std::uint64_t count = rows.size();
    out.write(reinterpret_cast<const char*>(&count), sizeof(count));
    out.write(reinterpret_cast<const char*>(rows.data()),
              static_cast<std::streamsize>(count * sizeof(T)));
}

template <class T>
void get(std::istream& in, std::vector<T>& rows) {
    std::uint64_t count = 0;
    in.read(reinterpret_cast<char*>(&count), sizeof(count));
    rows.resize(count);
    in.read(reinterpret_cast<char*>(rows.data()), static_cast<std::streamsize>(count * sizeof(T)));
}

Guide fitted(const std::string& folder) {
    host::Services services(2);
    host::Registry registry(services, {});
    auto limits = host::sized<toile_limits>();
    limits.max_people = 1;
    limits.max_vertices = 2'000'000;
    limits.max_triangles = 4'000'000;
    limits.thread_count = services.thread_count();
    limits.random_seed = 1;
    host::Job job;
    pipeline::SensorSource source("capture:" + folder, registry, services, limits, job);
    std::vector<pipeline::SensorFrame> frames;
    for (pipeline::SensorFrame frame; source.next(0, frame);)
        frames.push_back(frame);
    pipeline::BodyFit fit(registry, services, limits);
    fit.begin_cameras(source.streams(), job);
    Guide out;
    for (std::size_t k = 0; k < kInstants; ++k) {
        const std::size_t at = k * (frames.size() - 1) / (kInstants - 1);
        out.numbers.push_back(static_cast<std::uint32_t>(at));
        fit.feed_frames({&frames[at], 1});
    }
    pipeline::FittedBody body = fit.fit({}, job);
    out.bodies = std::move(body.surfaces);
    out.labels = std::move(body.part_labels);
    return out;
}

Guide guide_of(const std::string& folder, const std::string& file) {
    Guide out;
    if (std::filesystem::exists(file)) {
        std::ifstream in(file, std::ios::binary);
        get(in, out.numbers);
        get(in, out.labels);
        out.bodies.resize(out.numbers.size());
        for (auto& body : out.bodies) {
            get(in, body.positions);
            get(in, body.triangles);
        }
        return out;
    }
    out = fitted(folder);
    std::ofstream to(file, std::ios::binary);
    put(to, out.numbers);
    put(to, out.labels);
    for (const auto& body : out.bodies) {
        put(to, body.positions);
        put(to, body.triangles);
    }
    return out;
}

void set(Settings& s, const std::string& name, const std::string& value) {
    const double number = std::atof(value.c_str());
    scan::WarpFusionOptions& warp = s.session.warp;
    if (name == "guide")
        s.guide = value;
    else if (name == "out")
        s.out = value;
    else if (name == "every")
        s.every = static_cast<std::uint32_t>(number);
    else if (name == "parts")
        s.session.by_parts = number != 0;
    else if (name == "iterations")
        s.session.parts.iterations = static_cast<int>(number);
    else if (name == "part_reach")
        s.session.parts.options.start_reach_m = static_cast<float>(number);
    else if (name == "views")
        s.session.subject.most_views = static_cast<std::size_t>(number);
    else if (name == "nodes")
        warp.nodes = static_cast<std::size_t>(number);
    else if (name == "rounds")
        warp.rounds = static_cast<int>(number);
    else if (name == "pairs")
        warp.pairs = static_cast<std::size_t>(number);
    else if (name == "reach")
        warp.joint.reach_m = static_cast<float>(number);
    else if (name == "end_reach")
        warp.end_reach_m = static_cast<float>(number);
    else if (name == "stride")
        warp.joint.stride = static_cast<int>(number);
    else if (name == "smoothness")
        warp.joint.smoothness = number;
    else if (name == "steadiness")
        warp.joint.steadiness = number;
    else if (name == "trust")
        warp.joint.trust = number;
    else if (name == "bias")
        warp.bias_rounds = static_cast<int>(number);
    else if (name == "likely")
        warp.likely_m = number;
    else if (name == "voxel")
        warp.voxel_m = static_cast<float>(number);
    else if (name == "disc")
        warp.disc_m = static_cast<float>(number);
    else if (name == "heights") {
        std::istringstream in(value);
        for (std::string word; std::getline(in, word, ',');)
            s.heights.push_back(static_cast<float>(std::atof(word.c_str())));
    } else
        throw Error(name + ": no such option");
}

void run(const std::string& folder, const std::string& truth, const Settings& s) {
    const imaging::CaptureCamera capture = imaging::open_capture(folder).cameras.at(0);
    scan::WarpSession session({capture.intrinsics, capture.world_from_camera}, s.session,
                              evaluation::rows_on_all);
    for (std::uint32_t i = 0; i < capture.frames.size(); i += s.every) {
        const imaging::DepthImage depth = capture.load_depth(i);
        session.add(depth.metres, evaluation::colors_of(capture, i));
    }
    if (!s.guide.empty()) {
        Guide guide = guide_of(folder, s.guide);
        for (std::size_t k = 0; k < guide.numbers.size(); ++k)
            if (guide.numbers[k] % s.every == 0)
                session.guide(guide.numbers[k] / s.every, std::move(guide.bodies[k]), guide.labels);
    }
    auto last = std::chrono::steady_clock::now();
    scan::WarpSessionResult result = session.finish([&](double share) {
        const auto now = std::chrono::steady_clock::now();
        std::fprintf(stderr, "%.2f after %.1f s\n", share,
                     std::chrono::duration<double>(now - last).count());
        last = now;
    });
    std::fprintf(stderr, "end after %.1f s\n",
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - last).count());
    std::printf("%s\n", result.report.dump().c_str());
    if (!s.out.empty())
        assets::save_scene(assets::scene_of({result.mesh, result.colors}, "scan"), s.out);
    evaluation::compare(result.mesh, evaluation::load_truth(truth), s.heights);
}

} // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 3) throw toile::Error("moving_scan_evaluation CAPTURE TRUTH [OPTION=VALUE ...]");
        Settings settings;
        for (int i = 3; i < argc; ++i) {
            const std::string word = argv[i];
            const auto at = word.find('=');
            set(settings, word.substr(0, at), at == std::string::npos ? "1" : word.substr(at + 1));
        }
        run(argv[1], argv[2], settings);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}
