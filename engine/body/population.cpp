#include "body/population.h"

#include "core/error.h"
#include "core/parallel.h"

#include <Eigen/Dense>
#include <algorithm>
#include <mutex>

namespace toile::body {
namespace {

constexpr int kRounds = 10;
constexpr double kMatchedError = 0.03, kGuideError = 0.5; // tolerated, in deviations
constexpr double kSolved = 0.02;                          // largest miss of a matched measure
// A person that misses by more is tried again from another start, and left out after so many.
constexpr double kAccepted = 0.2;
constexpr int kStarts = 5;
constexpr int kStature = 0, kWeight = 1;
constexpr double kUsualIndex = 25.0; // kg/m^2, of the data's average weight

constexpr double kHeavyLow = 35.0, kHeavyHigh = 45.0; // kg/m^2
constexpr int kUnseenHeavyShare = 4;                  // one in so many

// How far each kind of modifier gives way to the measurements, in its spread.
constexpr double kMacroGive = 1.5, kMeasureGive = 3.0, kOtherGive = 1.0;

} // namespace

PeopleMaker::PeopleMaker(const AvatarTemplate& avatar, const ModifierSet& modifiers,
                         const TargetBasis& basis, const AnsurPaths& paths)
    : avatar_(avatar), modifiers_(modifiers), basis_(basis), paths_(paths),
      side_(avatar.mesh.positions.size(), 1.0f), home_(avatar.mesh.positions.size()) {
    for (std::uint32_t v = 0; v < home_.size(); ++v) {
        home_[v] = v < avatar.half ? v : avatar.mirror_of[v];
        if (v >= avatar.half) side_[v] = -1.0f;
    }
}

Eigen::VectorXd PeopleMaker::random_modifiers(Sex sex, const Eigen::VectorXd& wanted,
                                              Random& random) const {
    const auto& all = modifiers_.modifiers();
    Eigen::VectorXd out(static_cast<int>(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i)
        out[static_cast<int>(i)] =
            std::clamp(all[i].mean + all[i].spread * random.normal(), all[i].low, all[i].high);
    out[kWomanModifier] =
        sex == Sex::female ? 1.0 - 0.1 * random.uniform() : 0.1 * random.uniform();
    // Evenly over the triangle of regional shapes.
    const double a = random.uniform(), b = random.uniform();
    out[kAfricanModifier] = std::min(a, b);
    out[kAsianModifier] = std::max(a, b) - std::min(a, b);
    // Starts near the wanted build.
    const double index = wanted[kWeight] / (wanted[kStature] * wanted[kStature]);
    out[kWeightModifier] += 0.03 * (index - kUsualIndex);
    return out;
}

Eigen::MatrixXd PeopleMaker::target_slopes(const std::vector<Measured>& measured,
                                           const Eigen::MatrixXd& by_modifier) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<int>(measured.size()),
                                                static_cast<int>(by_modifier.rows()));
    std::vector<int> active;
    for (int t = 0; t < by_modifier.rows(); ++t)
        if (!by_modifier.row(t).isZero(0.0)) active.push_back(t);
    Eigen::VectorXf gradient(basis_.origin.size());
    for (std::size_t m = 0; m < measured.size(); ++m) {
        gradient.setZero();
        std::vector<int> rows;
        for (const auto& [vertex, slope] : measured[m].slope) {
            const auto at = 3 * static_cast<int>(home_[vertex]);
            if (gradient.segment<3>(at).isZero(0.0f)) rows.push_back(at);
            gradient.segment<3>(at) += Vec3f(side_[vertex] * slope.x(), slope.y(), slope.z());
        }
        std::sort(rows.begin(), rows.end());
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
        for (const int t : active) {
            double sum = 0.0;
            for (const int at : rows)
                sum += static_cast<double>(
                    gradient.segment<3>(at).dot(basis_.targets.col(t).segment<3>(at)));
            out(static_cast<int>(m), t) = sum;
        }
    }
    return out;
}

