#include "body/rotations.h"

namespace toile::body {

// Here and not in the header: it brings a whole singular value decomposition with it, for vectors
// that point against each other.
Quatf swing(const Vec3f& from, const Vec3f& to) noexcept {
    return Quatf::FromTwoVectors(from, to);
}

} // namespace toile::body
