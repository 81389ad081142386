// People for training: bodies whose ANSUR measurements are those asked for, and whose other traits
// are random.
#pragma once

#include "body/ansur_paths.h"
#include "body/ansur_survey.h"
#include "body/makehuman_modifiers.h"
#include "body/target_basis.h"

#include <functional>

namespace toile::body {

/// One person on the template.
struct Person {
    Sex sex = Sex::invalid;
    Eigen::VectorXd modifiers;   ///< (modifiers)
    Eigen::VectorXf coordinates; ///< see TargetBasis
    Eigen::VectorXd measures;    ///< as read on the body, in the order of `ansur_measures`
    double miss = 0.0;           ///< largest of a matched measure, in deviations
};

struct PopulationOptions {
    std::filesystem::path survey; ///< folder of ANSUR II
    int per_sex = 1600;           ///< people who are rows of the survey
    int heavy_per_sex = 150;      ///< added, with a body mass index from 35 to 45 kg/m^2
    int unseen_per_sex = 60;      ///< further rows and (a quarter) heavy people, for testing
    std::uint64_t seed = 1;
    std::function<void(double)> progress = [](double) {};
};

/// Everybody who was made.
struct Population {
    std::vector<Person> matched; ///< their statistics are the survey's
    std::vector<Person> heavy;
    std::vector<Person> unseen;
    std::size_t dropped = 0;          ///< people that no start led to the measurements asked for
    std::array<Statistics, 2> survey; ///< of all its rows, in the order of kSexes
};

/// Solves modifiers for measurements. Const after construction; calls may run side by side.
class PeopleMaker {
  public:
    /// Borrows all four.
    PeopleMaker(const AvatarTemplate& avatar, const ModifierSet& modifiers,
                const TargetBasis& basis, const AnsurPaths& paths);

    /// The body nearest to a random one (drawn with `random`) that measures `wanted`: Gauss-Newton
    /// with the modifiers' spreads as metric. `deviation` (measures) is the population's, and sets
    /// what counts as equal.
    [[nodiscard]] Person make(Sex sex, const Eigen::VectorXd& wanted,
                              const Eigen::VectorXd& deviation, Random& random) const;

  private:
    [[nodiscard]] Eigen::VectorXd random_modifiers(Sex sex, const Eigen::VectorXd& wanted,
                                                   Random& random) const;
    /// (measures x targets) derivative of the measures at a body, for targets that some modifier
    /// moves (rows of `by_modifier`); others: zero.
    [[nodiscard]] Eigen::MatrixXd target_slopes(const std::vector<Measured>& measured,
                                                const Eigen::MatrixXd& by_modifier) const;

    const AvatarTemplate& avatar_;
    const ModifierSet& modifiers_;
    const TargetBasis& basis_;
    const AnsurPaths& paths_;
    std::vector<float> side_;         ///< (nv) 1 in the template's first half, else -1
    std::vector<std::uint32_t> home_; ///< (nv) the vertex of the first half
};

/// Makes the population; equal options give equal people. Takes some minutes. \throw Error
[[nodiscard]] Population make_population(const PeopleMaker& maker,
                                         const PopulationOptions& options);

/// Statistics of `people` of one sex.
[[nodiscard]] Statistics measure_statistics(std::span<const Person> people, Sex sex);

} // namespace toile::body
