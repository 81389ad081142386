// A customer in what a mannequin wears, from two scans (P3).
#pragma once

#include "assets/colored_mesh.h"
#include "body/body_model.h"
#include "garment/cloth_cover.h"
#include "garment/package.h"
#include "pipeline/body_fit.h"

namespace toile::pipeline {

struct MannequinDressingRequest {
    bool whole_body = false;  ///< false: the abdomen alone, by strips; true: the fitted bodies
    std::uint32_t strips = 0; ///< 0: the plugin's default
};

/// Everything that was found, for who writes files of it. Metres.
struct MannequinDressing {
    assets::ColoredMesh look;      ///< the result: garment, skin, the customer's head
    assets::ColoredMesh mannequin; ///< its scan, cleaned up, with normals
    assets::ColoredMesh customer;
    FittedBody mannequin_fit; ///< the body beneath the garment
    FittedBody customer_fit;
    geometry::TriangleMesh changed_body; ///< the mannequin's body after it was resized
    std::vector<Vec3f> moved;            ///< (nv of `mannequin`) its points after the change
    garment::ClothCover cover;           ///< (nv of `mannequin`)
    nlohmann::ordered_json report;
};

/// Which plugins do it is the registry's choice by kind: a body source fed with scans cleans up,
/// one that fits finds the bodies, a resizer changes sizes. \throw Error naming the scan and what
/// is wrong with it; host::Cancelled
[[nodiscard]] MannequinDressing
dress_from_mannequin(host::Registry& registry, host::Services& services, const toile_limits& limits,
                     const assets::ColoredMesh& mannequin, const assets::ColoredMesh& customer,
                     const MannequinDressingRequest& request, host::Job& job);

/// The garment by itself, fit to be written: carried to the avatar whose girths are nearest to the
/// mannequin's, of those with the fitted body's topology. Sets `report`'s "package".
/// \throw Error when there is hardly any cloth, or no such avatar
[[nodiscard]] garment::GarmentPackage
take_off_garment(host::Registry& registry, host::Services& services, const toile_limits& limits,
                 MannequinDressing& dressed, const std::string& id, host::Job& job);

} // namespace toile::pipeline
