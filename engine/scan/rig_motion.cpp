#include "scan/rig_motion.h"

#include "core/error.h"
#include "core/random.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace toile::scan {
namespace {

constexpr std::size_t kFewest = 8;    // places that two cameras must share
constexpr double kReach_m = 0.03;     // of a pair that agrees
constexpr double kLeastSpread = 0.04; // metres off a line

/// Rms of points off the straight line that is nearest to them.
double off_line(std::span<const Vec3d> points) {
    Vec3d middle = Vec3d::Zero();
    for (const Vec3d& p : points)
        middle += p / static_cast<double>(points.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vec3d& p : points)
        spread += (p - middle) * (p - middle).transpose() / static_cast<double>(points.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
    return std::sqrt(std::max(0.0, eigen.eigenvalues()[0] + eigen.eigenvalues()[1]));
}

std::vector<std::uint32_t> agreeing(std::span<const Vec3d> a, std::span<const Vec3d> b,
                                    const Pose& a_from_b, double reach_m) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = 0; i < a.size(); ++i)
        if ((a[i] - a_from_b * b[i]).norm() < reach_m) out.push_back(i);
    return out;
}

/// What two cameras saw at one time.
struct Shared {
    std::vector<Vec3d> a, b;
    std::vector<std::uint32_t> places;
};

Shared shared(const SeenPlaces& seen, std::size_t a, std::size_t b) {
    Shared out;
    for (std::uint32_t k = 0; k < seen[a].size(); ++k)
        if (seen[a][k] && seen[b][k]) {
            out.a.push_back(seen[a][k]->point);
            out.b.push_back(seen[b][k]->point);
            out.places.push_back(k);
        }
    return out;
}

Eigen::Matrix3d information(const SeenPlace& place, const Pose& pose) {
    const Vec3d ray = pose.linear() * place.point.normalized();
    const double along = 1.0 / (place.along_m * place.along_m);
    const double across = 1.0 / (place.across_m * place.across_m);
    return across * Eigen::Matrix3d::Identity() + (along - across) * ray * ray.transpose();
}

} // namespace

Pose rigid_motion(std::span<const Vec3d> a, std::span<const Vec3d> b) {
    Vec3d middle_a = Vec3d::Zero(), middle_b = Vec3d::Zero();
    const auto n = static_cast<double>(a.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        middle_a += a[i] / n, middle_b += b[i] / n;
    Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < a.size(); ++i)
        cross += (a[i] - middle_a) * (b[i] - middle_b).transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d U = svd.matrixU();
    if ((U * svd.matrixV().transpose()).determinant() < 0.0) U.col(2) *= -1.0;
    Pose out = Pose::Identity();
    out.linear() = U * svd.matrixV().transpose();
    out.translation() = middle_a - out.linear() * middle_b;
    return out;
}

RigidFit robust_motion(std::span<const Vec3d> a, std::span<const Vec3d> b, double reach_m,
                       int draws, std::size_t sample) {
    RigidFit best;
    if (a.size() < sample) return best;
    Random random(a.size());
    std::vector<Vec3d> some_a(sample), some_b(sample);
    for (int draw = 0; draw < draws; ++draw) {
        for (std::size_t k = 0; k < sample; ++k) {
            const std::size_t i = random.next() % a.size();
            some_a[k] = a[i], some_b[k] = b[i];
        }
        bool alike = true; // a rigid motion keeps lengths
        for (std::size_t k = 0; k < sample && alike; ++k)
            for (std::size_t j = k + 1; j < sample && alike; ++j) {
                const double length = (some_a[k] - some_a[j]).norm();
                alike = length > reach_m &&
                        std::abs(length - (some_b[k] - some_b[j]).norm()) < 2.0 * reach_m;
            }
        if (!alike) continue;
        auto inliers = agreeing(a, b, rigid_motion(some_a, some_b), reach_m);
        if (inliers.size() > best.inliers.size()) best.inliers = std::move(inliers);
    }
    for (int round = 0; round < 5 && best.inliers.size() >= sample; ++round) {
        std::vector<Vec3d> in_a, in_b;
        for (const std::uint32_t i : best.inliers)
            in_a.push_back(a[i]), in_b.push_back(b[i]);
        best.a_from_b = rigid_motion(in_a, in_b);
        best.spread_m = off_line(in_a);
        double square = 0.0;
        for (std::size_t i = 0; i < in_a.size(); ++i)
            square += (in_a[i] - best.a_from_b * in_b[i]).squaredNorm();
        best.rms_m = std::sqrt(square / static_cast<double>(in_a.size()));
        auto next = agreeing(a, b, best.a_from_b, reach_m);
        if (next == best.inliers) break;
        best.inliers = std::move(next);
    }
    return best;
}

