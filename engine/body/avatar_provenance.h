// Where an avatar comes from: its data held against a second copy, and PROVENANCE.md.
#pragma once

#include "body/makehuman_data.h"

#include <optional>
#include <string>
#include <vector>

namespace toile::body {

/// What holding one layout of the data against the other gave. They are of two versions (see
/// docs/avatars.md), so differences are told, not refused.
struct DataCheck {
    struct Target {
        std::string name;
        double largest_m = 0.0;
    };
    double positions_m = 0.0;         ///< largest difference of a coordinate of the base mesh
    std::size_t targets = 0;          ///< how many were compared
    std::vector<Target> other_values; ///< those that differ by more than the package's rounding
    /// Of the skin weights, with the rig's bones merged to our 22 joints: the largest difference at
    /// a vertex, in the mean of the body's vertices, and the share of them with more than 0.05.
    double joint_weights_mean = 0.0;
    double joint_weights_large = 0.0;
};

/// \throw Error when the faces, the rig or the base mesh differ (it is not the same data), or when
/// both are the same layout
[[nodiscard]] DataCheck check_data(const MakeHumanData& data, const MakeHumanData& other,
                                   const std::vector<std::string>& targets);

/// The part of PROVENANCE.md that all bodies have: the licences of both layouts of the data in
/// their own words, and the check. `check` empty: none was made.
[[nodiscard]] std::string licence_text(const std::optional<DataCheck>& check);

/// The text of an avatar's PROVENANCE.md: the command that makes the avatar again, the licences of
/// both layouts of the data in their own words, and the check.
[[nodiscard]] std::string provenance_text(const std::string& id, const std::string& name,
                                          const MakeHumanData& data,
                                          const std::optional<DataCheck>& check);

} // namespace toile::body
