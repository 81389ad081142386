#include "body/makehuman_modifiers.h"

#include "body/held_out_modifiers.h"
#include "core/error.h"

#include <algorithm>
#include <array>

namespace toile::body {
namespace {

// Numbers that multiply whole-body targets, in the order of `ModifierSet::factors`.
enum FactorIndex : std::uint8_t {
    kFemale,
    kMale,
    kYoung,
    kOld,
    kAfrican,
    kAsian,
    kCaucasian,
    kMinMuscle,
    kAverageMuscle,
    kMaxMuscle,
    kMinWeight,
    kAverageWeight,
    kMaxWeight,
    kMinHeight,
    kMaxHeight,
    kUncommon,
    kIdeal,
    kFactorCount,
};

struct NamedFactor {
    const char* name;
    FactorIndex factor;
};
constexpr std::array<NamedFactor, 2> kGenders = {{{"female", kFemale}, {"male", kMale}}};
constexpr std::array<NamedFactor, 2> kAges = {{{"young", kYoung}, {"old", kOld}}};
constexpr std::array<NamedFactor, 3> kRegions = {
    {{"african", kAfrican}, {"asian", kAsian}, {"caucasian", kCaucasian}}};
constexpr std::array<NamedFactor, 3> kMuscles = {
    {{"minmuscle", kMinMuscle}, {"averagemuscle", kAverageMuscle}, {"maxmuscle", kMaxMuscle}}};
constexpr std::array<NamedFactor, 3> kWeights = {
    {{"minweight", kMinWeight}, {"averageweight", kAverageWeight}, {"maxweight", kMaxWeight}}};
constexpr std::array<NamedFactor, 2> kHeights = {
    {{"minheight", kMinHeight}, {"maxheight", kMaxHeight}}};
constexpr std::array<NamedFactor, 2> kProportions = {
    {{"uncommonproportions", kUncommon}, {"idealproportions", kIdeal}}};

// Pairs of detail targets by folder, with the spread of random people's amounts. What the
// template's 9 mm edges smooth over (eyes, mouth, ears, expressions) is left out.
struct DetailGroup {
    const char* folder;
    const char* suffixes; ///< "negative positive"
    double spread, reach;
    std::vector<const char*> stems;
};

const std::vector<DetailGroup>& detail_groups() {
    static const std::vector<DetailGroup> kGroups = {
        {"measure/measure-",
         "-decr -incr",
         0.1,
         1.3,
         {"ankle-circ",       "bust-circ",      "calf-circ",       "frontchest-dist",
          "hips-circ",        "knee-circ",      "lowerarm-length", "lowerleg-height",
          "napetowaist-dist", "neck-circ",      "neck-height",     "shoulder-dist",
          "thigh-circ",       "underbust-circ", "upperarm-circ",   "upperarm-length",
          "upperleg-height",  "waist-circ",     "waisttohip-dist", "wrist-circ"}},
        {"armslegs/l-",
         "-decr -incr",
         0.1,
         1.0,
         {"upperarm-fat",         "upperarm-muscle",
          "upperarm-scale-depth", "upperarm-scale-horiz",
          "upperarm-scale-vert",  "upperarm-shoulder-muscle",
          "lowerarm-fat",         "lowerarm-muscle",
          "lowerarm-scale-depth", "lowerarm-scale-horiz",
          "lowerarm-scale-vert",  "upperleg-fat",
          "upperleg-muscle",      "upperleg-scale-depth",
          "upperleg-scale-horiz", "upperleg-scale-vert",
          "lowerleg-fat",         "lowerleg-muscle",
          "lowerleg-scale-depth", "lowerleg-scale-horiz",
          "lowerleg-scale-vert",  "leg-valgus",
          "foot-scale",           "foot-scale-depth",
          "foot-scale-horiz",     "foot-scale-vert",
          "hand-scale",           "hand-fingers-diameter",
          "hand-fingers-length"}},
        {"torso/torso-",
         "-decr -incr",
         0.1,
         1.0,
         {"muscle-dorsi", "muscle-pectoral", "scale-depth", "scale-horiz", "scale-vert", "vshape"}},
        {"torso/torso-trans-", "backward forward", 0.06, 0.5, {""}},
        {"hip/hip-", "-decr -incr", 0.1, 1.0, {"scale-depth", "scale-horiz", "scale-vert"}},
        {"hip/hip-trans-", "backward forward", 0.06, 0.5, {""}},
        {"hip/hip-waist-", "down up", 0.1, 1.0, {""}},
        {"stomach/stomach-", "-decr -incr", 0.1, 1.0, {"tone", "pregnant"}},
        {"stomach/stomach-navel-", "in out", 0.1, 1.0, {""}},
        {"stomach/stomach-navel-", "down up", 0.1, 1.0, {""}},
        {"buttocks/buttocks-volume", "-decr -incr", 0.12, 1.0, {""}},
        {"pelvis/", "-decr -incr", 0.1, 1.0, {"pelvis-tone", "bulge"}},
        {"neck/neck-",
         "-decr -incr",
         0.1,
         1.0,
         {"back-scale-depth", "double", "scale-depth", "scale-horiz", "scale-vert"}},
        {"neck/neck-trans-", "backward forward", 0.06, 0.5, {""}},
        {"head/head-",
         "-decr -incr",
         0.1,
         1.0,
         {"age", "back-scale-depth", "fat", "scale-depth", "scale-horiz", "scale-vert"}},
        {"chin/chin-",
         "-decr -incr",
         0.1,
         1.0,
         {"bones", "height", "prognathism", "prominent", "width"}},
        {"cheek/l-cheek-", "-decr -incr", 0.1, 1.0, {"bones", "inner", "volume"}},
        {"forehead/forehead-", "-decr -incr", 0.1, 1.0, {"nubian", "scale-vert", "temple"}},
        {"nose/nose-",
         "-decr -incr",
         0.1,
         1.0,
         {"scale-depth", "scale-horiz", "scale-vert", "volume", "hump"}},
    };
    return kGroups;
}

} // namespace

ModifierSet::ModifierSet() {
    // Weight and height may leave [0, 1]: the data is linear there too, and people go further.
    modifiers_ = {{"woman", 0.0, 1.0, 0.5, 0.0},    {"age", 0.0, 0.75, 0.15, 0.15},
                  {"muscle", 0.0, 1.0, 0.55, 0.2},  {"weight", -0.1, 2.0, 0.6, 0.15},
                  {"height", -0.3, 1.5, 0.5, 0.15}, {"african", 0.0, 1.0, 0.33, 0.2},
                  {"asian", 0.0, 1.0, 0.33, 0.2},   {"proportions", -1.0, 1.0, 0.2, 0.4}};
    add_products();
    for (const auto& group : detail_groups()) {
        const std::string suffixes = group.suffixes;
        const auto space = suffixes.find(' ');
        for (const char* stem : group.stems)
            add_pair(std::string(group.folder) + stem, suffixes.substr(0, space),
                     suffixes.substr(space + 1), group.spread, group.reach);
    }
    for (const auto& target : targets_)
        if (held_out(target)) throw Error("target '" + target + "' is kept for testing");
}

void ModifierSet::add_products() {
    const auto add = [&](const std::string& name, std::vector<std::uint8_t> factors) {
        products_.push_back({targets_.size(), std::move(factors)});
        targets_.push_back("macrodetails/" + name);
    };
    for (const auto& gender : kGenders)
        for (const auto& age : kAges) {
            const std::string who = std::string(gender.name) + "-" + age.name;
            for (const auto& region : kRegions)
                add(region.name + ("-" + who), {gender.factor, age.factor, region.factor});
            for (const auto& muscle : kMuscles)
                for (const auto& weight : kWeights) {
                    const std::string build = who + "-" + muscle.name + "-" + weight.name;
                    const std::vector<std::uint8_t> common = {gender.factor, age.factor,
                                                              muscle.factor, weight.factor};
                    const auto with = [&](FactorIndex last) {
                        std::vector<std::uint8_t> all = common;
                        all.push_back(last);
                        return all;
                    };
                    add("universal-" + build, common);
                    for (const auto& height : kHeights)
                        add("height/" + build + "-" + height.name, with(height.factor));
                    for (const auto& proportions : kProportions)
                        add("proportions/" + build + "-" + proportions.name,
                            with(proportions.factor));
                }
        }
}

void ModifierSet::add_pair(const std::string& stem, const std::string& negative,
                           const std::string& positive, double spread, double reach) {
    const auto first = static_cast<int>(targets_.size());
    pairs_.push_back({modifiers_.size(), first, first + 1});
    targets_.push_back(stem + negative);
    targets_.push_back(stem + positive);
    const bool dash = stem.ends_with('-');
    modifiers_.push_back(
        {dash ? stem + negative + "-" + positive : stem, -reach, reach, 0.0, spread});
}

std::vector<ModifierSet::Factor> ModifierSet::factors(const Eigen::VectorXd& values) {
    std::vector<Factor> out(kFactorCount);
    const auto set = [&](FactorIndex factor, MacroModifier modifier, double value, double slope) {
        out[factor].value = value;
        out[factor].slope[modifier] = slope;
    };
    // Low, middle and high ends of a scale from 0 to 1.
    const auto three = [&](MacroModifier modifier, FactorIndex low, FactorIndex middle,
                           FactorIndex high) {
        const double v = values[modifier];
        const bool upper = v >= 0.5;
        set(low, modifier, upper ? 0.0 : 1.0 - 2.0 * v, upper ? 0.0 : -2.0);
        set(middle, modifier, upper ? 2.0 - 2.0 * v : 2.0 * v, upper ? -2.0 : 2.0);
        set(high, modifier, upper ? 2.0 * v - 1.0 : 0.0, upper ? 2.0 : 0.0);
    };
    set(kFemale, kWomanModifier, values[kWomanModifier], 1.0);
    set(kMale, kWomanModifier, 1.0 - values[kWomanModifier], -1.0);
    set(kYoung, kAgeModifier, 1.0 - values[kAgeModifier], -1.0);
    set(kOld, kAgeModifier, values[kAgeModifier], 1.0);
    set(kAfrican, kAfricanModifier, values[kAfricanModifier], 1.0);
    set(kAsian, kAsianModifier, values[kAsianModifier], 1.0);
    set(kCaucasian, kAfricanModifier, 1.0 - values[kAfricanModifier] - values[kAsianModifier],
        -1.0);
    out[kCaucasian].slope[kAsianModifier] = -1.0;
    three(kMuscleModifier, kMinMuscle, kAverageMuscle, kMaxMuscle);
    three(kWeightModifier, kMinWeight, kAverageWeight, kMaxWeight);
    const double height = values[kHeightModifier];
    set(height >= 0.5 ? kMaxHeight : kMinHeight, kHeightModifier, std::abs(2.0 * height - 1.0),
        height >= 0.5 ? 2.0 : -2.0);
    const double proportions = values[kProportionsModifier];
    set(proportions >= 0.0 ? kIdeal : kUncommon, kProportionsModifier, std::abs(proportions),
        proportions >= 0.0 ? 1.0 : -1.0);
    return out;
}

Eigen::VectorXd ModifierSet::amounts(const Eigen::VectorXd& values) const {
    const auto factor = factors(values);
    Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<int>(targets_.size()));
    for (const auto& product : products_) {
        double amount = 1.0;
        for (const auto f : product.factors)
            amount *= factor[f].value;
        out[static_cast<int>(product.target)] = amount;
    }
    for (const auto& pair : pairs_) {
        const double v = values[static_cast<int>(pair.modifier)];
        out[v >= 0.0 ? pair.positive : pair.negative] = std::abs(v);
    }
    return out;
}

