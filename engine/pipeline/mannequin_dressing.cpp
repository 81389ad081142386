#include "pipeline/mannequin_dressing.h"

#include "core/error.h"
#include "geometry/nearest_surface.h"
#include "imaging/srgb.h"
#include "pipeline/head_transfer.h"
#include "pipeline/resizing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <thread>

namespace toile::pipeline {
namespace {

constexpr float kNeckShare =
    0.15f; // of the way from the joint of the neck to that of the head: below the chin
constexpr double kUpright = 0.85; // cosine between the body's up and +Y

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What two scans go through on their own, one thread each.
struct Found {
    BodyFit::Surface surface;
    FittedBody body;
    double clean_s = 0.0, fit_s = 0.0;
};

void check_upright(const FittedBody& body) {
    const auto& up = body.report.at("up");
    if (up.at(1).get<double>() < kUpright)
        throw Error("the person does not stand upright: turn the scan so that +Y is up and the "
                    "person faces +Z");
}

/// Reads surface and body out of one scan. `whose` stands in front of errors.
class ScanReader {
  public:
    ScanReader(host::Registry& registry, host::Services& services, const toile_limits& limits,
               const char* whose)
        : cleaner_(registry, services, limits, TOILE_SOURCE_SCAN),
          fitter_(registry, services, limits), whose_(whose) {}

    void read(const assets::ColoredMesh& scan, bool dressed, host::Job& job) {
        try {
            const auto start = Clock::now();
            cleaner_.feed_scan(scan.mesh, job, scan.colors);
            found_.surface = cleaner_.fit_surface(job);
            found_.clean_s = seconds_since(start);
            const auto middle = Clock::now();
            fitter_.feed_scan(found_.surface.mesh, job, found_.surface.colors);
            FitRequest request;
            request.dressed = dressed;
            found_.body = fitter_.fit(request, job);
            found_.fit_s = seconds_since(middle);
            check_upright(found_.body);
        } catch (const host::Cancelled&) {
            failure_ = std::current_exception();
        } catch (const std::exception& e) {
            failure_ = std::make_exception_ptr(Error(std::string(whose_) + ": " + e.what()));
        }
    }
    [[nodiscard]] Found take() {
        if (failure_) std::rethrow_exception(failure_);
        return std::move(found_);
    }

