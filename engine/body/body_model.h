// A body as loaded from avatars/<id>/: template surface, skeleton, weights, labels; immutable.
#pragma once

#include "body/skeleton.h"
#include "geometry/mesh.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::body {

/// Four joints per vertex; weights sum to 1, unused slots have weight 0 and joint 0.
struct SkinWeights {
    std::vector<std::array<std::uint16_t, 4>> joints; ///< (nv), Joint values
    std::vector<std::array<float, 4>> weights;        ///< (nv)
};

/// P4's 12 body parts; values as in abi/body.h (TOILE_PART_*).
enum class Part : std::uint8_t {
    invalid,
    head,
    torso,
    left_upper_arm,
    left_lower_arm,
    right_upper_arm,
    right_lower_arm,
    left_upper_leg,
    left_lower_leg,
    right_upper_leg,
    right_lower_leg,
    pelvis,
    neck,
};

/// Name in files: "left_upper_arm".
[[nodiscard]] std::string_view part_label(Part part);
[[nodiscard]] std::optional<Part> part_from_label(std::string_view name);

/// One shape component: displacement of every vertex and joint per unit coefficient, metres.
struct ShapeComponent {
    std::string name;
    std::vector<Vec3f> vertex_offsets; ///< (nv)
    std::array<Vec3f, kJointCount> joint_offsets;
};

struct BodyModel {
    std::string id;      ///< "woman"
    std::string version; ///< semver
    std::string name;    ///< for people
    std::filesystem::path folder;
    std::filesystem::path appearance; ///< the .glb with its texture
    geometry::TriangleMesh rest;      ///< A pose, feet on y = 0, faces +Z; with normals
    geometry::SeamedLayout layout;    ///< for drawing
    Skeleton skeleton;
    SkinWeights skin;
    std::vector<Part> parts;                        ///< (nv)
    std::map<std::string, std::uint32_t> landmarks; ///< name -> vertex
    std::map<std::string, double> measurements;     ///< ISO name -> metres
    std::vector<ShapeComponent> shape;              ///< empty for a fixed avatar
};

/// Loads avatars/<id>/avatar.json and the .glb it names; or, where there is none, the body.json
/// there (one person of a body space), whose id is then the folder's name.
/// \throw Error naming what is wrong
[[nodiscard]] BodyModel load_body_model(const std::filesystem::path& folder);

/// Folder of an avatar by id in the data folders. \throw Error listing the known ids
[[nodiscard]] std::filesystem::path find_avatar(const std::string& id);

/// Ids of all avatars in the data folders, sorted.
[[nodiscard]] std::vector<std::string> list_avatars();

} // namespace toile::body
