#include "scan/joint_warp.h"

#include "scan/normal_equations.h"

namespace toile::scan {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// A symmetric matrix over the nodes of one view: a block for each link of the graph.
struct LinkMatrix {
    std::vector<Matrix6> blocks;

    explicit LinkMatrix(std::size_t links) : blocks(links, Matrix6::Zero()) {}
    LinkMatrix& operator+=(const LinkMatrix& b) {
        for (std::size_t l = 0; l < blocks.size(); ++l)
            blocks[l] += b.blocks[l];
        return *this;
    }
    /// out += sign * this * x
    void multiply(const DeformationGraph& graph, const double* x, double sign, double* out) const {
        for (std::size_t l = 0; l < blocks.size(); ++l) {
            const auto [a, b] = graph.links()[l];
            const Eigen::Map<const Vector6> xa(x + 6 * a), xb(x + 6 * b);
            Eigen::Map<Vector6> ya(out + 6 * a), yb(out + 6 * b);
            ya += sign * (blocks[l] * xb);
            if (a != b) yb += sign * (blocks[l].transpose() * xa);
        }
    }
};

/// What the readings of a pair of views say of their difference.
struct PairSums {
    LinkMatrix h;
    VectorXd g;
    double square = 0.0, weight = 0.0;
    std::size_t pairs = 0, readings = 0;

    explicit PairSums(const DeformationGraph& graph)
        : h(graph.links().size()), g(VectorXd::Zero(static_cast<Index>(6 * graph.nodes().size()))) {
    }
};

Vec3d rotation_vector(const Pose& pose) {
    const Eigen::AngleAxisd axis(pose.linear());
    return axis.angle() * axis.axis();
}

void add(const DeformationGraph& graph, const NodeBinding& binding, const Vec3f& point,
         const Vec3f& normal, double residual, double weight, PairSums& sums) {
    std::array<Vector6, NodeBinding::kMost> rows;
    int count = 0;
    while (count < NodeBinding::kMost && binding.weights[static_cast<std::size_t>(count)] > 0.01f) {
        const auto k = static_cast<std::size_t>(count++);
        const Vec3f arm = point - graph.nodes()[binding.nodes[k]];
        rows[k] << arm.cross(normal).cast<double>(), normal.cast<double>();
        rows[k] *= static_cast<double>(binding.weights[k]);
        sums.g.segment<6>(6 * binding.nodes[k]) += weight * residual * rows[k];
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
        for (std::size_t l = 0; l < static_cast<std::size_t>(count); ++l) {
            // Each link once, from its lower node.
            if (binding.nodes[k] > binding.nodes[l]) continue;
            const int link = graph.link(binding.nodes[k], binding.nodes[l]);
            if (link >= 0)
                sums.h.blocks[static_cast<std::size_t>(link)] +=
                    weight * rows[k] * rows[l].transpose();
        }
    sums.square += weight * residual * residual;
    sums.weight += weight;
    ++sums.pairs;
}

/// Readings of `from`, where `to` saw the same place; sign: +1 when `from` is the pair's first.
void add_readings(const DeformationGraph& graph, const WarpedView& from,
                  const PreparedView& from_at, const WarpedView& to, const PreparedView& to_at,
                  const JointWarpOptions& options, double sign, PairSums& sums) {
    const float least_cosine = std::cos(options.angle), reach = options.reach_m * options.reach_m;
    const Window& camera = from.view.camera;
    for (int y = options.stride / 2; y < camera.height; y += options.stride)
        for (int x = options.stride / 2; x < camera.width; x += options.stride) {
            const std::size_t i = camera.at(x, y);
            const Vec3f& p = from_at.pulled.points[i];
            if (!(p.x() == p.x())) continue;
            ++sums.readings;
            const NodeBinding& binding = from.bindings[i];
            std::size_t j = 0;
            if (!find_partner(binding, p, to, to_at, j)) continue;
            const Vec3f& q = to_at.pulled.points[j];
            const Vec3f &n = from_at.pulled.normals[i], &m = to_at.pulled.normals[j];
            if ((p - q).squaredNorm() > reach || n.dot(m) < least_cosine) continue;
            const Vec3f normal = (n + m).normalized();
            const auto residual = static_cast<double>(normal.dot(p - q));
            const double weight =
                std::sqrt(static_cast<double>(from.view.weight[i] * to.view.weight[j])) *
                std::min(1.0, options.huber_m / std::max(1e-12, std::abs(residual)));
            add(graph, binding, p, normal, sign * residual, weight, sums);
        }
}

/// The whole system.
class System {
  public:
    System(const DeformationGraph& graph, std::span<const ViewPair> pairs,
           const JointWarpOptions& options, const RowLoop& rows)
        : graph_(graph), pairs_(pairs), options_(options), rows_(rows),
          size_(static_cast<Index>(6 * graph.nodes().size())) {}

    void collect(const std::vector<WarpedView>& views);
    void regularise(const std::vector<WarpedView>& views);
    [[nodiscard]] std::vector<VectorXd> solved();
    [[nodiscard]] JointWarpRound told() const;

  private:
    struct Neighbour {
        std::size_t pair = 0, view = 0;
    };
    /// What a node's readings weigh on average; the other terms are shares of it.
    [[nodiscard]] double scale() const { return scale_; }
    void add_smoothness(const WarpedView& view, std::size_t at);
    void add_steadiness(const std::vector<WarpedView>& views);
    void multiply(const std::vector<VectorXd>& x, std::vector<VectorXd>& out) const;
    [[nodiscard]] Eigen::MatrixXd dense(const LinkMatrix& from) const;
    void each_view(const std::function<void(std::size_t)>& work) const {
        rows_(static_cast<std::uint32_t>(own_.size()), 1,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t i = begin; i < end; ++i)
                      work(i);
              });
    }