  private:
    BodyFit cleaner_, fitter_;
    const char* whose_;
    Found found_;
    std::exception_ptr failure_;
};

/// The mannequin's body with the customer's proportions, on the mannequin's topology.
geometry::TriangleMesh changed_body(const MannequinDressing& of,
                                    const MannequinDressingRequest& request, Resizing& resizing,
                                    host::Job& job) {
    const geometry::TriangleMesh& before = of.mannequin_fit.surfaces.front();
    geometry::TriangleMesh out = before;
    if (request.whole_body) {
        const auto& after = of.customer_fit.surfaces.front();
        if (after.triangles != before.triangles)
            throw Error("the two bodies were fitted with different models");
        out.positions = after.positions;
    } else {
        out.positions = resizing.to_target(before, of.customer.mesh, request.strips, job);
    }
    geometry::vertex_normals(out.positions, out.triangles, out.normals);
    return out;
}

/// World places of the joints of a fitted body.
body::JointTransforms joints_of(const FittedBody& body) {
    return body::forward_kinematics(body.skeleton, body.pose);
}

Vec3f neck_of(const FittedBody& body) {
    const auto joints = joints_of(body);
    const Vec3f& neck = joints[TOILE_JOINT_NECK].translation;
    return neck + kNeckShare * (joints[TOILE_JOINT_HEAD].translation - neck);
}

assets::Rgba8 srgb_of(const std::array<float, 3>& light) {
    assets::Rgba8 out = {200, 200, 200, 255};
    if (light == std::array<float, 3>{}) return out; // unknown
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = static_cast<std::uint8_t>(
            std::lround(255.0f * imaging::srgb_from_linear(std::clamp(light[k], 0.0f, 1.0f))));
    return out;
}

/// The mannequin's skin in the colour of the customer's, lighter and darker as it was.
void match_skin(const garment::ClothCover& cover, const std::array<float, 3>& wanted,
                std::vector<assets::Rgba8>& colors) {
    const auto light = [](const std::array<float, 3>& c) {
        return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
    };
    const float usual = std::max(light(cover.skin), 1e-3f);
    for (std::size_t v = 0; v < colors.size(); ++v) {
        const float bare = std::clamp(1.0f - cover.cloth[v], 0.0f, 1.0f);
        if (bare < 0.5f) continue;
        std::array<float, 3> has{};
        for (std::size_t k = 0; k < 3; ++k)
            has[k] = imaging::linear_from_srgb(static_cast<float>(colors[v][k]) / 255.0f);
        const float shade = std::clamp(light(has) / usual, 0.6f, 1.3f);
        for (std::size_t k = 0; k < 3; ++k)
            colors[v][k] = static_cast<std::uint8_t>(std::lround(
                255.0f * imaging::srgb_from_linear(std::clamp(shade * wanted[k], 0.0f, 1.0f))));
    }
}

/// 1 where a fitted body is face for certain: the front of its head.
std::vector<std::uint8_t> face_of(const FittedBody& body) {
    const geometry::TriangleMesh& surface = body.surfaces.front();
    std::vector<std::uint8_t> out(surface.positions.size(), 0);
    const auto joints = joints_of(body);
    const Vec3f forward = joints[TOILE_JOINT_HEAD].rotation * Vec3f::UnitZ();
    const Vec3f& head = joints[TOILE_JOINT_HEAD].translation;
    for (std::size_t v = 0; v < out.size(); ++v) {
        const bool labelled = body.part_labels.empty() || body.part_labels[v] == TOILE_PART_HEAD;
        const Vec3f from = surface.positions[v] - head;
        out[v] = labelled && surface.normals[v].dot(forward) > 0.4f && from.y() > 0.0f &&
                         from.y() < 0.11f
                     ? 1
                     : 0;
    }
    return out;
}

nlohmann::ordered_json room_report(const garment::ClothCover& cover, std::span<const Vec3f> after,
                                   const geometry::TriangleMesh& body) {
    const geometry::NearestSurface skin(body.positions, body.triangles);
    std::vector<double> changes;
    for (std::size_t v = 0; v < after.size(); ++v) {
        if (cover.cloth[v] < 0.5f) continue;
        changes.push_back(
            std::abs(static_cast<double>(skin.nearest(after[v]).signed_distance - cover.gaps[v])));
    }
    if (changes.empty()) return {{"cloth_share", 0.0}};
    std::sort(changes.begin(), changes.end());
    const auto at = [&](double share) {
        return changes[static_cast<std::size_t>(share * static_cast<double>(changes.size() - 1))];
    };
    return {
        {"cloth_share", static_cast<double>(changes.size()) / static_cast<double>(after.size())},
        {"by_color", cover.by_color},
        {"room_change_m", {{"median", at(0.5)}, {"p95", at(0.95)}, {"max", at(1.0)}}}};
}

nlohmann::ordered_json body_report(const Found& found) {
    nlohmann::ordered_json out;
    for (const char* name : {"stature", "bust_girth", "waist_girth", "hip_girth"})
        if (const auto at = found.body.measurements.find(name); at != found.body.measurements.end())
            out["measurements"][name] = at->second.value_m;
    out["scan"] = found.surface.report;
    out["fit"] = found.body.report;
    out["seconds"] = {{"clean_up", found.clean_s}, {"fit", found.fit_s}};
    return out;
}

} // namespace

MannequinDressing dress_from_mannequin(host::Registry& registry, host::Services& services,
                                       const toile_limits& limits,
                                       const assets::ColoredMesh& mannequin,
                                       const assets::ColoredMesh& customer,
                                       const MannequinDressingRequest& request, host::Job& job) {
    const auto start = Clock::now();
    MannequinDressing out;
    ScanReader one(registry, services, limits, "the mannequin's scan");
    ScanReader two(registry, services, limits, "the customer's scan");
    Resizing resizing(registry, services, limits);
    {
        const std::jthread beside([&] { two.read(customer, false, job); });
        one.read(mannequin, true, job);
    }
    Found dressed = one.take(), bare = two.take();
    out.report["fit"] = request.whole_body ? "body" : "abdomen";
    out.report["mannequin"] = body_report(dressed);
    out.report["customer"] = body_report(bare);
    out.mannequin = {std::move(dressed.surface.mesh), std::move(dressed.surface.colors)};
    out.customer = {std::move(bare.surface.mesh), std::move(bare.surface.colors)};
    out.mannequin_fit = std::move(dressed.body);
    out.customer_fit = std::move(bare.body);

    const auto resize_start = Clock::now();
    out.changed_body = changed_body(out, request, resizing, job);
    assets::ColoredMesh dressed_customer = out.mannequin;
    dressed_customer.mesh.positions = out.moved = resizing.with_body(
        out.mannequin.mesh, out.mannequin_fit.surfaces.front(), out.changed_body, job);
    const double resize_s = seconds_since(resize_start);

    const auto head_start = Clock::now();
    const auto cover_of = [](const assets::ColoredMesh& scan, const FittedBody& body) {
        const auto face = face_of(body);
        return garment::find_cover({&scan.mesh, scan.colors, &body.surfaces.front(), face});
    };
    out.cover = cover_of(out.mannequin, out.mannequin_fit);
    const auto skin = cover_of(out.customer, out.customer_fit);
    if (out.cover.by_color && skin.by_color)
        match_skin(out.cover, skin.skin, dressed_customer.colors);
    if (out.customer.colors.empty()) // a head without colour takes the mannequin's
        out.customer.colors.assign(out.customer.mesh.positions.size(), srgb_of(out.cover.skin));
    const Vec3f neck = request.whole_body ? neck_of(out.customer_fit) : neck_of(out.mannequin_fit);
    out.look = transfer_head({&dressed_customer, neck}, {&out.customer, neck_of(out.customer_fit)});
    out.report["garment"] =
        room_report(out.cover, dressed_customer.mesh.positions, out.changed_body);
    out.report["seconds"] = {{"resize", resize_s},
                             {"head_and_skin", seconds_since(head_start)},
                             {"all", seconds_since(start)}};
    return out;
}

} // namespace toile::pipeline
