// The dress of the shared data set cloth_scene, 3 s at 60 Hz, on one thread, by a cloth plugin that
// is loaded as the program loads it. One line of JSON per run:
//
//     cloth_scene_bench                                    every level and motion, toile.xpbd_cloth
//     cloth_scene_bench --plugin toile.bullet_cloth --level 3k --motion arms --set substep_rate=960
//     cloth_scene_bench --level 10k --motion static --out DIR    and the last frame as OBJ
#include "bench/cloth_scene.h"
#include "host/instance.h"
#include "host/registry.h"
#include "host/views.h"
#include "support/shared_data.h"

#include <algorithm>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>

namespace {

using namespace toile;

struct Options {
    std::string plugin = "toile.xpbd_cloth";
    std::vector<std::string> levels{"3k", "10k", "30k", "3k+3k"}, motions{"static", "arms"};
    std::vector<std::pair<std::string, double>> parameters{
        // params.json: 3 mm from the skin; nothing holds the dress but friction
        {"margin", 0.00275},
        {"leash", 5.0}};
    std::filesystem::path out;
    int frames = bench::ClothScene::kFrames;
    bool measure = true; // every frame
};

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--speed") {
            options.measure = false;
            continue;
        }
        if (i + 1 >= argc) throw std::runtime_error(word + ": needs a value, or is unknown");
        const std::string value = argv[++i];
        if (word == "--plugin") {
            options.plugin = value;
        } else if (word == "--level") {
            options.levels = {value};
        } else if (word == "--motion") {
            options.motions = {value};
        } else if (word == "--frames") {
            options.frames = std::stoi(value);
        } else if (word == "--out") {
            options.out = value;
        } else if (word == "--set") {
            const auto split = value.find('=');
            options.parameters.emplace_back(value.substr(0, split),
                                            std::stod(value.substr(split + 1)));
        } else {
            throw std::runtime_error(word + ": unknown; see the head of cloth_scene_bench.cpp");
        }
    }
    return options;
}

double cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

using Joints = std::array<std::uint16_t, 4>;
using Weights = std::array<float, 4>;

/// The arms are told as the shoulders' parts, so that cloth may slide from them to the trunk.
void skin_of(const std::vector<std::array<float, 2>>& arm, std::vector<Joints>& joints,
             std::vector<Weights>& weights) {
    joints.assign(arm.size(), {TOILE_JOINT_UPPER_CHEST, TOILE_JOINT_LEFT_SHOULDER,
                               TOILE_JOINT_RIGHT_SHOULDER, 0});
    for (const auto& row : arm)
        weights.push_back({1.0f - row[0] - row[1], row[0], row[1], 0.0f});
}

/// The dress, or one over the other, in a plugin's world, stepped through the boundary.
class Dress {
  public:
    Dress(const bench::ClothScene& scene, host::Registry& registry, host::Services& services,
          const Options& options)
        : scene_(scene), instance_(registry.find(TOILE_CLOTH, options.plugin), services),
          table_(instance_.table<toile_cloth>()), before(scene.body.positions), after(before),
          targets(scene.cloth.positions), positions(targets), normals(targets) {
        const auto& parameters = instance_.table<toile_parameters>();
        for (const auto& [id, value] : options.parameters)
            instance_.call(id.c_str(),
                           [&](toile_instance* i) { return parameters.set(i, id.c_str(), value); });
        auto limits = host::sized<toile_limits>();
        limits.thread_count = 1;
        instance_.activate(limits);
        set_up();
    }