Eigen::MatrixXd ModifierSet::slopes(const Eigen::VectorXd& values) const {
    const auto factor = factors(values);
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<int>(targets_.size()),
                                                static_cast<int>(modifiers_.size()));
    for (const auto& product : products_)
        for (std::size_t i = 0; i < product.factors.size(); ++i) {
            double others = 1.0;
            for (std::size_t k = 0; k < product.factors.size(); ++k)
                if (k != i) others *= factor[product.factors[k]].value;
            if (others != 0.0)
                out.row(static_cast<int>(product.target)).head<kMacroModifierCount>() +=
                    others * factor[product.factors[i]].slope.transpose();
        }
    for (const auto& pair : pairs_) {
        const auto m = static_cast<int>(pair.modifier);
        const bool positive = values[m] >= 0.0;
        out(positive ? pair.positive : pair.negative, m) = positive ? 1.0 : -1.0;
    }
    return out;
}

std::size_t ModifierSet::index(const std::string& name) const {
    const auto found = std::find_if(modifiers_.begin(), modifiers_.end(),
                                    [&](const Modifier& m) { return m.name == name; });
    if (found == modifiers_.end()) throw Error("no modifier '" + name + "'");
    return static_cast<std::size_t>(found - modifiers_.begin());
}

} // namespace toile::body
