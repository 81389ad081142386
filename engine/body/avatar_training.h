// Makes the avatars of avatars/ from the MakeHuman body data.
#pragma once

#include "body/avatar_template.h"
#include "body/body_model.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace toile::body {

/// One avatar to be made.
struct AvatarSpec {
    std::string id, name;
    double woman = 0.5;                          ///< share of the woman's shape, [0, 1]
    std::map<std::string, double> wanted;        ///< measurements to be met, metres
    float face_smoothness = 0.0f;                ///< flattens the face
    std::array<std::uint8_t, 3> skin{}, layer{}; ///< sRGB tones of the skin and the base layer
};

/// `woman`, `man` and `mannequin`.
[[nodiscard]] std::vector<AvatarSpec> stock_avatars();

struct TrainingOptions {
    std::filesystem::path data;   ///< see MakeHumanData
    std::filesystem::path check;  ///< the other layout of the data, to hold it against; or empty
    std::filesystem::path out;    ///< gets one folder per avatar
    std::vector<std::string> ids; ///< empty: all
    std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// Trains and writes the avatars; equal data gives equal bytes. Takes about two minutes.
/// \throw Error
std::vector<BodyModel> train_avatars(const TrainingOptions& options);

} // namespace toile::body
