// What garment.json says: a garment's identity, fabric, sizes, pins and colourways.
#pragma once

#include "body/body_model.h"
#include "garment/ease_class.h"
#include "garment/fault.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace toile::garment {

/// Mechanics of the cloth in SI units (garment.json writes g/m2 and mm, see docs/garments.md).
/// Warp runs along v, weft along u of the material coordinates.
struct Fabric {
    std::string name = "cotton";
    double density_kg_m2 = 0.18;
    double thickness_m = 0.0005;
    double stretch_warp_n_m = 800.0; ///< force per width per unit strain
    double stretch_weft_n_m = 600.0;
    double shear_n_m = 120.0;
    double bending_warp_nm = 8e-6; ///< bending rigidity per width
    double bending_weft_nm = 6e-6;
    double friction = 0.4; ///< against skin, Coulomb
    double damping = 0.5;  ///< 1/s, share of relative velocity lost
};

/// Whom one measurement of a size chart is made for: metres, minimum <= maximum.
struct ChartRange {
    double minimum = 0.0;
    double maximum = 0.0;
};

/// Vertices held to the body. Indices are of the welded simulation mesh (docs/file_formats.md).
struct PinGroup {
    std::string name;
    float strength = 1.0f;               ///< 0 free .. 1 held
    std::vector<std::uint32_t> vertices; ///< with `strength`; or empty when there is a mask
    std::vector<float> mask;             ///< (nv) strength of every vertex, or empty
};

/// One colourway: a KHR_materials_variants name, a colour that multiplies the materials', or both.
struct Variant {
    std::string name;
    std::string material_variant;    ///< "" : the meshes' own materials
    std::optional<Vec3f> base_color; ///< linear RGB; the file has "#rrggbb" sRGB
};

struct SizeEntry {
    std::string name;                        ///< "M"
    std::string mesh;                        ///< file: `simulation` and render meshes
    std::string render;                      ///< file of further render meshes, or ""
    std::string made_on;                     ///< avatar id, or "": Manifest::made_on
    std::map<std::string, ChartRange> chart; ///< ISO 8559-1 name -> metres
};

struct Manifest {
    std::string id;      ///< [a-z0-9] and - or _ between, at most 64
    std::string version; ///< semver
    std::string name;    ///< for people
    std::string maker;
    std::string licence; ///< SPDX or words
    std::string kind;    ///< "t-shirt", "skirt", ...
    std::uint32_t layer = 1;
    std::string made_on;   ///< avatar id of sizes that name none, or "" when unknown
    std::string thumbnail; ///< file: a small picture of it, or ""
    double ease_m = 0.004;
    EaseIntent ease_class; ///< how much room the design is meant to give; empty: not said
    Fabric fabric;
    std::vector<SizeEntry> sizes;
    std::vector<PinGroup> pins;
    std::vector<Variant> variants;
    std::vector<body::Part> body_mask; ///< parts never drawn below this garment
};

inline constexpr std::int64_t kSchema = 1;

/// Reads garment.json's text; what is wrong goes to `faults` (all of it, not only the first), the
/// rest is filled as far as it is sound. `file` stands for it in texts.
[[nodiscard]] Manifest read_manifest(std::string_view text, const std::string& file,
                                     Faults& faults);

/// The same manifest as text, with unit conversion; ends with a newline, equal input, equal bytes.
[[nodiscard]] std::string write_manifest(const Manifest& manifest);

/// "left_upper_arm"; "invalid" for Part::invalid.
[[nodiscard]] std::string_view part_name(body::Part part);

} // namespace toile::garment
