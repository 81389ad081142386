// The garments that come with Toile: complete, whole, at rest on the body of each size.
#include "body/body_model.h"
#include "garment/block_drape.h"
#include "garment/contact_metrics.h"
#include "garment/package.h"
#include "imaging/image.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <set>

namespace toile::garment {
namespace {

namespace fs = std::filesystem;

struct Shipped {
    const char* id;
    std::size_t openings; ///< closed border loops: hem, neck, cuffs, ...
};

void PrintTo(const Shipped& shipped, std::ostream* out) {
    *out << shipped.id;
}

fs::path folder_of(const std::string& id) {
    return fs::path(TOILE_SOURCE_DIR) / "garments" / id;
}

// Border loops: every border edge's end starts exactly one other.
std::size_t count_loops(const std::span<const Triangle> triangles) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triangle& t : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            edges.emplace(t[k], t[(k + 1) % 3]);
        }
    }
    std::map<std::uint32_t, std::uint32_t> next;
    for (const auto& [a, b] : edges) {
        if (edges.count({b, a}) == 0) {
            EXPECT_EQ(next.count(a), 0u) << "the border touches itself at vertex " << a;
            next[a] = b;
        }
    }
    std::size_t loops = 0;
    while (!next.empty()) {
        ++loops;
        std::uint32_t v = next.begin()->first;
        while (next.count(v) != 0) {
            const std::uint32_t to = next[v];
            next.erase(v);
            v = to;
        }
    }
    return loops;
}

double rms_strain(const GarmentSize& size) {
    const auto edges = block::rest_edges(size.simulation.triangles, size.material_coords);
    double sum = 0.0;
    for (const auto& edge : edges) {
        const double now = static_cast<double>(
            (size.simulation.positions[edge.a] - size.simulation.positions[edge.b]).norm());
        sum += (now / edge.length - 1.0) * (now / edge.length - 1.0);
    }
    return std::sqrt(sum / static_cast<double>(edges.size()));
}

double deep_fraction(const GarmentSize& size, const body::BodyModel& body) {
    const ClothSurface cloth{size.simulation.positions, size.simulation.triangles};
    ContactMetrics metrics(body.rest.positions, body.rest.triangles, {&cloth, 1});
    return metrics.measure(body.rest.positions, {&cloth, 1}).deep_fraction();
}

class ShippedGarment : public testing::TestWithParam<Shipped> {};

TEST_P(ShippedGarment, HasSixSizesTwoColourwaysAndHangsOnEachBody) {
    const auto package = load_package(folder_of(GetParam().id));
    const std::vector<std::string> names = {"XS", "S", "M", "L", "XL", "XXL"};
    ASSERT_EQ(package->sizes.size(), names.size());
    EXPECT_GE(package->manifest.variants.size(), 2u);
    EXPECT_FALSE(package->manifest.sizes[0].chart.empty());
    const auto small = imaging::load_image(package->source / package->manifest.thumbnail);
    EXPECT_GE(small.width, 200);
    for (std::size_t i = 0; i < names.size(); ++i) {
        const GarmentSize& size = package->sizes[i];
        SCOPED_TRACE(size.entry.name);
        EXPECT_EQ(size.entry.name, names[i]);
        EXPECT_EQ(size.simulation.triangles, package->sizes[0].simulation.triangles);
        EXPECT_EQ(count_loops(size.simulation.triangles), GetParam().openings);
        // Leggings are meant to stretch; the rest hangs nearly unstrained.
        EXPECT_LT(rms_strain(size),
                  package->manifest.fabric.stretch_warp_n_m < 200.0 ? 0.20 : 0.06);
        const auto body = body::load_body_model(body::find_avatar(size.entry.made_on));
        EXPECT_LE(deep_fraction(size, body), 0.001);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedGarment,
                         testing::Values(Shipped{"coat", 4}, Shipped{"draped-top", 4},
                                         Shipped{"dress", 4}, Shipped{"flared-skirt", 2},
                                         Shipped{"leggings", 3}, Shipped{"pencil-skirt", 2},
                                         Shipped{"shirt", 4}, Shipped{"shorts", 3},
                                         Shipped{"sweatshirt", 4}, Shipped{"tank-top", 4},
                                         Shipped{"tee", 4}, Shipped{"trousers", 3}),
                         [](const auto& tested) {
                             std::string name = tested.param.id;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(ShippedGarments, AllTogetherStayBelow40Megabytes) {
    std::uintmax_t sum = 0;
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(TOILE_SOURCE_DIR) / "garments")) {
        sum += entry.is_regular_file() ? entry.file_size() : 0;
    }
    EXPECT_LT(sum, 40'000'000u);
}

} // namespace
} // namespace toile::garment