    const DeformationGraph& graph_;
    std::span<const ViewPair> pairs_;
    const JointWarpOptions& options_;
    const RowLoop& rows_;
    Index size_;
    double scale_ = 1.0;
    std::vector<PairSums> sums_;                 ///< (pairs)
    std::vector<LinkMatrix> own_;                ///< (views) all of a view's own
    std::vector<VectorXd> g_;                    ///< (views)
    std::vector<std::vector<Neighbour>> around_; ///< (views)
};

void System::collect(const std::vector<WarpedView>& views) {
    std::vector<PreparedView> at(views.size());
    own_.assign(views.size(), LinkMatrix(graph_.links().size()));
    each_view([&](std::size_t i) { at[i] = prepared(views[i]); });
    sums_.assign(pairs_.size(), PairSums(graph_));
    rows_(static_cast<std::uint32_t>(pairs_.size()), 1,
          [&](std::uint32_t begin, std::uint32_t end) {
              for (std::uint32_t k = begin; k < end; ++k) {
                  const auto [a, b] = pairs_[k];
                  add_readings(graph_, views[a], at[a], views[b], at[b], options_, 1.0, sums_[k]);
                  add_readings(graph_, views[b], at[b], views[a], at[a], options_, -1.0, sums_[k]);
              }
          });
    double weight = 0.0;
    for (const PairSums& sums : sums_)
        weight += 2.0 * sums.weight; // of either view
    scale_ = std::max(1e-3, weight / static_cast<double>(views.size() * graph_.nodes().size()));
    g_.assign(views.size(), VectorXd::Zero(size_));
    around_.assign(views.size(), {});
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
        const auto [a, b] = pairs_[k];
        own_[a] += sums_[k].h;
        own_[b] += sums_[k].h;
        g_[a] += sums_[k].g;
        g_[b] -= sums_[k].g;
        around_[a].push_back({k, b});
        around_[b].push_back({k, a});
    }
}