namespace {

/// Cameras chained from the first one, each by the pair that shares most places.
class Chain {
  public:
    Chain(const SeenPlaces& seen, std::span<const std::string> names) : seen_(seen), names_(names) {
        used_.assign(seen.size(), std::vector<std::uint8_t>(seen[0].size(), 0));
        poses_.assign(seen.size(), Pose::Identity());
        std::vector<bool> placed(seen.size(), false);
        placed[0] = true;
        for (std::size_t count = 1; count < seen.size(); ++count)
            place_one(placed);
    }

    std::vector<std::vector<std::uint8_t>> used_; ///< (cameras x places)
    std::vector<Pose> poses_;                     ///< first from camera

  private:
    void place_one(std::vector<bool>& placed) {
        RigidFit best;
        std::size_t from = 0, to = 0;
        for (std::size_t a = 0; a < seen_.size(); ++a)
            for (std::size_t b = 0; b < seen_.size(); ++b) {
                if (!placed[a] || placed[b]) continue;
                const Shared both = shared(seen_, a, b);
                most_shared_ = std::max(most_shared_, both.a.size());
                RigidFit fit = robust_motion(both.a, both.b, kReach_m);
                if (fit.inliers.size() >= kFewest && fit.spread_m < kLeastSpread) straight_ = true;
                if (fit.inliers.size() < kFewest || fit.spread_m < kLeastSpread ||
                    fit.inliers.size() <= best.inliers.size())
                    continue;
                for (std::uint32_t& i : fit.inliers)
                    i = both.places[i];
                best = std::move(fit);
                from = a, to = b;
            }
        if (best.inliers.empty()) refuse(placed);
        poses_[to] = poses_[from] * best.a_from_b;
        placed[to] = true;
        straight_ = false;
        most_shared_ = 0;
        for (const std::uint32_t k : best.inliers)
            used_[from][k] = used_[to][k] = 1;
    }

    [[noreturn]] void refuse(const std::vector<bool>& placed) const {
        const auto at = static_cast<std::size_t>(std::find(placed.begin(), placed.end(), false) -
                                                 placed.begin());
        const auto own = std::count_if(seen_[at].begin(), seen_[at].end(),
                                       [](const auto& place) { return place.has_value(); });
        const std::string who = "camera '" + names_[at] + "'";
        if (static_cast<std::size_t>(own) < kFewest)
            throw Error(who + " sees it in " + std::to_string(own) + " pictures; at least " +
                        std::to_string(kFewest) + " are needed: move it about within its view");
        if (most_shared_ == 0)
            throw Error(who + " never sees it at the same time as another camera: move it where "
                              "the views of two cameras meet, and start them together");
        if (straight_)
            throw Error(who + " sees it on one straight line only, which leaves a turn about that "
                              "line open: move it up, down and aside as well");
        throw Error(who + " and the others agree on fewer than " + std::to_string(kFewest) +
                    " of the " + std::to_string(most_shared_) +
                    " places that they share: keep everything else still, and move it slowly");
    }

