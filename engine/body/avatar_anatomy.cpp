#include "body/avatar_anatomy.h"

#include "body/landmarks.h"

#include <array>
#include <cmath>
#include <limits>

namespace toile::body {
namespace {

/// Vertices of MakeHuman's base mesh hm08; of pairs the left one.
struct BaseLandmark {
    Landmark landmark;
    std::uint32_t vertex;
};
constexpr auto kBaseLandmarks = std::to_array<BaseLandmark>({
    {Landmark::brow, 237},
    {Landmark::head_back, 962},
    {Landmark::larynx, 797},
    {Landmark::neck_back, 858},
    {Landmark::neck_front, 1522},
    {Landmark::navel, 4121},
    {Landmark::left_neck_side, 7539},
    {Landmark::left_shoulder, 8275},
    {Landmark::left_armpit, 8336},
    {Landmark::left_scye_front, 8050},
    {Landmark::left_scye_back, 8283},
    {Landmark::left_bust_point, 8454},
    {Landmark::left_under_bust, 8523},
    {Landmark::left_lowest_rib, 10668},
    {Landmark::left_iliac_crest, 10773},
    {Landmark::left_iliac_spine, 10947},
    {Landmark::left_trochanter, 10920},
    {Landmark::left_gluteal_fold, 10893},
    {Landmark::left_knee, 11242},
    {Landmark::left_lower_knee, 11268},
    {Landmark::left_ankle, 13036},
    {Landmark::left_inner_ankle, 12935},
    {Landmark::left_elbow, 10059},
    {Landmark::left_radiale, 10057},
    {Landmark::left_wrist, 10216},
    {Landmark::left_inner_wrist, 10587},
    {Landmark::left_fingertip, 8787},
});
constexpr float kMiddle = 1e-3f; // a base vertex this near to x = 0 belongs to the midline, metres

} // namespace

std::map<std::string, std::uint32_t> find_landmarks(const AvatarTemplate& avatar) {
    std::map<std::string, std::uint32_t> out;
    for (const auto& [landmark, vertex] : kBaseLandmarks) {
        const Vec3f& wanted = avatar.base[vertex];
        const bool midline = std::abs(wanted.x()) < kMiddle;
        std::uint32_t best = 0;
        float least = std::numeric_limits<float>::max();
        for (std::uint32_t v = 0; v < avatar.half; ++v) {
            if (midline && avatar.mirror_of[v] != v) continue;
            const float d = (avatar.mesh.positions[v] - wanted).squaredNorm();
            if (d >= least) continue;
            least = d;
            best = v;
        }
        out[std::string(landmark_name(landmark))] = best;
        out[std::string(landmark_name(opposite(landmark)))] = avatar.mirror_of[best];
    }
    // The template closes the cleft, so that its crotch lies below the base mesh's: the midline,
    // which runs round trunk and head, is lowest there.
    std::uint32_t crotch = 0;
    float lowest = std::numeric_limits<float>::max();
    for (std::uint32_t v = 0; v < avatar.half; ++v) {
        if (avatar.mirror_of[v] != v || avatar.mesh.positions[v].y() >= lowest) continue;
        lowest = avatar.mesh.positions[v].y();
        crotch = v;
    }
    out[std::string(landmark_name(Landmark::crotch))] = crotch;
    return out;
}

} // namespace toile::body