/// Neighbouring nodes move each other's places to the same.
void System::add_smoothness(const WarpedView& view, std::size_t at) {
    const double weight = options_.smoothness * scale();
    for (std::size_t l = 0; l < graph_.links().size(); ++l) {
        const auto [a, b] = graph_.links()[l];
        if (a == b) continue;
        const Vec3d va = graph_.nodes()[a].cast<double>(), vb = graph_.nodes()[b].cast<double>();
        for (const Vec3d& place : {va, vb}) {
            const Vec3d pa = view.moved[a] * place, pb = view.moved[b] * place;
            const Vec3d residual = pa - pb;
            Eigen::Matrix<double, 3, 6> ja, jb;
            const auto cross = [](const Vec3d& v) {
                Eigen::Matrix3d out;
                out << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
                return out;
            };
            ja << -cross(pa - va), Eigen::Matrix3d::Identity();
            jb << cross(pb - vb), -Eigen::Matrix3d::Identity();
            auto& blocks = own_[at].blocks;
            blocks[static_cast<std::size_t>(graph_.link(a, a))] += weight * ja.transpose() * ja;
            blocks[static_cast<std::size_t>(graph_.link(b, b))] += weight * jb.transpose() * jb;
            blocks[l] += weight * ja.transpose() * jb; // links go from the lower node
            g_[at].segment<6>(6 * a) += weight * ja.transpose() * residual;
            g_[at].segment<6>(6 * b) += weight * jb.transpose() * residual;
        }
    }
}

/// How much a unit of each kind of unknown counts: 10 cm of arm for a turn.
constexpr double kTurnArm_m = 0.1;

void System::add_steadiness(const std::vector<WarpedView>& views) {
    const double weight = options_.steadiness * scale();
    Vector6 kinds;
    kinds << Vec3d::Constant(weight * kTurnArm_m * kTurnArm_m), Vec3d::Constant(weight);
    const auto state = [&](std::size_t view, std::size_t n) {
        const Vec3d v = graph_.nodes()[n].cast<double>();
        Vector6 out;
        out << rotation_vector(views[view].moved[n]), views[view].moved[n] * v - v;
        return out;
    };
    const double trusted = options_.trust / std::max(1e-12, options_.steadiness);
    for (std::size_t i = 0; i < views.size(); ++i)
        for (std::size_t n = 0; n < graph_.nodes().size(); ++n) {
            const auto own = static_cast<std::size_t>(
                graph_.link(static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(n)));
            const auto at = static_cast<Index>(6 * n);
            const Vector6 here = state(i, n);
            own_[i].blocks[own].diagonal() += trusted * kinds;
            g_[i].segment<6>(at) += trusted * kinds.cwiseProduct(here);
            if (i + 1 >= views.size()) continue;
            const Vector6 change = kinds.cwiseProduct(here - state(i + 1, n));
            own_[i].blocks[own].diagonal() += kinds;
            own_[i + 1].blocks[own].diagonal() += kinds;
            g_[i].segment<6>(at) += change;
            g_[i + 1].segment<6>(at) -= change;
        }
}

void System::regularise(const std::vector<WarpedView>& views) {
    each_view([&](std::size_t i) { add_smoothness(views[i], i); });
    add_steadiness(views);
}

void System::multiply(const std::vector<VectorXd>& x, std::vector<VectorXd>& out) const {
    Vector6 kinds;
    const double weight = options_.steadiness * scale();
    kinds << Vec3d::Constant(weight * kTurnArm_m * kTurnArm_m), Vec3d::Constant(weight);
    const VectorXd steady = kinds.replicate(size_ / 6, 1);
    each_view([&](std::size_t i) {
        out[i].setZero();
        if (i == 0) return; // the first view stays
        own_[i].multiply(graph_, x[i].data(), 1.0, out[i].data());
        for (const Neighbour& b : around_[i])
            if (b.view != 0)
                sums_[b.pair].h.multiply(graph_, x[b.view].data(), -1.0, out[i].data());
        if (i > 1) out[i] -= steady.cwiseProduct(x[i - 1]);
        if (i + 1 < x.size()) out[i] -= steady.cwiseProduct(x[i + 1]);
    });
}

