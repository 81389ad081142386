// The committed avatars, and what the loader refuses.
#include "body/body_model.h"
#include "body/landmarks.h"
#include "core/json.h"
#include "geometry/parameterization.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <set>

namespace toile::body {
namespace {

namespace fs = std::filesystem;

fs::path avatars_folder() {
    return fs::path(TOILE_SOURCE_DIR) / "avatars";
}

/// The mirror image of each vertex, by position.
std::vector<std::uint32_t> mirror_images(const geometry::TriangleMesh& mesh) {
    std::map<std::array<float, 3>, std::uint32_t> index;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3f& p = mesh.positions[v];
        index[{p.x() + 0.0f, p.y(), p.z()}] = v;
    }
    std::vector<std::uint32_t> out;
    for (const auto& p : mesh.positions) {
        const auto found = index.find({-p.x() + 0.0f, p.y(), p.z()});
        out.push_back(found == index.end() ? 0xffffffffu : found->second);
    }
    return out;
}

class Avatar : public testing::TestWithParam<const char*> {
  protected:
    BodyModel model_ = load_body_model(avatars_folder() / GetParam());
};

TEST_P(Avatar, IsClosedInOnePieceAndStandsOnTheFloor) {
    const auto report = geometry::check_topology(model_.rest.positions, model_.rest.triangles);
    EXPECT_TRUE(report.closed()) << report.text();
    EXPECT_EQ(report.components, 1u);
    const auto euler = static_cast<int>(model_.rest.positions.size()) -
                       static_cast<int>(model_.rest.triangles.size()) / 2;
    EXPECT_EQ(euler, 2) << "no handles: fingers and limbs touch nothing";
    EXPECT_GT(geometry::volume(model_.rest), 0.04);
    EXPECT_LT(geometry::volume(model_.rest), 0.12);
    float floor = 1.0f;
    for (const auto& p : model_.rest.positions)
        floor = std::min(floor, p.y());
    EXPECT_NEAR(floor, 0.0f, 1e-5f);
}

TEST_P(Avatar, HasNearUniformTriangles) {
    const auto& mesh = model_.rest;
    EXPECT_NEAR(static_cast<double>(mesh.positions.size()), 13000.0, 1500.0);
    std::size_t poor = 0;
    for (const auto& t : mesh.triangles) {
        std::array<double, 3> edge{};
        for (std::size_t k = 0; k < 3; ++k)
            edge[k] = (mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).norm();
        std::sort(edge.begin(), edge.end());
        EXPECT_GT(edge[0], 0.0015);
        EXPECT_LT(edge[2], 0.032);
        poor += edge[2] > 2.0 * edge[0] ? 1 : 0;
    }
    EXPECT_LT(static_cast<double>(poor), 0.01 * static_cast<double>(mesh.triangles.size()));
}

TEST_P(Avatar, IsItsOwnMirrorImageWithWeightsAndParts) {
    const auto mirror = mirror_images(model_.rest);
    const auto mirrored_name = [](std::string name) {
        if (name.starts_with("left")) return "right" + name.substr(4);
        if (name.starts_with("right")) return "left" + name.substr(5);
        return name;
    };
    for (std::uint32_t v = 0; v < mirror.size(); ++v) {
        ASSERT_NE(mirror[v], 0xffffffffu) << "vertex " << v << " has no mirror image";
        std::map<std::string, float> here, there;
        for (std::size_t k = 0; k < 4; ++k) {
            const auto name = [&](std::uint32_t w) {
                return std::string(joint_name(static_cast<Joint>(model_.skin.joints[w][k])));
            };
            if (model_.skin.weights[v][k] > 0.0f)
                here[mirrored_name(name(v))] += model_.skin.weights[v][k];
            if (model_.skin.weights[mirror[v]][k] > 0.0f)
                there[name(mirror[v])] += model_.skin.weights[mirror[v]][k];
        }
        if (mirror[v] == v) continue; // ties on the midline may keep one side's joint
        EXPECT_EQ(here, there) << "vertex " << v;
        EXPECT_EQ(mirrored_name(std::string(part_label(model_.parts[v]))),
                  std::string(part_label(model_.parts[mirror[v]])));
    }
    for (const auto& [name, vertex] : model_.landmarks) {
        if (!name.starts_with("left_")) continue;
        EXPECT_EQ(model_.landmarks.at("right_" + name.substr(5)), mirror[vertex]) << name;
    }
}

TEST_P(Avatar, HasWeightsThatSumToOneAndAllParts) {
    std::set<Part> parts(model_.parts.begin(), model_.parts.end());
    EXPECT_EQ(parts.size(), 12u);
    EXPECT_EQ(parts.count(Part::invalid), 0u);
    std::set<std::uint16_t> joints;
    for (std::size_t v = 0; v < model_.skin.weights.size(); ++v) {
        float sum = 0.0f;
        for (std::size_t k = 0; k < 4; ++k) {
            sum += model_.skin.weights[v][k];
            if (model_.skin.weights[v][k] > 0.0f) joints.insert(model_.skin.joints[v][k]);
        }
        EXPECT_NEAR(sum, 1.0f, 1e-5f);
    }
    EXPECT_EQ(joints.size(), kJointCount) << "every joint moves something";
}

TEST_P(Avatar, HasItsJointsInsideTheBody) {
    // A joint lies inside when the solid angle of the surface around it is 4 pi.
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const Vec3d p = model_.skeleton.rest_positions[j].cast<double>();
        double angle = 0.0;
        for (const auto& t : model_.rest.triangles) {
            const Vec3d a = model_.rest.positions[t[0]].cast<double>() - p;
            const Vec3d b = model_.rest.positions[t[1]].cast<double>() - p;
            const Vec3d c = model_.rest.positions[t[2]].cast<double>() - p;
            const double la = a.norm(), lb = b.norm(), lc = c.norm();
            angle += 2.0 * std::atan2(a.dot(b.cross(c)),
                                      la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
        }
        EXPECT_NEAR(angle / (4.0 * M_PI), 1.0, 1e-3) << joint_name(static_cast<Joint>(j));
    }
}

TEST_P(Avatar, StandsInAnAPoseFacingForward) {
    const auto& s = model_.skeleton;
    const Vec3f arm = s.rest(Joint::left_lower_arm) - s.rest(Joint::left_upper_arm);
    const double down = std::acos(-arm.normalized().y()) * 180.0 / M_PI;
    EXPECT_GT(down, 35.0);
    EXPECT_LT(down, 50.0);
    EXPECT_GT(s.rest(Joint::left_toes).z(), s.rest(Joint::left_foot).z() + 0.05f);
    EXPECT_GT(s.rest(Joint::left_hand).x(), 0.3f) << "left is +x of a body that faces +z";
    // The thighs do not touch: nothing of the legs within a centimetre of the midline.
    const float crotch = model_.rest.positions[model_.landmarks.at("crotch")].y();
    for (const auto& p : model_.rest.positions)
        if (p.y() < crotch - 0.04f) EXPECT_GT(std::abs(p.x()), 0.004f) << p.transpose();
}

TEST_P(Avatar, HasTheMeasurementsOfItsSurface) {
    const auto at = [&](const char* name) {
        return model_.rest.positions[model_.landmarks.at(name)];
    };
    float top = 0.0f;
    for (const auto& p : model_.rest.positions)
        top = std::max(top, p.y());
    EXPECT_NEAR(model_.measurements.at("stature"), top, 1e-3);
    EXPECT_NEAR(model_.measurements.at("inside_leg_length"), at("crotch").y(), 1e-3);
    const std::map<std::string, std::map<std::string, double>> wanted = {
        {"woman",
         {{"stature", 1.68}, {"bust_girth", 0.90}, {"waist_girth", 0.72}, {"hip_girth", 0.944}}},
        {"man",
         {{"stature", 1.78}, {"bust_girth", 0.99}, {"waist_girth", 0.83}, {"hip_girth", 0.944}}},
        {"mannequin",
         {{"stature", 1.74}, {"bust_girth", 0.93}, {"waist_girth", 0.76}, {"hip_girth", 0.923}}}};
    for (const auto& [name, metres] : wanted.at(model_.id))
        EXPECT_NEAR(model_.measurements.at(name), metres, 0.01) << name;
    for (std::size_t i = 0; i < kLandmarkCount; ++i)
        EXPECT_EQ(model_.landmarks.count(std::string(landmark_name(static_cast<Landmark>(i)))), 1u)
            << landmark_name(static_cast<Landmark>(i));
}

/// Texels of a coarse picture of the atlas: which triangle covers each, twice is an overlap.
std::size_t overlapping_texels(const geometry::SeamedLayout& layout, int side) {
    std::vector<int> cover(static_cast<std::size_t>(side * side), -1);
    std::size_t overlaps = 0;
    for (std::size_t f = 0; f < layout.triangles.size(); ++f) {
        std::array<Vec2f, 3> p;
        for (std::size_t k = 0; k < 3; ++k)
            p[k] = static_cast<float>(side) * layout.texcoords[layout.triangles[f][k]];
        Eigen::AlignedBox2f box;
        for (const auto& q : p)
            box.extend(q);
        const auto edge = [](const Vec2f& a, const Vec2f& b, const Vec2f& c) {
            return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
        };
        for (int y = static_cast<int>(box.min().y()); y <= static_cast<int>(box.max().y()); ++y)
            for (int x = static_cast<int>(box.min().x()); x <= static_cast<int>(box.max().x());
                 ++x) {
                const Vec2f c(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                // Strictly inside by a margin: neighbours share their edge.
                if (edge(p[0], p[1], c) > -1e-3f || edge(p[1], p[2], c) > -1e-3f ||
                    edge(p[2], p[0], c) > -1e-3f)
                    continue;
                int& owner = cover[static_cast<std::size_t>(y * side + x)];
                overlaps += owner >= 0 ? 1 : 0;
                owner = static_cast<int>(f);
            }
    }
    return overlaps;
}

TEST_P(Avatar, HasAnAtlasWithoutOverlapsAndWithLittleDistortion) {
    const auto& layout = model_.layout;
    ASSERT_EQ(layout.texcoords.size(), layout.welded.size());
    std::size_t strong = 0;
    double area = 0.0;
    for (const auto& t : layout.triangles) {
        std::array<Vec2f, 3> plane;
        std::array<Vec3f, 3> surface;
        for (std::size_t k = 0; k < 3; ++k) {
            plane[k] = Vec2f(layout.texcoords[t[k]].x(), 1.0f - layout.texcoords[t[k]].y());
            surface[k] = model_.rest.positions[layout.welded[t[k]]];
            EXPECT_GE(plane[k].minCoeff(), 0.0f);
            EXPECT_LE(plane[k].maxCoeff(), 1.0f);
        }
        const Vec2f ab = plane[1] - plane[0], ac = plane[2] - plane[0];
        const double signed_area = 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
        EXPECT_GT(signed_area, 0.0);
        area += signed_area;
        const auto stretch = geometry::triangle_stretch(surface, plane);
        strong += stretch[0] > 2.0 * stretch[1] ? 1 : 0;
    }
    EXPECT_GT(area, 0.4) << "share of the texture in use";
    EXPECT_LT(static_cast<double>(strong), 0.02 * static_cast<double>(layout.triangles.size()));
    // 20 of 4.2 million texels of the atlas are covered twice (docs/decisions/0002-open-ends.md).
    EXPECT_LE(overlapping_texels(layout, 2048), 20u);
}

INSTANTIATE_TEST_SUITE_P(Committed, Avatar, testing::Values("woman", "man", "mannequin"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Avatars, ShareOneSurfaceAtlasAndSkin) {
    const BodyModel woman = load_body_model(avatars_folder() / "woman");
    EXPECT_EQ(woman.rest.positions.size(), 13338u);
    EXPECT_EQ(woman.rest.triangles.size(), 26672u);
    for (const char* id : {"man", "mannequin", "adult"}) {
        const BodyModel other = load_body_model(avatars_folder() / id);
        EXPECT_EQ(other.rest.positions.size(), woman.rest.positions.size()) << id;
        EXPECT_TRUE(other.rest.triangles == woman.rest.triangles) << id;
        EXPECT_TRUE(other.layout.welded == woman.layout.welded) << id;
        EXPECT_TRUE(other.layout.triangles == woman.layout.triangles) << id;
        EXPECT_TRUE(other.layout.texcoords == woman.layout.texcoords) << id;
        EXPECT_TRUE(other.skin.joints == woman.skin.joints) << id;
        EXPECT_TRUE(other.skin.weights == woman.skin.weights) << id;
        EXPECT_TRUE(other.parts == woman.parts) << id;
        EXPECT_EQ(other.landmarks, woman.landmarks) << id;
        EXPECT_EQ(other.measurements.size(), woman.measurements.size()) << id;
    }
}

/// A copy of the mannequin whose avatar.json was changed.
class BadAvatar : public testing::Test {
  protected:
    void SetUp() override {
        fs::copy(avatars_folder() / "mannequin", folder_.path(),
                 fs::copy_options::recursive | fs::copy_options::overwrite_existing);
        json_ = parse_json_file(folder_ / "avatar.json");
    }
    void expect_refused(const char* part) {
        std::ofstream(folder_ / "avatar.json") << json_.dump();
        EXPECT_ERROR(load_body_model(folder_.path()), part);
    }
    test::TemporaryFolder folder_;
    nlohmann::json json_;
};

TEST_F(BadAvatar, WithAnUnknownKey) {
    json_["colour"] = "red";
    expect_refused("colour");
}
TEST_F(BadAvatar, OfAnotherSchema) {
    json_["schema"] = 2;
    expect_refused("schema");
}
TEST_F(BadAvatar, WithoutAModel) {
    json_.erase("model");
    expect_refused("model");
}
TEST_F(BadAvatar, WithAModelOutsideItsFolder) {
    json_["model"] = "../woman/woman.glb";
    expect_refused("name of a file in this folder");
}
TEST_F(BadAvatar, WithAMissingModelFile) {
    json_["model"] = "nobody.glb";
    expect_refused("nobody.glb");
}
TEST_F(BadAvatar, WithoutAJoint) {
    json_["joints"].erase("leftHand");
    expect_refused("leftHand");
}
TEST_F(BadAvatar, WithAnUnknownJoint) {
    json_["joints"]["tail"] = {0, 0, 0};
    expect_refused("tail");
}
TEST_F(BadAvatar, WithAJointElsewhereThanInTheModel) {
    json_["joints"]["head"] = {0, 1.0, 0};
    expect_refused("head");
}
TEST_F(BadAvatar, WithTooFewLabels) {
    json_["parts"].erase(json_["parts"].size() - 1);
    expect_refused("without a label");
}
TEST_F(BadAvatar, WithTooManyLabels) {
    json_["parts"].push_back({{"part", "head"}, {"count", 1}});
    expect_refused("more vertices");
}
TEST_F(BadAvatar, WithAnUnknownPart) {
    json_["parts"][0]["part"] = "wing";
    expect_refused("none of the 12 body parts");
}
TEST_F(BadAvatar, WithALandmarkBeyondTheModel) {
    json_["landmarks"]["navel"] = 1000000;
    expect_refused("navel");
}
TEST_F(BadAvatar, WithANegativeMeasurement) {
    json_["measurements"]["stature"] = -1.0;
    expect_refused("stature");
}
TEST_F(BadAvatar, WithShapeComponentsTheModelHasNot) {
    json_["shape"] = {{{"name", "first"}, {"joint_offsets", std::vector<double>(66, 0.0)}}};
    expect_refused("shape");
}
TEST_F(BadAvatar, WithATruncatedModel) {
    fs::resize_file(folder_ / "mannequin.glb", 1000);
    expect_refused("mannequin.glb");
}

TEST(FindAvatar, NamesTheKnownOnes) {
    EXPECT_ERROR(find_avatar("nobody"), "no avatar 'nobody'");
}

} // namespace
} // namespace toile::body