    /// \return CPU milliseconds of the step
    double step(double dt_s, bool reset) {
        auto was = host::sized<toile_body_state>();
        was.person_id = 1;
        was.tracking = TOILE_TRACKING_TRACKED;
        was.body_revision = 1;
        toile_body_state now = was;
        was.positions = host::view_of(before);
        now.positions = host::view_of(after);
        const std::size_t rows = targets.size() / garments_.size();
        for (std::size_t k = 0; k < garments_.size(); ++k) {
            const auto part = [&](auto& all) { return std::span(all).subspan(k * rows, rows); };
            targets_[k] = {garments_[k], 0, host::view_of(part(std::as_const(targets)))};
            states_[k] = host::sized<toile_garment_state>();
            states_[k].garment = garments_[k];
            states_[k].positions = host::view_mut(part(positions));
            states_[k].normals = host::view_mut(part(normals));
        }
        auto request = host::sized<toile_cloth_step>();
        request.flags = reset ? TOILE_STEP_RESET : TOILE_STEP_NONE;
        request.body_before = &was;
        request.body_after = &now;
        request.dt_s = dt_s;
        request.targets = targets_.data();
        request.states = states_.data();
        request.garment_count = static_cast<std::uint32_t>(garments_.size());
        const double begin = cpu_ms();
        instance_.call("step", [&](toile_instance* i) { return table_.step(i, &request); });
        return cpu_ms() - begin;
    }

  private:
    void set_up() {
        std::vector<Joints> joints, cloth_joints;
        std::vector<Weights> weights, cloth_weights;
        skin_of(scene_.arm, joints, weights);
        skin_of(scene_.cloth_arm, cloth_joints, cloth_weights);
        auto body = host::sized<toile_body>();
        body.revision = 1;
        body.model_id = "";
        body.rest.positions = host::view_of(scene_.body.positions);
        body.rest.triangles = host::view_of(scene_.body.triangles);
        body.joint_indices = host::view_of(joints);
        body.joint_weights = host::view_of(weights);
        host::Job job;
        instance_.call("set_body",
                       [&](toile_instance* i) { return table_.set_body(i, &body, job.handle()); });
        for (std::uint32_t layer = 0; layer < scene_.layers; ++layer)
            add(layer, cloth_joints, cloth_weights, job);
        targets_.resize(garments_.size());
        states_.resize(garments_.size());
    }

    void add(std::uint32_t layer, const std::vector<Joints>& joints,
             const std::vector<Weights>& weights, host::Job& job) {
        const std::size_t rows = scene_.cloth.positions.size() / scene_.layers;
        const std::size_t count = scene_.cloth.triangles.size() / scene_.layers;
        const auto part = [&](const auto& all) {
            return std::span(all).subspan(layer * rows, rows);
        };
        std::vector<Triangle> triangles(scene_.cloth.triangles.begin(),
                                        scene_.cloth.triangles.begin() + std::ptrdiff_t(count));
        auto dress = host::sized<toile_cloth_garment>();
        dress.layer = layer;
        dress.rest.positions = host::view_of(part(scene_.cloth.positions));
        dress.rest.triangles = host::view_of(triangles);
        dress.joint_indices = host::view_of(part(joints));
        dress.joint_weights = host::view_of(part(weights));
        const std::vector<float> attachment(rows, 0.0f);
        dress.attachment = host::view_of(attachment);
        dress.fabric = host::sized<toile_fabric>();
        dress.fabric.density_kg_m2 = 0.2f;
        dress.fabric.thickness_m = 0.0005f;
        dress.fabric.stretch_warp_n_m = dress.fabric.stretch_weft_n_m = 4000.0f;
        dress.fabric.shear_n_m = 1000.0f;
        dress.fabric.bend_warp_nm = dress.fabric.bend_weft_nm = 1e-5f;
        dress.fabric.friction = 0.3f;
        dress.fabric.damping = 2.0f;
        instance_.call("add_garment", [&](toile_instance* i) {
            return table_.add_garment(i, &dress, job.handle(), &garments_.emplace_back());
        });
    }

    const bench::ClothScene& scene_;
    host::Instance instance_;
    const toile_cloth& table_;
    std::vector<std::uint32_t> garments_;
    std::vector<toile_garment_target> targets_;
    std::vector<toile_garment_state> states_;

  public:
    std::vector<Vec3f> before, after, targets, positions, normals;
};

