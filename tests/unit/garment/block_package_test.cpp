// The garments that ship, held against the bodies they were made on; and that they can be made
// again.
#include "garment/block_package.h"

#include "core/bytes.h"
#include "geometry/nearest_surface.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace toile::garment::block {
namespace {

class ShippedGarment : public testing::TestWithParam<std::string> {
  protected:
    std::shared_ptr<const GarmentPackage> package_ = load_package(find_garment(GetParam()));
};

// Number of closed border loops.
std::size_t border_loops(const std::vector<Triangle>& triangles) {
    std::map<std::uint32_t, std::uint32_t> next;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const Triangle& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            ++edges[{t[k], t[(k + 1) % 3]}];
        }
    }
    for (const auto& [edge, count] : edges) {
        if (!edges.contains({edge.second, edge.first})) {
            next[edge.first] = edge.second;
        }
    }
    std::size_t loops = 0;
    while (!next.empty()) {
        ++loops;
        for (auto at = next.begin(); at != next.end();) {
            const std::uint32_t to = at->second;
            next.erase(at);
            at = next.find(to);
        }
    }
    return loops;
}

TEST_P(ShippedGarment, IsASheetWithItsOpenings) {
    for (const GarmentSize& size : package_->sizes) {
        const auto report =
            geometry::check_topology(size.simulation.positions, size.simulation.triangles);
        EXPECT_TRUE(report.manifold()) << report.text();
        EXPECT_EQ(report.components, 1u);
        EXPECT_EQ(border_loops(size.simulation.triangles), GetParam() == "skirt" ? 2u : 4u);
        EXPECT_GT(size.simulation.positions.size(), 2500u);
        EXPECT_LT(size.simulation.positions.size(), 3700u);
    }
}

TEST_P(ShippedGarment, StandsClearOfItsBody) {
    for (const GarmentSize& size : package_->sizes) {
        const auto body = body::load_body_model(body::find_avatar(size.entry.made_on));
        const geometry::NearestSurface skin(body.rest.positions, body.rest.triangles);
        float nearest = 1.0f;
        const auto& p = size.simulation.positions;
        for (const Vec3f& v : p) {
            nearest = std::min(nearest, skin.nearest(v).signed_distance);
        }
        for (const Triangle& t : size.simulation.triangles) {
            const Vec3f centre = (p[t[0]] + p[t[1]] + p[t[2]]) / 3.0f;
            nearest = std::min(nearest, skin.nearest(centre).signed_distance);
        }
        EXPECT_GE(nearest, static_cast<float>(package_->manifest.ease_m)) << size.entry.name;
    }
}

TEST_P(ShippedGarment, HangsAtItsFlatLengths) {
    for (const GarmentSize& size : package_->sizes) {
        double squares = 0.0;
        double edges = 0.0;
        for (std::size_t t = 0; t < size.simulation.triangles.size(); ++t) {
            const Triangle& corners = size.simulation.triangles[t];
            std::array<Vec2f, 3> m;
            for (std::size_t k = 0; k < 3; ++k) {
                m[k] = size.material_coords[3 * t + k];
            }
            const Vec2f u = m[1] - m[0];
            const Vec2f v = m[2] - m[0];
            ASSERT_GT(u.x() * v.y() - u.y() * v.x(), 0.0f) << "a panel is turned over";
            for (std::size_t k = 0; k < 3; ++k) {
                const double flat = (m[(k + 1) % 3] - m[k]).norm();
                const double now = (size.simulation.positions[corners[(k + 1) % 3]] -
                                    size.simulation.positions[corners[k]])
                                       .norm();
                squares += std::pow(now / flat - 1.0, 2);
                edges += 1.0;
            }
        }
        EXPECT_LT(std::sqrt(squares / edges), 0.03) << size.entry.name;
    }
}

