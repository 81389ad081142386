// body.json: one person as a body space tells it, with what is known of the person.
#pragma once

#include "body/body_space.h"

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace toile::body {

/// The file format stands in docs/file_formats.md and docs/schemas/body.schema.json.
struct BodyFile {
    struct Length {
        double value_m = 0.0;
        double confidence = 0.0; ///< [0, 1]
    };

    std::string model; ///< id of an avatar, with or without shape components
    std::string model_version;
    std::string made_by;              ///< "measurements", "fit"
    std::optional<Sex> sex;           ///< whose population it is from
    std::vector<double> coefficients; ///< at most as many as the model has components
    /// (nv) what the components cannot show: metres along the mean body's normals; or empty.
    std::vector<float> detail;
    std::optional<Pose> pose;                   ///< as it was seen; world
    std::map<std::string, Length> measurements; ///< ISO name -> metres
    nlohmann::ordered_json fit;                 ///< how a fit went, or null
};

/// \throw Error naming file and place: an unknown key, a wrong type, numbers out of range
[[nodiscard]] BodyFile load_body_file(const std::filesystem::path& file);
void save_body_file(const BodyFile& body, const std::filesystem::path& file);

/// Is this the name of a body.json rather than of an avatar or a mesh? By its extension.
[[nodiscard]] bool is_body_file(const std::filesystem::path& file);

/// Its surface and joints at rest. \throw Error when it does not fit the space
[[nodiscard]] BodyShape shape_of(const BodyFile& body, const BodySpace& space);

/// The same as a body of its own, measured. An avatar without components takes no coefficients.
/// \throw Error when its model is not at hand, or of another major version
[[nodiscard]] BodyModel model_of(const BodyFile& body);
/// Reads a file and makes the body of it. \throw Error naming the file
[[nodiscard]] BodyModel load_body(const std::filesystem::path& file);

/// `detail` of a surface at rest that differs from the coefficients' shape; both stand on the
/// floor. (nv)
[[nodiscard]] std::vector<float> detail_of(const BodySpace& space,
                                           std::span<const double> coefficients,
                                           std::span<const Vec3f> rest, const Skeleton& skeleton);

} // namespace toile::body
