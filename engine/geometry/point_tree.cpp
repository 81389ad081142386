#include "geometry/point_tree.h"

#include "core/error.h"

#include <memory>
#include <nanoflann.hpp>

namespace toile::geometry {

struct PointTree::Tree {
    using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Tree>,
                                                      Tree, 3, std::uint32_t>;

    explicit Tree(std::span<const Vec3f> given) : points(given.begin(), given.end()) {
        if (points.empty()) throw Error("a search among no points");
        for (const Vec3f& p : points)
            if (!p.allFinite()) throw Error("a point that is not finite");
        index = std::make_unique<Index>(3, *this);
    }

    // What nanoflann asks for.
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return points[i][static_cast<int>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }

    std::vector<Vec3f> points;
    std::unique_ptr<Index> index;
};

PointTree::PointTree(std::span<const Vec3f> points) : tree_(std::make_unique<Tree>(points)) {}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

PointTree::Neighbour PointTree::nearest(const Vec3f& point) const {
    std::uint32_t index = 0;
    float squared = 0.0f;
    tree_->index->knnSearch(point.data(), 1, &index, &squared);
    return {static_cast<std::uint32_t>(index), squared};
}

std::vector<PointTree::Neighbour> PointTree::nearest(const Vec3f& point, std::size_t count) const {
    std::vector<std::uint32_t> indices(count);
    std::vector<float> squared(count);
    const std::size_t found =
        tree_->index->knnSearch(point.data(), count, indices.data(), squared.data());
    std::vector<Neighbour> out(found);
    for (std::size_t i = 0; i < found; ++i)
        out[i] = {static_cast<std::uint32_t>(indices[i]), squared[i]};
    return out;
}

std::span<const Vec3f> PointTree::points() const noexcept {
    return tree_->points;
}

} // namespace toile::geometry
