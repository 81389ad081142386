#include "scape_fit/floor_contact.h"

namespace toile::scape_fit {

void stand_on(const FitLevel& level, const PosedLevel& posed, const geometry::Plane& floor,
              Association& out) {
    out.pairs.clear();
    for (const body::Joint joint : {body::Joint::left_foot, body::Joint::right_foot}) {
        VertexPair lowest;
        lowest.distance = kFootReach;
        for (std::uint32_t v = 0; v < level.vertices.size(); ++v) {
            if (level.below[v][static_cast<std::size_t>(joint)] <= 0.5f) continue;
            const float height = floor.normal.dot(posed.positions[v]) - floor.offset;
            if (height >= lowest.distance) continue;
            lowest.vertex = v;
            lowest.kind = PairKind::floor;
            lowest.normal = floor.normal;
            lowest.place = posed.positions[v] - height * floor.normal;
            lowest.distance = height;
            lowest.weight = kFootWeight;
        }
        if (lowest.weight > 0.0f) out.pairs.push_back(lowest);
    }
}

} // namespace toile::scape_fit
