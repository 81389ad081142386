// Typed refusals of garment packages: one line each that names package, file, place, what to do.
#pragma once

#include "core/error.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace toile::garment {

/// What kind of thing is wrong. Zero is invalid.
enum class FaultCode : std::uint8_t {
    invalid,
    not_found,   ///< no such package, or no garment.json in it
    archive,     ///< a zip that is none, is damaged, or claims too much
    json,        ///< garment.json is not JSON, has a key twice, an unknown one, a wrong type
    schema,      ///< made for a newer Toile
    value,       ///< a value out of its sane range, or an id with forbidden letters
    unsafe_path, ///< absolute, with .., or a symbolic link that leaves the package
    missing_file,
    duplicate,       ///< two sizes, pins or variants with one name
    mesh_file,       ///< a mesh or texture file that cannot be read; says why
    no_simulation,   ///< no mesh that can be simulated
    mesh,            ///< empty, not finite, index out of range, degenerate
    topology,        ///< the welded simulation mesh is not manifold
    material_coords, ///< missing, zero area or of another scale than the mesh
    size_topology,   ///< sizes of one design with different meshes
    unit,            ///< centimetres, millimetres ... instead of metres
    skin,            ///< joints without a known name, or weights unfit
    render_far,      ///< a render mesh far off the simulation mesh
    pins,            ///< indices out of range, mask of another length
    variant,         ///< a material variant that the meshes do not have
    made_on,         ///< no such avatar
};

/// "unsafe_path"
[[nodiscard]] std::string_view fault_name(FaultCode code);

struct Fault {
    FaultCode code = FaultCode::invalid;
    std::string text; ///< one line
};

/// All that was found wrong, in the order it was found.
using Faults = std::vector<Fault>;

/// The first of a package's faults, as thrown by the loader.
class PackageError : public Error {
  public:
    explicit PackageError(const Fault& fault) : Error(fault.text), code_(fault.code) {}
    [[nodiscard]] FaultCode code() const { return code_; }

  private:
    FaultCode code_;
};

} // namespace toile::garment