TEST_P(ShippedGarment, HasContiguousSizes) {
    const auto& sizes = package_->sizes;
    ASSERT_GE(sizes.size(), 2u);
    for (const auto& [name, range] : sizes.front().entry.chart) {
        for (std::size_t i = 1; i < sizes.size(); ++i) {
            EXPECT_DOUBLE_EQ(sizes[i].entry.chart.at(name).minimum,
                             sizes[i - 1].entry.chart.at(name).maximum);
        }
    }
    for (const GarmentSize& size : sizes) {
        const auto body = body::load_body_model(body::find_avatar(size.entry.made_on));
        for (const auto& [name, range] : size.entry.chart) {
            EXPECT_GE(body.measurements.at(name), range.minimum) << size.entry.name;
            EXPECT_LE(body.measurements.at(name), range.maximum) << size.entry.name;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Blocks, ShippedGarment, testing::Values("t-shirt", "skirt"));

// A coarse, hardly draped version: the whole way in a second or two.
Design coarse(const std::string& block) {
    Design design = find_design(block);
    design.edge_m = 0.035;
    design.drape.shrink_steps = 20;
    design.drape.settle_steps = 10;
    design.drape.finish_steps = 10;
    design.drape.rest_m_s = design.drape.most_strain = 1e9; // it has no time to come to rest
    return design;
}

TEST(Block, MakesEqualBytes) {
    const SizeOrder order = {"M", std::make_shared<const body::BodyModel>(
                                      body::load_body_model(body::find_avatar("mannequin")))};
    const test::TemporaryFolder a;
    const test::TemporaryFolder b;
    write_package(make_block(coarse("t-shirt"), {&order, 1}), a.path());
    write_package(make_block(coarse("t-shirt"), {&order, 1}), b.path());
    for (const char* const name : {"garment.json", "t-shirt-M.glb"}) {
        EXPECT_EQ(read_bytes(a / name, 1u << 24), read_bytes(b / name, 1u << 24)) << name;
    }
}

// Square metres of cloth.
double cloth_area(const GarmentPackage& package) {
    double area = 0.0;
    const auto& at = package.sizes.front().material_coords;
    for (std::size_t c = 0; c + 2 < at.size(); c += 3) {
        const Vec2f a = at[c + 1] - at[c];
        const Vec2f b = at[c + 2] - at[c];
        area += 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
    }
    return area;
}

TEST(Block, EaseIsCutAroundTheBody) {
    const SizeOrder order = {"M", std::make_shared<const body::BodyModel>(
                                      body::load_body_model(body::find_avatar("mannequin")))};
    Design close = coarse("t-shirt");
    close.girth_ease_m = 0.02;
    close.id = "close-shirt";
    Design wide = coarse("t-shirt");
    wide.girth_ease_m = 0.12;
    const GarmentPackage narrow = make_block(close, {&order, 1});
    // Ten centimetres more around a body of some 60 cm, and in the sleeves.
    EXPECT_GT(cloth_area(make_block(wide, {&order, 1})) - cloth_area(narrow), 0.05);
    EXPECT_EQ(narrow.manifest.id, "close-shirt");
    EXPECT_EQ(narrow.manifest.kind, "t-shirt");
}

TEST(Block, RefusesWhatDoesNotHang) {
    const SizeOrder order = {"M", std::make_shared<const body::BodyModel>(
                                      body::load_body_model(body::find_avatar("mannequin")))};
    Design restless = coarse("t-shirt");
    restless.drape.rest_m_s = 0.05;
    EXPECT_ERROR(static_cast<void>(make_block(restless, {&order, 1})), "did not come to rest");
    Design torn = coarse("t-shirt");
    torn.drape.most_strain = 0.01;
    EXPECT_ERROR(static_cast<void>(make_block(torn, {&order, 1})), "where panel '");
    try {
        static_cast<void>(make_block(torn, {&order, 1}));
        ADD_FAILURE() << "not refused";
    } catch (const DrapeRefused& refused) {
        EXPECT_EQ(refused.size(), "M");
        EXPECT_FALSE(refused.panel().empty());
        EXPECT_EQ(refused.options().most_strain, 0.01);
        EXPECT_GT(refused.report().worst_strain, 0.01);
    }
}

TEST(Block, RefusesWhatItCannotMake) {
    EXPECT_ERROR(static_cast<void>(find_design("cape")), "there are skirt, t-shirt");
    EXPECT_ERROR(static_cast<void>(make_block("skirt", {})), "no sizes");
    const auto man =
        std::make_shared<const body::BodyModel>(body::load_body_model(body::find_avatar("man")));
    const std::vector<SizeOrder> same = {{"S", man}, {"L", man}};
    EXPECT_ERROR(static_cast<void>(make_block(coarse("skirt"), same)), "must grow");
}

} // namespace
} // namespace toile::garment::block