Person PeopleMaker::make(Sex sex, const Eigen::VectorXd& wanted, const Eigen::VectorXd& deviation,
                         Random& random) const {
    const auto& all = modifiers_.modifiers();
    const auto& measures = ansur_measures();
    const auto n = static_cast<int>(measures.size());
    Person out;
    out.sex = sex;
    const Eigen::VectorXd start = random_modifiers(sex, wanted, random);
    Eigen::VectorXd give(start.size()), error(n);
    for (int i = 0; i < give.size(); ++i) {
        const auto& m = all[static_cast<std::size_t>(i)];
        const double share = i < kMacroModifierCount          ? kMacroGive
                             : m.name.starts_with("measure/") ? kMeasureGive
                                                              : kOtherGive;
        give[i] = share * share * m.spread * m.spread;
    }
    give[kAgeModifier] = give[kAfricanModifier] = give[kAsianModifier] = 0.0;
    for (int m = 0; m < n; ++m)
        error[m] = measures[static_cast<std::size_t>(m)].matched ? kMatchedError : kGuideError;

    out.modifiers = start;
    for (int round = 0;; ++round) {
        const Eigen::VectorXd amounts = modifiers_.amounts(out.modifiers);
        out.coordinates = basis_.coordinates(amounts);
        const auto measured = paths_.measure(unfold(avatar_, out.coordinates));
        out.measures.resize(n);
        out.miss = 0.0;
        for (int m = 0; m < n; ++m) {
            out.measures[m] = measured[static_cast<std::size_t>(m)].value;
            if (measures[static_cast<std::size_t>(m)].matched)
                out.miss = std::max(out.miss, std::abs(wanted[m] - out.measures[m]) / deviation[m]);
        }
        if (out.miss < kSolved || round == kRounds) return out;

        // min |x - start|^2 in the metric of `give` + |J dx - missing|^2 / error^2, by its dual.
        const Eigen::MatrixXd by_modifier = modifiers_.slopes(out.modifiers);
        const Eigen::MatrixXd J = deviation.cwiseInverse().asDiagonal() *
                                  target_slopes(measured, by_modifier) * by_modifier;
        Eigen::VectorXd missing = (wanted - out.measures).cwiseQuotient(deviation);
        // A modifier that would leave its bounds is moved to the bound, and the step taken again.
        Eigen::VectorXd free = give;
        Eigen::VectorXd next;
        for (int pass = 0; pass < 4; ++pass) {
            const Eigen::VectorXd back =
                (free.array() > 0.0)
                    .select(start - out.modifiers, Eigen::VectorXd::Zero(free.size()));
            const Eigen::MatrixXd GJt = free.asDiagonal() * J.transpose();
            Eigen::MatrixXd system = J * GJt;
            system.diagonal() += error.cwiseAbs2();
            next = out.modifiers + back + GJt * system.ldlt().solve(missing - J * back);
            bool held = false;
            for (int i = 0; i < next.size(); ++i) {
                const auto& m = all[static_cast<std::size_t>(i)];
                const double kept = std::clamp(next[i], m.low, m.high);
                if (kept == next[i] || free[i] == 0.0) continue;
                held = true;
                free[i] = 0.0;
                missing -= J.col(i) * (kept - out.modifiers[i]);
                out.modifiers[i] = kept;
            }
            if (!held) break;
        }
        out.modifiers = next;
        for (int i = 0; i < next.size(); ++i)
            out.modifiers[i] = std::clamp(next[i], all[static_cast<std::size_t>(i)].low,
                                          all[static_cast<std::size_t>(i)].high);
    }
}

Population make_population(const PeopleMaker& maker, const PopulationOptions& options) {
    Population out;
    struct Wish {
        Sex sex;
        Eigen::VectorXd measures, deviation;
        std::vector<Person>* list;
        std::size_t place;
    };
    std::vector<Wish> wishes;
    Random random(options.seed);
    for (std::size_t s = 0; s < kSexes.size(); ++s) {
        const Eigen::MatrixXd rows = read_ansur(options.survey, kSexes[s]);
        out.survey[s] = statistics(rows);
        const int ordinary = options.unseen_per_sex - options.unseen_per_sex / kUnseenHeavyShare;
        if (rows.rows() < options.per_sex + ordinary)
            throw Error("the survey has only " + std::to_string(rows.rows()) + " " +
                        sex_name(kSexes[s]) + " people, asked for " +
                        std::to_string(options.per_sex + ordinary));
        const auto order = shuffled(static_cast<int>(rows.rows()), random);
        const auto wish = [&](std::vector<Person>& list, const Eigen::VectorXd& measures) {
            wishes.push_back({kSexes[s], measures, out.survey[s].deviation, &list, list.size()});
            list.emplace_back();
        };
        const auto heavy = [&](std::vector<Person>& list, int count) {
            const Eigen::MatrixXd people =
                heavy_people(rows, static_cast<std::size_t>(count), kHeavyLow, kHeavyHigh, random);
            for (int i = 0; i < count; ++i)
                wish(list, people.row(i));
        };
        for (int i = 0; i < options.per_sex; ++i)
            wish(out.matched, rows.row(order[static_cast<std::size_t>(i)]));
        for (int i = 0; i < ordinary; ++i)
            wish(out.unseen, rows.row(order[static_cast<std::size_t>(options.per_sex) +
                                            static_cast<std::size_t>(i)]));
        heavy(out.heavy, options.heavy_per_sex);
        heavy(out.unseen, options.unseen_per_sex - ordinary);
    }

    std::size_t done = 0;
    std::mutex guard;
    parallel_for(wishes.size(), [&](std::size_t i) {
        const Wish& wish = wishes[i];
        // Each person has a sequence of their own, so that the order of work does not matter.
        Random traits(Random(options.seed + 1 + i).next());
        Person best = maker.make(wish.sex, wish.measures, wish.deviation, traits);
        for (int start = 1; start < kStarts && best.miss > kAccepted; ++start) {
            Person other = maker.make(wish.sex, wish.measures, wish.deviation, traits);
            if (other.miss < best.miss) best = std::move(other);
        }
        (*wish.list)[wish.place] = std::move(best);
        const std::lock_guard lock(guard);
        if (++done % 50 == 0)
            options.progress(static_cast<double>(done) / static_cast<double>(wishes.size()));
    });
    for (auto* list : {&out.matched, &out.heavy, &out.unseen})
        out.dropped += std::erase_if(*list, [](const Person& p) { return p.miss > kAccepted; });
    return out;
}

Statistics measure_statistics(std::span<const Person> people, Sex sex) {
    std::vector<const Person*> chosen;
    for (const auto& person : people)
        if (person.sex == sex) chosen.push_back(&person);
    Eigen::MatrixXd rows(static_cast<int>(chosen.size()),
                         static_cast<int>(ansur_measures().size()));
    for (std::size_t i = 0; i < chosen.size(); ++i)
        rows.row(static_cast<int>(i)) = chosen[i]->measures;
    return statistics(rows);
}

} // namespace toile::body