    const SeenPlaces& seen_;
    std::span<const std::string> names_;
    std::size_t most_shared_ = 0;
    bool straight_ = false;
};

/// Where all cameras have a place, by least squares.
Vec3d common_place(const SeenPlaces& seen, const Chain& chain, std::size_t k, int& count) {
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Vec3d g = Vec3d::Zero();
    count = 0;
    for (std::size_t c = 0; c < seen.size(); ++c) {
        if (!seen[c][k] || chain.used_[c][k] == 0) continue;
        const Eigen::Matrix3d weight = information(*seen[c][k], chain.poses_[c]);
        h += weight;
        g += weight * (chain.poses_[c] * seen[c][k]->point);
        ++count;
    }
    return count > 0 ? Vec3d(h.ldlt().solve(g)) : Vec3d::Zero();
}

/// Gauss-Newton over all cameras but the first; places are eliminated: each residual is to where
/// the others, by their weights, have the place.
void adjust(const SeenPlaces& seen, Chain& chain) {
    constexpr int kRounds = 15;
    const auto n = static_cast<Eigen::Index>(6 * seen.size());
    for (int round = 0; round < kRounds; ++round) {
        // Schur complement: camera blocks less what the place's three unknowns take.
        Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
        for (std::size_t k = 0; k < seen[0].size(); ++k) {
            int count = 0;
            const Vec3d place = common_place(seen, chain, k, count);
            if (count < 2) continue;
            struct Term {
                Eigen::Index at;
                Eigen::Matrix<double, 3, 6> jacobian;
                Eigen::Matrix3d weight;
                Vec3d off;
            };
            std::vector<Term> terms;
            Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
            Vec3d own_g = Vec3d::Zero();
            for (std::size_t c = 0; c < seen.size(); ++c) {
                if (!seen[c][k] || chain.used_[c][k] == 0) continue;
                const Vec3d p = chain.poses_[c] * seen[c][k]->point;
                Term term;
                term.at = static_cast<Eigen::Index>(6 * c);
                term.jacobian << 0, p.z(), -p.y(), 1, 0, 0, -p.z(), 0, p.x(), 0, 1, 0, p.y(),
                    -p.x(), 0, 0, 0, 1;
                term.off = p - place;
                term.weight = information(*seen[c][k], chain.poses_[c]);
                const double pull = std::sqrt(term.off.dot(term.weight * term.off));
                term.weight *= std::min(1.0, 3.0 / std::max(1e-9, pull));
                own += term.weight;
                own_g += term.weight * term.off;
                terms.push_back(term);
            }
            const Eigen::Matrix3d inverse = own.inverse();
            for (const Term& a : terms) {
                const Eigen::Matrix<double, 6, 3> ja = a.jacobian.transpose() * a.weight;
                g.segment<6>(a.at) += ja * (a.off - inverse * own_g);
                h.block<6, 6>(a.at, a.at) += ja * a.jacobian;
                for (const Term& b : terms)
                    h.block<6, 6>(a.at, b.at) -= ja * inverse * b.weight * b.jacobian;
            }
        }
        h.topLeftCorner<6, 6>().diagonal().array() += 1e12; // the first camera stays
        h.diagonal().array() += 1e-9 * h.diagonal().tail(n - 6).mean();
        const Eigen::VectorXd step = -h.ldlt().solve(g);
        if (!step.allFinite()) return;
        for (std::size_t c = 1; c < seen.size(); ++c) {
            const auto s = step.segment<6>(static_cast<Eigen::Index>(6 * c));
            Pose move = Pose::Identity();
            const double angle = s.head<3>().norm();
            if (angle > 1e-12)
                move.linear() =
                    Eigen::AngleAxisd(angle, Vec3d(s.head<3>()) / angle).toRotationMatrix();
            move.translation() = s.tail<3>();
            chain.poses_[c] = move * chain.poses_[c];
            chain.poses_[c].linear() =
                Eigen::Quaterniond(chain.poses_[c].linear()).normalized().toRotationMatrix();
        }
        if (step.lpNorm<Eigen::Infinity>() < 1e-7) return;
    }
}

/// Once all are placed, every sighting that agrees counts, also of cameras that were not chained.
void use_all_that_agree(const SeenPlaces& seen, Chain& chain) {
    for (std::size_t k = 0; k < seen[0].size(); ++k) {
        int count = 0;
        const Vec3d place = common_place(seen, chain, k, count);
        if (count == 0) continue;
        for (std::size_t c = 0; c < seen.size(); ++c)
            if (seen[c][k])
                chain.used_[c][k] =
                    (chain.poses_[c] * seen[c][k]->point - place).norm() < kReach_m ? 1 : 0;
    }
}

} // namespace

SolvedRig solve_rig(const SeenPlaces& seen, std::span<const std::string> names) {
    if (seen.size() < 2) throw Error("a single camera needs no calibration to others: name more");
    Chain chain(seen, names);
    for (int round = 0; round < 2; ++round) {
        adjust(seen, chain);
        use_all_that_agree(seen, chain);
    }
    adjust(seen, chain);
    SolvedRig out;
    out.first_from_camera = chain.poses_;
    for (std::size_t c = 0; c < seen.size(); ++c) {
        double square = 0.0;
        std::size_t places = 0;
        for (std::size_t k = 0; k < seen[c].size(); ++k) {
            int count = 0;
            const Vec3d place = common_place(seen, chain, k, count);
            if (count < 2 || !seen[c][k] || chain.used_[c][k] == 0) continue;
            square += (chain.poses_[c] * seen[c][k]->point - place).squaredNorm();
            ++places;
        }
        out.places.push_back(places);
        out.rms_m.push_back(places > 0 ? std::sqrt(square / static_cast<double>(places)) : 0.0);
    }
    return out;
}

} // namespace toile::scan
