#include "bullet_cloth/link_solver.h"

#include <algorithm>
#include <numeric>

// Bullet's headers do not compile cleanly under our warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wextra"
#include <BulletSoftBody/btSoftBody.h>
#pragma GCC diagnostic pop

namespace toile::bullet_cloth {

static_assert(sizeof(btScalar) == sizeof(float),
              "bullet_cloth is built against the float Bullet; two precisions are installed");

namespace {

struct Link {
    std::uint32_t a, b; ///< nodes, a < b
    const Spring* spring;
};

/// Keeps links that share a node a few places apart, so that the processor need not wait for one
/// before it begins the next; otherwise nearly the given order.
std::vector<Link> interleave(std::span<const Link> links) {
    constexpr std::size_t kApart = 6;
    constexpr std::size_t kWindow = 96;
    std::vector<Link> waiting;
    std::vector<Link> order;
    order.reserve(links.size());
    std::size_t taken = 0;
    const auto waits = [&](const Link& link) {
        const std::size_t recent = std::min(kApart, order.size());
        return std::any_of(order.end() - static_cast<std::ptrdiff_t>(recent), order.end(),
                           [&](const Link& other) {
                               return link.a == other.a || link.a == other.b || link.b == other.a ||
                                      link.b == other.b;
                           });
    };
    while (order.size() < links.size()) {
        while (waiting.size() < kWindow && taken < links.size()) {
            waiting.push_back(links[taken++]);
        }
        auto next = std::find_if_not(waiting.begin(), waiting.end(), waits);
        next = next == waiting.end() ? waiting.begin() : next;
        order.push_back(*next);
        waiting.erase(next);
    }
    return order;
}

} // namespace

struct LinkSolver::Impl {
    btSoftBodyWorldInfo world;
    std::unique_ptr<btSoftBody> body;
    std::vector<std::uint32_t> vertex_of_node; ///< nodes run from the top of the garment down
    std::vector<float> inverse_stiffness;      ///< (links) m/N
    float substep = 0.0f;
};

LinkSolver::LinkSolver(std::span<const Vec3f> start, std::span<const float> inverse_mass,
                       std::span<const Spring> stretch, std::span<const Spring> bend)
    : impl_(std::make_unique<Impl>()) {
    const std::size_t count = start.size();
    impl_->vertex_of_node.resize(count);
    std::iota(impl_->vertex_of_node.begin(), impl_->vertex_of_node.end(), 0u);
    std::stable_sort(impl_->vertex_of_node.begin(), impl_->vertex_of_node.end(),
                     [&](std::uint32_t l, std::uint32_t r) { return start[l].y() > start[r].y(); });
    std::vector<std::uint32_t> node_of_vertex(count);
    std::vector<btVector3> positions(count);
    std::vector<btScalar> masses(count);
    for (std::size_t n = 0; n < count; ++n) {
        const std::uint32_t v = impl_->vertex_of_node[n];
        node_of_vertex[v] = static_cast<std::uint32_t>(n);
        positions[n] = btVector3(start[v].x(), start[v].y(), start[v].z());
        masses[n] = inverse_mass[v] > 0.0f ? 1.0f / inverse_mass[v] : 0.0f;
    }
    impl_->body = std::make_unique<btSoftBody>(&impl_->world, static_cast<int>(count),
                                               positions.data(), masses.data());
    std::vector<Link> links;
    for (const std::span<const Spring> springs : {bend, stretch}) {
        for (const Spring& spring : springs) {
            const bool moves = inverse_mass[spring.a] > 0.0f || inverse_mass[spring.b] > 0.0f;
            if (moves && spring.stiffness > 0.0f) {
                const auto [a, b] = std::minmax(node_of_vertex[spring.a], node_of_vertex[spring.b]);
                links.push_back({a, b, &spring});
            }
        }
    }
    std::stable_sort(links.begin(), links.end(), [](const Link& l, const Link& r) {
        return l.a != r.a ? l.a < r.a : l.b < r.b;
    });
    impl_->body->m_links.reserve(static_cast<int>(links.size()));
    for (const Link& link : interleave(links)) {
        impl_->body->appendLink(static_cast<int>(link.a), static_cast<int>(link.b));
        btSoftBody::Link& made = impl_->body->m_links[impl_->body->m_links.size() - 1];
        made.m_rl = link.spring->rest;
        made.m_c1 = link.spring->rest * link.spring->rest;
        impl_->inverse_stiffness.push_back(1.0f / link.spring->stiffness);
    }
}

LinkSolver::~LinkSolver() = default;
LinkSolver::LinkSolver(LinkSolver&&) noexcept = default;
LinkSolver& LinkSolver::operator=(LinkSolver&&) noexcept = default;

void LinkSolver::set_substep(float seconds) noexcept {
    if (seconds == impl_->substep) {
        return;
    }
    impl_->substep = seconds;
    const float per_square = 1.0f / (seconds * seconds);
    for (int i = 0; i < impl_->body->m_links.size(); ++i) {
        btSoftBody::Link& link = impl_->body->m_links[i];
        link.m_c0 = link.m_n[0]->m_im + link.m_n[1]->m_im +
                    impl_->inverse_stiffness[static_cast<std::size_t>(i)] * per_square;
    }
}

void LinkSolver::solve(std::span<Vec4> positions) noexcept {
    btSoftBody& body = *impl_->body;
    for (std::size_t n = 0; n < positions.size(); ++n) {
        const Vec4& p = positions[impl_->vertex_of_node[n]];
        body.m_nodes[static_cast<int>(n)].m_x.setValue(p.x(), p.y(), p.z());
    }
    btSoftBody::PSolve_Links(&body, 1.0f, 0.0f);
    for (std::size_t n = 0; n < positions.size(); ++n) {
        const btVector3& x = body.m_nodes[static_cast<int>(n)].m_x;
        positions[impl_->vertex_of_node[n]] = Vec4(x.x(), x.y(), x.z(), 0.0f);
    }
}

std::size_t LinkSolver::link_count() const noexcept {
    return static_cast<std::size_t>(impl_->body->m_links.size());
}

} // namespace toile::bullet_cloth
