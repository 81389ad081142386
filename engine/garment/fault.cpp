#include "garment/fault.h"

#include <array>

namespace toile::garment {

std::string_view fault_name(FaultCode code) {
    static constexpr std::array<std::string_view, 22> kNames = {"invalid",       "not_found",
                                                                "archive",       "json",
                                                                "schema",        "value",
                                                                "unsafe_path",   "missing_file",
                                                                "duplicate",     "mesh_file",
                                                                "no_simulation", "mesh",
                                                                "topology",      "material_coords",
                                                                "size_topology", "unit",
                                                                "skin",          "render_far",
                                                                "pins",          "variant",
                                                                "made_on",       ""};
    return kNames.at(static_cast<std::size_t>(code));
}

} // namespace toile::garment
