// Writes avatars/<id>/: avatar.json, the skinned .glb it names, and PROVENANCE.md.
#pragma once

#include "body/body_model.h"
#include "imaging/image.h"

namespace toile::body {

/// Writes `model` as <folder>/avatar.json and <folder>/<id>.glb (metres; 22 joint nodes with VRM
/// names, vertices cut along texture seams and ordered by part), and `provenance` beside them.
/// Equal input gives equal bytes. \throw Error when a file cannot be written
void save_body_model(const BodyModel& model, const imaging::Image& texture,
                     const std::string& provenance, const std::filesystem::path& folder);

} // namespace toile::body
