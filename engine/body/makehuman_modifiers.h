// MakeHuman's modifiers (age, muscle, weight ... and pairs of detail targets) as numbers, and the
// amounts of targets that they stand for. Amounts are piecewise multilinear in the modifiers, and
// shapes are linear in the amounts.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace toile::body {

/// One number that shapes a body.
struct Modifier {
    std::string name;    ///< "muscle", "measure/measure-waist-circ"
    double low, high;    ///< bounds that people are kept in
    double mean, spread; ///< of what random people get: normal, kept to the bounds
};

/// Places of the whole-body modifiers; pairs of detail targets follow.
enum MacroModifier : std::uint8_t {
    kWomanModifier,  ///< 0: man, 1: woman
    kAgeModifier,    ///< 0: 25 years, 1: 90 years
    kMuscleModifier, ///< 0 to 1, average 0.5; so are weight and height
    kWeightModifier,
    kHeightModifier,
    kAfricanModifier, ///< shares of the three regional shapes, sum 1
    kAsianModifier,
    kProportionsModifier, ///< -1: uncommon, 1: ideal
    kMacroModifierCount,
};

/// All modifiers that training may use: adults, and no family of held_out_modifiers.h.
class ModifierSet {
  public:
    ModifierSet();

    [[nodiscard]] const std::vector<Modifier>& modifiers() const { return modifiers_; }
    /// Names of targets, as MakeHumanData::target takes them. Left ones ("/l-") stand for the pair.
    [[nodiscard]] const std::vector<std::string>& targets() const { return targets_; }

    /// (targets) how much of each target `values` (modifiers) mean.
    [[nodiscard]] Eigen::VectorXd amounts(const Eigen::VectorXd& values) const;
    /// (targets x modifiers) derivative of the amounts; at a kink, that of the upper side.
    [[nodiscard]] Eigen::MatrixXd slopes(const Eigen::VectorXd& values) const;

    /// \throw Error for an unknown name
    [[nodiscard]] std::size_t index(const std::string& name) const;

  private:
    /// A number that multiplies a target, and its derivative to each macro modifier.
    struct Factor {
        double value = 0.0;
        Eigen::Matrix<double, kMacroModifierCount, 1> slope =
            Eigen::Matrix<double, kMacroModifierCount, 1>::Zero();
    };
    /// A whole-body target: the product of factors.
    struct Product {
        std::size_t target;
        std::vector<std::uint8_t> factors;
    };
    /// A detail: one target per sign.
    struct Pair {
        std::size_t modifier;
        int negative, positive; ///< targets, -1 where there is none
    };

    [[nodiscard]] static std::vector<Factor> factors(const Eigen::VectorXd& values);
    void add_products();
    void add_pair(const std::string& stem, const std::string& negative, const std::string& positive,
                  double spread, double reach);

    std::vector<Modifier> modifiers_;
    std::vector<std::string> targets_;
    std::vector<Product> products_;
    std::vector<Pair> pairs_;
};

} // namespace toile::body
