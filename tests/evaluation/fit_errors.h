// How far a fitted body lies from the test person that it was fitted to: surfaces, girths, lengths.
#pragma once

#include "body/test_person.h"
#include "simulated_sensor/simulator.h"

#include <functional>
#include <map>
#include <span>
#include <string>

namespace toile::evaluation {

/// A closed surface in the pose that the cameras saw. Borrows everything.
struct PosedSurface {
    std::span<const Vec3f> positions;    ///< (nv) world, metres
    std::span<const Triangle> triangles; ///< (nf)
    std::span<const body::Part> parts;   ///< (nv)
    const body::JointTransforms& joints; ///< world_from_joint
};

/// Which vertices count.
using Selection = std::function<bool(std::size_t)>;

/// (nv) thirds of the triangles' areas, m^2.
[[nodiscard]] std::vector<float> vertex_areas(std::span<const Vec3f> positions,
                                              std::span<const Triangle> triangles);

/// Area-weighted mean distance from the selected vertices to another surface, mm.
[[nodiscard]] double mean_distance(const PosedSurface& from, const Selection& keep,
                                   const PosedSurface& to);

/// The same once `from` was moved onto the other surface as a whole: what cameras that all stand a
/// little off do to a body is not its shape.
[[nodiscard]] double aligned_distance(const PosedSurface& from, const Selection& keep,
                                      const PosedSurface& to);

/// Head, hands and feet are told apart from the rest.
[[nodiscard]] bool in_core(const body::TestPerson& person, std::size_t vertex);

/// (nv) 1: some camera of the frame shown sees the vertex: it lies in the picture, not hidden, and
/// faces the camera by less than 80 degrees off. By the cameras' true places, without noise.
[[nodiscard]] std::vector<std::uint8_t> seen_vertices(const simulated_sensor::Simulator& simulator,
                                                      const PosedSurface& truth);

/// Name -> result minus truth, mm; both cut by the truth's planes. A girth that one of them does
/// not have is missing.
[[nodiscard]] std::map<std::string, double>
girth_errors(const body::TestPerson& person, const PosedSurface& truth, const PosedSurface& result);

/// Name -> result minus truth, mm: stature, crotch_height, hip_height, cervicale_height above each
/// one's own soles; shoulder_breadth from acromion to acromion; arm_length from the acromion over
/// elbow to wrist, mean of both sides. Acromion and cervicale are the truth's own landmarks: on the
/// result the point of its surface that is nearest to where the landmark would lie if it stood as
/// far from the result's joint as from the truth's. The crotch is where level cuts of the legs
/// become one, even of thighs that touch.
[[nodiscard]] std::map<std::string, double> length_errors(const body::TestPerson& person,
                                                          const PosedSurface& truth,
                                                          const PosedSurface& result);

} // namespace toile::evaluation
