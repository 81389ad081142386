#include "garment/fabric_table.h"

#include "core/error.h"

#include <array>

namespace toile::garment {
namespace {

constexpr std::string_view kKawabata =
    "middle of the range that the Kawabata instruments read on such cloth (Kawabata 1980)";
constexpr std::string_view kKawabataSoft =
    "bending and shear as the Kawabata instruments read on such cloth (Kawabata 1980); stretch "
    "kept "
    "below the true one, which no frame-rate solver can tell from stiff";
constexpr std::string_view kStretch =
    "force at 20 to 40 % extension of elastane jersey as its makers state it; bending and shear as "
    "single jersey (Kawabata 1980)";

// weight kg/m2, thickness m, stretch warp and weft N/m, shear N/m, bending warp and weft N m.
NamedFabric make(const std::string_view key, const std::string& name, const double density,
                 const double thickness, const double warp, const double weft, const double shear,
                 const double bend_warp, const double bend_weft, const double friction,
                 const std::string_view source) {
    Fabric f;
    f.name = name;
    f.density_kg_m2 = density;
    f.thickness_m = thickness;
    f.stretch_warp_n_m = warp;
    f.stretch_weft_n_m = weft;
    f.shear_n_m = shear;
    f.bending_warp_nm = bend_warp;
    f.bending_weft_nm = bend_weft;
    f.friction = friction;
    f.damping = 1.0;
    return {key, f, source};
}

} // namespace

std::span<const NamedFabric> fabric_table() {
    static const std::array table = {
        make("jersey", "single jersey, cotton", 0.160, 0.0006, 320, 220, 45, 3.0e-6, 2.5e-6, 0.40,
             kKawabata),
        make("rib", "1x1 rib, cotton and elastane", 0.220, 0.0009, 260, 120, 40, 5.0e-6, 3.0e-6,
             0.45, kKawabata),
        make("stretch", "elastane jersey, polyamide", 0.230, 0.0006, 180, 150, 60, 3.0e-6, 2.5e-6,
             0.40, kStretch),
        make("poplin", "poplin, cotton", 0.115, 0.0003, 2200, 1600, 55, 7.0e-6, 5.0e-6, 0.35,
             kKawabataSoft),
        make("linen", "plain weave, linen", 0.170, 0.0004, 2400, 2000, 40, 1.4e-5, 1.1e-5, 0.35,
             kKawabataSoft),
        make("silk", "crepe de Chine, silk", 0.075, 0.0002, 1500, 1100, 18, 1.5e-6, 1.0e-6, 0.25,
             kKawabataSoft),
        make("denim", "3/1 twill, cotton", 0.380, 0.0008, 3200, 2400, 130, 6.0e-5, 4.0e-5, 0.45,
             kKawabataSoft),
        make("twill", "2/1 twill, cotton and wool", 0.210, 0.0005, 2600, 1800, 70, 1.2e-5, 9.0e-6,
             0.35, kKawabata),
        make("wool", "melton, wool", 0.340, 0.0016, 1800, 1400, 90, 3.5e-5, 3.0e-5, 0.45,
             kKawabataSoft),
        make("fleece", "brushed sweatshirt fleece, cotton", 0.280, 0.0015, 500, 350, 70, 1.5e-5,
             1.2e-5, 0.45, kKawabata),
    };
    return table;
}

const NamedFabric& find_fabric(const std::string_view key) {
    std::string known;
    for (const NamedFabric& fabric : fabric_table()) {
        if (fabric.key == key) {
            return fabric;
        }
        known += (known.empty() ? "" : ", ") + std::string(fabric.key);
    }
    throw Error("there is no fabric '" + std::string(key) + "'; there are " + known);
}

} // namespace toile::garment
