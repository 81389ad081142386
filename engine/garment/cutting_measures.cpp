#include "garment/cutting_measures.h"

#include "body/measurer.h"
#include "core/error.h"

#include <cmath>
#include <numbers>

namespace toile::garment::block {
namespace {

// Share of a level's girth that lies behind the side points.
double back_share(const BodyProbe& body, const double height) {
    const Ring ring = body.ring(height);
    constexpr int kSamples = 64;
    std::array<double, 2> arcs{};
    Vec3d before = ring.at(0.0, 0.0);
    for (int k = 1; k <= kSamples; ++k) {
        const Vec3d p = ring.at(static_cast<double>(k) / kSamples, 0.0);
        arcs[k <= kSamples / 2 ? 0 : 1] += (p - before).norm();
        before = p;
    }
    return arcs[1] / (arcs[0] + arcs[1]);
}

class Cutter {
  public:
    explicit Cutter(const BodyProbe& body)
        : body_(body),
          values_(body::as_map(body::Measurer(body.body())
                                   .measure(body.body().rest.positions, body.body().skeleton))) {}

    [[nodiscard]] double of(const std::string& name) const {
        const auto at = values_.find(name);
        if (at == values_.end() || !(at->second > 0.0)) {
            throw Error("body '" + body_.body().id + "': " + name + " cannot be measured");
        }
        return at->second;
    }

    [[nodiscard]] double slope_degrees() const {
        const Vec3d neck = body_.ridge(body_.neck_half_width() + 0.01);
        return std::atan2(neck.y() - tip().y(), tip().x() - neck.x()) * 180.0 / std::numbers::pi;
    }

    // The tip of the shoulder as blocks have it: a seam there sits just beyond the joint.
    [[nodiscard]] Vec3d tip() const {
        return body_.ridge(body_.joint(body::Joint::left_upper_arm).x() + 0.012);
    }

    [[nodiscard]] double shoulder_to_elbow() const {
        return (body_.joint(body::Joint::left_lower_arm) - tip()).norm();
    }

    [[nodiscard]] double elbow_to_wrist() const {
        return (body_.joint(body::Joint::left_hand) - body_.joint(body::Joint::left_lower_arm))
            .norm();
    }

  private:
    const BodyProbe& body_;
    std::map<std::string, double> values_;
};

} // namespace

std::map<std::string, double> cutting_measures(const BodyProbe& body) {
    const Cutter cut(body);
    const double waist = cut.of("waist_height");
    const double hip = cut.of("hip_height");
    const double high_hip = 0.5 * (waist + hip);
    const double crotch = cut.of("crotch_height");
    const double neck_x = body.neck_half_width() + 0.01;
    const double crotch_length = cut.of("total_crotch_length");
    const double back_seat = back_share(body, hip);
    std::map<std::string, double> m;
    m["ankle"] = cut.of("ankle_girth");
    m["biceps"] = cut.of("upper_arm_girth");
    m["chest"] = cut.of("bust_girth");
    m["crossSeam"] = crotch_length;
    m["crossSeamFront"] = crotch_length * (1.0 - back_seat);
    m["head"] = cut.of("head_girth");
    m["heel"] = 1.3 * cut.of("ankle_girth");
    m["highBust"] = cut.of("upper_chest_girth");
    m["hips"] = body.ring(high_hip).girth();
    m["hpsToBust"] = cut.of("neck_side_to_bust_point");
    m["hpsToWaistBack"] = body.drop_length(neck_x, waist, false);
    m["hpsToWaistFront"] = body.drop_length(neck_x, waist, true);
    m["inseam"] = cut.of("inside_leg_length");
    m["knee"] = cut.of("knee_girth");
    m["neck"] = cut.of("neck_girth");
    m["seat"] = cut.of("hip_girth");
    m["seatBack"] = cut.of("hip_girth") * back_seat;
    m["shoulderToElbow"] = cut.shoulder_to_elbow();
    m["shoulderToShoulder"] = 2.02 * cut.tip().x(); // over the back
    m["shoulderToWrist"] = cut.shoulder_to_elbow() + cut.elbow_to_wrist();
    m["underbust"] = cut.of("under_bust_girth");
    m["upperLeg"] = cut.of("thigh_girth");
    m["waist"] = cut.of("waist_girth");
    m["waistBack"] = cut.of("waist_girth") * back_share(body, waist);
    m["waistToArmpit"] = body.armpit_height() - waist;
    m["waistToFloor"] = waist;
    m["waistToHips"] = waist - high_hip;
    m["waistToKnee"] = waist - cut.of("knee_height");
    m["waistToSeat"] = waist - hip;
    m["waistToUpperLeg"] = waist - crotch;
    m["wrist"] = cut.of("wrist_girth");
    for (auto& [name, value] : m) {
        value = std::round(value * 1e4) / 10.0; // tenths of a millimetre
    }
    m["shoulderSlope"] = std::round(cut.slope_degrees() * 100.0) / 100.0;
    return m;
}

} // namespace toile::garment::block