Eigen::MatrixXd System::dense(const LinkMatrix& from) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size_, size_);
    for (std::size_t l = 0; l < from.blocks.size(); ++l) {
        const auto [a, b] = graph_.links()[l];
        out.block<6, 6>(6 * b, 6 * a) = from.blocks[l].transpose();
        if (a == b) out.block<6, 6>(6 * a, 6 * a) = from.blocks[l];
    }
    return out;
}

/// Conjugate gradients, preconditioned by each view's own matrix.
std::vector<VectorXd> System::solved() {
    constexpr int kMostRounds = 60;
    const std::size_t count = own_.size();
    std::vector<Eigen::LLT<Eigen::MatrixXd>> factors(count);
    each_view([&](std::size_t i) {
        if (i > 0) factors[i].compute(dense(own_[i]));
    });
    std::vector<VectorXd> x(count, VectorXd::Zero(size_)), r = x, z = x, p = x, ap = x;
    const auto dot = [&](const std::vector<VectorXd>& a, const std::vector<VectorXd>& b) {
        double sum = 0.0;
        for (std::size_t i = 1; i < count; ++i)
            sum += a[i].dot(b[i]);
        return sum;
    };
    const auto precondition = [&] {
        each_view([&](std::size_t i) {
            if (i > 0) z[i] = factors[i].solve(r[i]);
        });
    };
    for (std::size_t i = 1; i < count; ++i)
        r[i] = -g_[i];
    precondition();
    p = z;
    double before = dot(r, z);
    const double enough = 1e-8 * before;
    for (int round = 0; round < kMostRounds && before > enough; ++round) {
        multiply(p, ap);
        const double along = dot(p, ap);
        if (!(along > 0.0)) break;
        const double step = before / along;
        for (std::size_t i = 1; i < count; ++i) {
            x[i] += step * p[i];
            r[i] -= step * ap[i];
        }
        precondition();
        const double now = dot(r, z);
        for (std::size_t i = 1; i < count; ++i)
            p[i] = z[i] + (now / before) * p[i];
        before = now;
    }
    return x;
}

JointWarpRound System::told() const {
    JointWarpRound out;
    double square = 0.0, weight = 0.0;
    std::size_t readings = 0;
    for (const PairSums& s : sums_) {
        square += s.square;
        weight += s.weight;
        out.pairs += s.pairs;
        readings += s.readings;
    }
    out.rms_m = weight > 0.0 ? std::sqrt(square / weight) : 0.0;
    out.overlap =
        readings > 0 ? static_cast<double>(out.pairs) / static_cast<double>(readings) : 0.0;
    return out;
}

} // namespace

JointWarpRound warp_jointly(const DeformationGraph& graph, std::span<const ViewPair> pairs,
                            const JointWarpOptions& options, std::vector<WarpedView>& views,
                            const RowLoop& rows) {
    System system(graph, pairs, options, rows);
    system.collect(views);
    system.regularise(views);
    const std::vector<VectorXd> steps = system.solved();
    JointWarpRound out = system.told();
    for (std::size_t i = 1; i < views.size(); ++i) {
        if (!steps[i].allFinite()) continue;
        for (std::size_t n = 0; n < graph.nodes().size(); ++n) {
            const Vector6 step = steps[i].segment<6>(static_cast<Index>(6 * n));
            out.step_m = std::max(out.step_m, step.tail<3>().norm());
            views[i].moved[n] =
                moved(motion_about(graph.nodes()[n].cast<double>(), step), views[i].moved[n]);
        }
        views[i].update_motions();
    }
    return out;
}

} // namespace toile::scan
