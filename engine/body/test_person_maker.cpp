#include "body/test_person_maker.h"

#include "body/avatar_anatomy.h"
#include "body/held_out_modifiers.h"
#include "core/error.h"
#include "core/random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace toile::body {
namespace {

constexpr float kMetresPerUnit = 0.1f; // the data is in decimetres
constexpr std::size_t kBodyVertices = 13380;
constexpr int kWaves = 32;
constexpr double kMostMacroWeight = 1.2; // of the macro targets; beyond, girths grow directly
constexpr double kMostWeight = 3.0;

/// A value from -1 to 1 as amounts of the data's three stages; beyond 1 the outer one goes on and
/// the middle one is taken back.
struct Stage {
    const char* name;
    double amount;
};
std::array<Stage, 2> stages(double value, const char* low, const char* middle, const char* high) {
    const double far = std::abs(value);
    return {Stage{value < 0.0 ? low : high, far}, Stage{middle, 1.0 - far}};
}

/// Adds targets that come in a pair, for less and for more.
void add_pair(ShapeRecipe& recipe, const std::string& name, double amount,
              const char* less = "decr", const char* more = "incr") {
    if (amount != 0.0) recipe[name + "-" + (amount < 0.0 ? less : more)] += std::abs(amount);
}

/// Modifiers that training knows too, a handful of them, gently.
void add_ordinary(ShapeRecipe& recipe, Random& random) {
    constexpr std::array<const char*, 14> kPairs = {"torso/torso-scale-depth",
                                                    "torso/torso-scale-horiz",
                                                    "torso/torso-vshape",
                                                    "torso/torso-muscle-pectoral",
                                                    "torso/torso-muscle-dorsi",
                                                    "hip/hip-scale-depth",
                                                    "hip/hip-scale-horiz",
                                                    "stomach/stomach-tone",
                                                    "buttocks/buttocks-volume",
                                                    "neck/neck-scale-horiz",
                                                    "measure/measure-shoulder-dist",
                                                    "measure/measure-upperarm-length",
                                                    "measure/measure-upperleg-height",
                                                    "measure/measure-lowerleg-height"};
    for (const char* pair : kPairs)
        if (random.uniform() < 0.5) add_pair(recipe, pair, random.uniform(-0.5, 0.5));
    constexpr std::array<const char*, 4> kLimbs = {"upperarm-fat", "lowerarm-muscle",
                                                   "upperleg-fat", "lowerleg-muscle"};
    for (const char* limb : kLimbs) {
        const double amount = random.uniform(-0.5, 0.5);
        for (const char* side : {"l-", "r-"})
            add_pair(recipe, std::string("armslegs/") + side + limb, amount);
    }
}

/// Girths of people who are heavier than the data's fattest: the measure targets, all together.
void add_bulk(ShapeRecipe& recipe, double amount) {
    constexpr std::array<std::pair<const char*, double>, 8> kGirths = {{{"waist", 1.0},
                                                                        {"hips", 0.9},
                                                                        {"bust", 0.8},
                                                                        {"underbust", 0.9},
                                                                        {"thigh", 0.8},
                                                                        {"upperarm", 0.8},
                                                                        {"neck", 0.5},
                                                                        {"calf", 0.5}}};
    for (const auto& [girth, share] : kGirths)
        recipe[std::string("measure/measure-") + girth + "-circ-incr"] += share * amount;
}

/// The families that training never sees: whole-body types, asymmetry, breasts.
void add_held_out(ShapeRecipe& recipe, bool woman, Random& random) {
    constexpr std::array<const char*, 12> kWomen = {
        "adrenal",     "apple", "diamond",        "full-hourglass", "invert-triangle", "liver",
        "lean-column", "ovary", "neat-hourglass", "rectangle",      "thyroid",         "triangle"};
    constexpr std::array<const char*, 10> kMen = {
        "adrenal", "apple",     "gonadal", "invert-triangle", "lean-column",
        "liver",   "rectangle", "thyroid", "trapezoid",       "triangle"};
    const double share = random.uniform(0.25, 0.7);
    const auto pick = [&](std::size_t n) {
        return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    };
    const std::string type = woman ? std::string("fem-") + kWomen[pick(kWomen.size())]
                                   : std::string("man-") + kMen[pick(kMen.size())];
    recipe["bodyshapes/bodyshapes-elvs-" + type] += share;

    const auto add_side = [&](const std::string& name, double most) {
        recipe["asym/" + name + (random.uniform() < 0.5 ? "-l" : "-r")] +=
            random.uniform(0.2, most);
    };
    add_side("asymm-trunk-1", 1.0);
    for (const char* face : {"asym-jaw-1", "asym-cheek-1", "asym-nose-2", "asym-ear-3"})
        add_side(face, 0.8);
    if (!woman) return;
    add_side("asymm-breast-1", 0.8);
    add_pair(recipe, "breast/breast-dist", random.uniform(-0.6, 0.6));
    add_pair(recipe, "breast/breast-trans", random.uniform(-0.6, 0.6), "down", "up");
    add_pair(recipe, "breast/breast-volume-vert", random.uniform(-0.6, 0.6), "down", "up");
}

/// Cup and firmness in the stages of muscle and weight; the average of both is no target.
void add_breasts(ShapeRecipe& recipe, double age, double muscle, double weight, Random& random) {
    const double cup = random.uniform(-0.7, 0.9);
    const double firmness = random.uniform(-0.8, 0.8);
    for (const Stage& a : {Stage{"young", 1.0 - age}, Stage{"old", age}})
        for (const Stage& m : stages(muscle, "minmuscle", "averagemuscle", "maxmuscle"))
            for (const Stage& w : stages(weight, "minweight", "averageweight", "maxweight"))
                for (const Stage& c : stages(cup, "mincup", "averagecup", "maxcup"))
                    for (const Stage& f :
                         stages(firmness, "minfirmness", "averagefirmness", "maxfirmness")) {
                        const std::string shape = std::string(c.name) + "-" + f.name;
                        const double amount = a.amount * m.amount * w.amount * c.amount * f.amount;
                        if (shape == "averagecup-averagefirmness" || amount == 0.0) continue;
                        recipe[std::string("breast/female-") + a.name + "-" + m.name + "-" +
                               w.name + "-" + shape] += amount;
                    }
}

/// Targets are read once.
class TargetShelf {
  public:
    explicit TargetShelf(const MakeHumanData& data) : data_(data) {}

