#include "core/error.h"
#include "garment/scanned_garment.h"
#include "geometry/nearest_surface.h"
#include "pipeline/mannequin_dressing.h"
#include "pipeline/resizing.h"

#include <limits>

namespace toile::pipeline {
namespace {

constexpr float kLeastGap = 0.003f; // metres: nearer cloth is laid on the skin

/// The avatar of the fitted body's topology whose girths and height are nearest.
body::BodyModel nearest_avatar(const FittedBody& body) {
    std::optional<body::BodyModel> best;
    double least = std::numeric_limits<double>::max();
    for (const std::string& id : body::list_avatars()) {
        body::BodyModel model = body::load_body_model(body::find_avatar(id));
        if (model.rest.triangles != body.surfaces.front().triangles || model.measurements.empty())
            continue;
        double off = 0.0;
        for (const char* name : {"bust_girth", "waist_girth", "hip_girth", "stature"}) {
            const auto has = model.measurements.find(name);
            const auto wanted = body.measurements.find(name);
            if (has == model.measurements.end() || wanted == body.measurements.end()) continue;
            off += std::pow(has->second - wanted->second.value_m, 2.0);
        }
        if (off >= least) continue;
        least = off;
        best = std::move(model);
    }
    if (!best) throw Error("no avatar has the topology of the fitted bodies");
    return std::move(*best);
}

} // namespace

garment::GarmentPackage take_off_garment(host::Registry& registry, host::Services& services,
                                         const toile_limits& limits, MannequinDressing& dressed,
                                         const std::string& id, host::Job& job) {
    const garment::ScannedGarment garment =
        garment::separate_garment(dressed.mannequin.mesh, dressed.mannequin.colors, dressed.cover);
    const body::BodyModel avatar = nearest_avatar(dressed.mannequin_fit);
    Resizing resizing(registry, services, limits);
    std::vector<Vec3f> positions =
        resizing.with_body(garment.mesh, dressed.mannequin_fit.surfaces.front(), avatar.rest, job);
    const geometry::NearestSurface skin(avatar.rest.positions, avatar.rest.triangles);
    std::vector<float> gaps;
    gaps.reserve(positions.size());
    for (Vec3f& p : positions) {
        const auto near = skin.nearest(p);
        if (near.signed_distance < kLeastGap) p = near.point + kLeastGap * near.normal;
        gaps.push_back(std::max(near.signed_distance, kLeastGap));
    }
    garment::ScannedPackageOptions options;
    options.id = id;
    options.made_on = avatar.id;
    for (const auto& [name, length] : dressed.mannequin_fit.measurements)
        options.wearer[name] = length.value_m;
    const auto stature = avatar.measurements.find("stature");
    dressed.report["package"] = {{"made_on", avatar.id}, {"vertices", positions.size()}};
    return garment::package_scanned(garment, std::move(positions), gaps,
                                    stature == avatar.measurements.end() ? 1.7 : stature->second,
                                    options);
}

} // namespace toile::pipeline