float highest(const std::vector<Vec3f>& points) {
    float y = -1e9f;
    for (const Vec3f& p : points)
        y = std::max(y, p.y());
    return y;
}

nlohmann::ordered_json run(const bench::ClothScene& scene, host::Registry& registry,
                           host::Services& services, const Options& options, bool arms) {
    constexpr int kLast = 30; // frames that tell rest
    Dress dress(scene, registry, services, options);
    bench::SceneMeasure measure(scene);
    std::vector<double> times;
    bench::SceneMeasure::Frame worst;
    int deep_frames = 0;
    double moved = 0.0;
    for (int frame = 0; frame <= options.frames; ++frame) {
        dress.before = dress.after;
        if (arms) {
            const double time = frame * bench::ClothScene::kFrame;
            bench::ClothScene::pose(scene.body.positions, scene.arm, time, dress.after);
            bench::ClothScene::pose(scene.cloth.positions, scene.cloth_arm, time, dress.targets);
        }
        const std::vector<Vec3f> last = dress.positions;
        const double ms = dress.step(frame == 0 ? 0.0 : bench::ClothScene::kFrame, frame == 0);
        if (frame > 0) times.push_back(ms);
        if (frame > options.frames - kLast)
            for (std::size_t v = 0; v < last.size(); ++v)
                moved += double((dress.positions[v] - last[v]).squaredNorm()) /
                         double(last.size() * kLast);
        if (!options.measure && frame < options.frames) continue;
        const auto found = measure.frame(dress.after, dress.positions);
        worst.deep = std::max(worst.deep, found.deep);
        worst.through = std::max(worst.through, found.through);
        worst.deepest = std::max(worst.deepest, found.deepest);
        worst.finite = worst.finite && found.finite;
        deep_frames += found.deep > 0 ? 1 : 0;
    }
    std::sort(times.begin(), times.end());
    const auto strain = measure.strain(dress.positions);
    const double speed = std::sqrt(moved) / bench::ClothScene::kFrame;
    if (!options.out.empty()) {
        std::filesystem::create_directories(options.out);
        bench::write_scene_mesh(options.out / "cloth.obj",
                                {dress.positions, scene.cloth.triangles});
        bench::write_scene_mesh(options.out / "body.obj", {dress.after, scene.body.triangles});
    }
    return {
        {"vertices", scene.cloth.positions.size()},
        {"cpu_ms_median", times[times.size() / 2]},
        {"cpu_ms_p95", times[times.size() * 95 / 100]},
        {"strain_max", strain.largest},
        {"strain_rms", strain.rms},
        {"strain_p99", strain.p99},
        {"deep_worst_frame", worst.deep},
        {"deep_frames", deep_frames},
        {"deepest_mm", 1e3f * worst.deepest},
        {"body_vertices_through", worst.through},
        {"self_intersections", measure.self_intersections(dress.positions)},
        {"stays_on_shoulders", highest(dress.positions) > highest(scene.cloth.positions) - 0.05f},
        {"finite", worst.finite},
        {"speed_rms_m_s", speed},
        {"at_rest", speed < 0.01}};
}

} // namespace

int main(int argc, char** argv) {
    try {
        const Options options = parse(argc, argv);
        const std::filesystem::path data = test::shared_data("cloth_scene");
        if (data.empty()) {
            std::cout << "skipped: the shared data set 'cloth_scene' is not here\n";
            return 0;
        }
        host::Services services(1);
        host::Registry registry(services, {.environment = false});
        for (const std::string& level : options.levels) {
            const bench::ClothScene scene(data, level);
            for (const std::string& motion : options.motions) {
                nlohmann::ordered_json line{
                    {"plugin", options.plugin}, {"level", level}, {"motion", motion}};
                line.update(run(scene, registry, services, options, motion == "arms"));
                std::cout << line.dump() << std::endl;
            }
        }
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "cloth_scene_bench: " << error.what() << '\n';
        return 1;
    }
}