    [[nodiscard]] std::vector<Vec3f> shape(const ShapeRecipe& recipe) {
        std::vector<Vec3f> out = data_.positions;
        for (const auto& [name, amount] : recipe) {
            auto [found, fresh] = targets_.try_emplace(name);
            if (fresh) found->second = data_.target(name);
            for (const TargetOffset& t : found->second)
                out[t.vertex] += static_cast<float>(amount) * t.offset;
        }
        return out;
    }

  private:
    const MakeHumanData& data_;
    std::map<std::string, std::vector<TargetOffset>> targets_;
};

std::vector<Triangle> triangulate(const std::vector<Quad>& quads) {
    std::vector<Triangle> out;
    for (const Quad& q : quads) {
        out.push_back({q[0], q[1], q[2]});
        out.push_back({q[0], q[2], q[3]});
    }
    return out;
}

double height_of(const std::vector<Vec3f>& positions) {
    float low = positions[0].y();
    float high = low;
    for (std::size_t v = 0; v < kBodyVertices; ++v) {
        low = std::min(low, positions[v].y());
        high = std::max(high, positions[v].y());
    }
    return static_cast<double>(high - low);
}

double volume_of(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles) {
    double six = 0.0;
    for (const Triangle& t : triangles)
        six += static_cast<double>(positions[t[0]].dot(positions[t[1]].cross(positions[t[2]])));
    return six / 6.0;
}

/// Numbers drawn for one person before any shape is made.
struct Draws {
    bool woman;
    double age, muscle, height, proportions, stature_m, bmi;
};

Draws draw(std::uint32_t number, const TestPeopleOptions& options, Random& random) {
    Draws out{};
    out.woman = number % 2 == 0;
    out.age = random.uniform(0.0, 0.8);
    out.muscle = std::clamp(0.4 * random.normal(), -0.8, 0.8);
    out.height = std::clamp(0.35 * random.normal(), -0.8, 0.8);
    out.proportions = random.uniform(-0.5, 0.5);
    out.stature_m = out.woman ? 1.63 + 0.065 * random.normal() : 1.756 + 0.07 * random.normal();
    // In pairs, so that heavy people are of both sexes.
    const bool heavy =
        options.heavy_every > 0 &&
        static_cast<int>(number / 2) % options.heavy_every == options.heavy_every - 1;
    out.bmi =
        heavy ? random.uniform(35.5, 42.0) : std::clamp(25.0 + 3.5 * random.normal(), 18.5, 33.0);
    return out;
}

/// Amount of the weight targets that gives the wanted body mass index, by bisection.
template <class Recipe>
double settle_weight(const Recipe& recipe_of, TargetShelf& shelf,
                     const std::vector<Triangle>& triangles, const Draws& draws) {
    const auto bmi = [&](double weight) {
        const std::vector<Vec3f> positions = shelf.shape(recipe_of(weight));
        const double scale = draws.stature_m / height_of(positions);
        return kBodyDensity * volume_of(positions, triangles) * scale * scale * scale /
               (draws.stature_m * draws.stature_m);
    };
    double low = -1.0;
    double high = kMostWeight;
    for (int i = 0; i < 20; ++i) {
        const double middle = 0.5 * (low + high);
        (bmi(middle) < draws.bmi ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Moves the surface along its normals by a few smooth waves of 12 to 40 cm; on face, hands and
/// feet by a quarter of that.
void displace(TestPerson& person, double size_m, Random& random) {
    const auto& rest = person.rest;
    std::array<Vec3f, kWaves> wave;
    std::array<float, kWaves> phase{};
    for (int k = 0; k < kWaves; ++k) {
        Vec3f axis(static_cast<float>(random.normal()), static_cast<float>(random.normal()),
                   static_cast<float>(random.normal()));
        const auto i = static_cast<std::size_t>(k);
        wave[i] = axis.normalized() *
                  static_cast<float>(2.0 * std::numbers::pi / random.uniform(0.12, 0.4));
        phase[i] = static_cast<float>(random.uniform(0.0, 2.0 * std::numbers::pi));
    }
    std::vector<float> height(rest.positions.size(), 0.0f);
    for (std::size_t v = 0; v < height.size(); ++v)
        for (std::size_t k = 0; k < kWaves; ++k)
            height[v] += std::cos(wave[k].dot(rest.positions[v]) + phase[k]);
    std::vector<float> size(height.size());
    std::transform(height.begin(), height.end(), size.begin(), [](float h) { return std::abs(h); });
    const auto most =
        size.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(size.size()));
    std::nth_element(size.begin(), most, size.end());
    const float scale = static_cast<float>(size_m) / *most;

    // How much of it each vertex takes: fine parts little, blended along the surface.
    std::vector<float> share(height.size());
    for (std::size_t v = 0; v < share.size(); ++v) {
        float fine = 0.0f;
        for (const BoneWeight& w : person.weights[v]) {
            const Vec3f& head = person.bones[static_cast<std::size_t>(w.bone)].head;
            const bool extremity =
                head.y() >= person.skeleton.rest(Joint::head).y() - 1e-4f ||
                head.y() <= person.skeleton.rest(Joint::left_foot).y() + 1e-4f ||
                std::abs(head.x()) >= std::abs(person.skeleton.rest(Joint::left_hand).x()) - 0.01f;
            if (extremity) fine += w.weight;
        }
        share[v] = 1.0f - 0.75f * fine;
    }
    for (std::size_t v = 0; v < height.size(); ++v)
        person.rest.positions[v] += share[v] * scale * height[v] * rest.normals[v];
    geometry::vertex_normals(rest.positions, rest.triangles, person.rest.normals);
    person.displacement_m = size_m;
}

void add_rig(TestPerson& person, const MakeHumanData& data, const std::vector<Vec3f>& positions) {
    for (const MakeHumanBone& bone : data.bones) {
        Vec3f head = Vec3f::Zero();
        for (const std::uint32_t v : bone.head)
            head += positions[v];
        person.bones.push_back(
            {bone.name, bone.parent, head / static_cast<float>(bone.head.size())});
    }
    const auto head_of = [&](const std::string& name) -> const Vec3f& {
        return std::find_if(person.bones.begin(), person.bones.end(),
                            [&](const TestPersonBone& b) { return b.name == name; })
            ->head;
    };
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto names = source_bones(static_cast<Joint>(j));
        person.skeleton.rest_positions[j] = 0.5f * (head_of(names[0]) + head_of(names[1]));
    }
}

/// Part labels from the source's weights: the joint that moves a vertex most.
std::vector<Part> label_parts(const TestPerson& person, const MakeHumanData& data) {
    const std::vector<Joint> joint_of = bone_joints(data);
    SkinWeights merged;
    for (const auto& row : person.weights) {
        std::array<float, kJointCount> sum{};
        for (const BoneWeight& w : row)
            sum[static_cast<std::size_t>(joint_of[static_cast<std::size_t>(w.bone)])] += w.weight;
        std::array<std::uint16_t, 4> joints{};
        std::array<float, 4> weights{};
        for (std::size_t k = 0; k < 4; ++k) {
            const auto largest = std::max_element(sum.begin(), sum.end());
            if (!(*largest > 0.0f)) break;
            joints[k] = static_cast<std::uint16_t>(largest - sum.begin());
            weights[k] = *largest;
            *largest = 0.0f;
        }
        merged.joints.push_back(joints);
        merged.weights.push_back(weights);
    }
    return make_part_labels(merged);
}

/// Some triangles with just the vertices that they need.
geometry::TriangleMesh cut_out(const std::vector<Vec3f>& positions,
                               std::vector<Triangle> triangles) {
    geometry::TriangleMesh out;
    std::map<std::uint32_t, std::uint32_t> numbers;
    for (Triangle& t : triangles)
        for (std::uint32_t& v : t) {
            const auto next = static_cast<std::uint32_t>(out.positions.size());
            const auto [found, fresh] = numbers.try_emplace(v, next);
            if (fresh) out.positions.push_back(positions[v]);
            v = found->second;
        }
    out.triangles = std::move(triangles);
    return out;
}

void stand_on_floor(TestPerson& person) {
    float floor = std::numeric_limits<float>::max();
    for (const Vec3f& p : person.rest.positions)
        floor = std::min(floor, p.y());
    for (Vec3f& p : person.rest.positions)
        p.y() -= floor;
    for (Vec3f& p : person.eyes.positions)
        p.y() -= floor;
    for (Vec3f& p : person.skeleton.rest_positions)
        p.y() -= floor;
    for (TestPersonBone& bone : person.bones)
        bone.head.y() -= floor;
}

} // namespace

ShapeRecipe macro_recipe(bool woman, double age, double muscle, double weight, double height,
                         double proportions) {
    const std::string sex = woman ? "female" : "male";
    ShapeRecipe recipe;
    for (const Stage& a : {Stage{"young", 1.0 - age}, Stage{"old", age}}) {
        if (a.amount == 0.0) continue;
        for (const char* region : {"african", "asian", "caucasian"})
            recipe[std::string("macrodetails/") + region + "-" + sex + "-" + a.name] =
                a.amount / 3.0;
        for (const Stage& m : stages(muscle, "minmuscle", "averagemuscle", "maxmuscle"))
            for (const Stage& w : stages(weight, "minweight", "averageweight", "maxweight")) {
                const std::string body = sex + "-" + a.name + "-" + m.name + "-" + w.name;
                const double amount = a.amount * m.amount * w.amount;
                if (amount == 0.0) continue;
                recipe["macrodetails/universal-" + body] += amount;
                add_pair(recipe, "macrodetails/height/" + body, amount * height, "minheight",
                         "maxheight");
                add_pair(recipe, "macrodetails/proportions/" + body, amount * proportions,
                         "uncommonproportions", "idealproportions");
            }
    }
    return recipe;
}

TestPerson make_test_person(const MakeHumanData& data, std::uint32_t number,
                            const TestPeopleOptions& options) {
    // A stream of its own for each purpose, so that switching one off leaves the others alone.
    const auto stream = [&](std::uint64_t purpose) {
        Random mixer(options.seed * 0x9e3779b97f4a7c15ull + 8 * number + purpose);
        return Random(mixer.next());
    };
    Random body_random = stream(0);
    const Draws draws = draw(number, options, body_random);
    const auto recipe_of = [&](double weight) {
        const double macro = std::min(weight, kMostMacroWeight);
        ShapeRecipe recipe = macro_recipe(draws.woman, draws.age, draws.muscle, macro, draws.height,
                                          draws.proportions);
        if (weight > macro) add_bulk(recipe, weight - macro);
        Random ordinary = stream(1);
        add_ordinary(recipe, ordinary);
        if (!options.out_of_model) return recipe;
        Random held = stream(2);
        add_held_out(recipe, draws.woman, held);
        if (draws.woman) add_breasts(recipe, draws.age, draws.muscle, macro, held);
        return recipe;
    };
    TargetShelf shelf(data);
    const std::vector<Triangle> triangles = triangulate(data.body);
    const double weight = settle_weight(recipe_of, shelf, triangles, draws);

    TestPerson person;
    person.id = (options.out_of_model ? "out-of-model-" : "in-model-") +
                std::to_string(options.seed) + "-" + std::to_string(number);
    person.woman = draws.woman;
    person.recipe = recipe_of(weight);
    std::vector<Vec3f> positions = shelf.shape(person.recipe);
    const auto scale = static_cast<float>(
        draws.stature_m / (static_cast<double>(kMetresPerUnit) * height_of(positions)));
    for (Vec3f& p : positions)
        p *= kMetresPerUnit * scale;

    person.rest.positions.assign(positions.begin(),
                                 positions.begin() + static_cast<std::ptrdiff_t>(kBodyVertices));
    person.rest.triangles = triangles;
    person.rest.normals.resize(kBodyVertices);
    geometry::vertex_normals(person.rest.positions, triangles, person.rest.normals);
    person.weights.assign(data.weights.begin(),
                          data.weights.begin() + static_cast<std::ptrdiff_t>(kBodyVertices));
    add_rig(person, data, positions);
    person.parts = label_parts(person, data);
    person.eyes = cut_out(positions, triangulate(data.eyes));
    if (options.out_of_model && options.most_displacement_m > 0.0) {
        Random smooth = stream(3);
        displace(person, smooth.uniform(options.least_displacement_m, options.most_displacement_m),
                 smooth);
    }
    stand_on_floor(person);
    find_test_person_truth(person);
    return person;
}

} // namespace toile::body
