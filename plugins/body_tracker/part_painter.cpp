#include "body_tracker/part_painter.h"

#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

constexpr float kSameSurface = 0.10f; // metres between body and reading
constexpr float kSameCell = 0.08f;    // and between a pixel and its cell
constexpr int kBesideBody = 4;        // cells that a body may be off
constexpr std::uint8_t kNone = 0;

} // namespace

PartPainter::PartPainter(const TrackedBody& body, const Forest* forest,
                         const imaging::Intrinsics& camera)
    : forest_(forest) {
    const std::vector<body::Part>& parts = body.model().space().model().parts;
    const std::vector<std::uint32_t>& vertices = body.level().vertices;
    for (const Triangle& t : body.level().triangles) {
        // Two of three corners decide.
        const auto part = [&](std::size_t k) { return parts[vertices[t[k]]]; };
        triangle_part_.push_back(static_cast<std::uint8_t>(part(1) == part(2) ? part(1) : part(0)));
    }
    const DepthReducer reducer(camera);
    const GridCamera& grid = reducer.grid();
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const auto ray = imaging::unproject(camera, Eigen::Vector2d(x, y), 1.0);
            std::int32_t cell = -1;
            if (ray) {
                const Vec2f at = grid.cell(ray->cast<float>());
                const auto column = static_cast<int>(std::lround(at.x()));
                const auto row = static_cast<int>(std::lround(at.y()));
                if (column >= 0 && row >= 0 && column < grid.width && row < grid.height)
                    cell = row * grid.width + column;
            }
            cell_of_.push_back(cell);
        }
    part_.assign(grid.size(), kNone);
    person_.assign(grid.size(), kNone);
    mm_.assign(grid.size(), 0);
}

/// Of the body there, or of what of it is nearest and about as deep.
std::uint8_t PartPainter::drawn_part(const DepthGrid& grid, const Drawing& drawing,
                                     int cell) const noexcept {
    const int x = cell % grid.camera.width, y = cell / grid.camera.width;
    const float depth = grid.depth[static_cast<std::size_t>(cell)];
    float best = 1e9f;
    std::uint8_t out = kNone;
    for (int dy = -kBesideBody; dy <= kBesideBody; ++dy)
        for (int dx = -kBesideBody; dx <= kBesideBody; ++dx) {
            const int nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= grid.camera.width || ny >= grid.camera.height) continue;
            const DrawnCell& drawn =
                drawing.cells[static_cast<std::size_t>(ny * grid.camera.width + nx)];
            if (drawn.depth == 0.0f || std::abs(drawn.depth - depth) > kSameSurface) continue;
            const float across = grid.camera.footprint(depth);
            const float off = across * across * static_cast<float>(dx * dx + dy * dy) +
                              (drawn.depth - depth) * (drawn.depth - depth);
            if (off >= best) continue;
            best = off;
            out = triangle_part_[static_cast<std::size_t>(drawn.triangle)];
        }
    return out;
}

std::uint8_t PartPainter::forest_part(const GridCamera& camera, int cell) noexcept {
    if (forest_ == nullptr) return kNone;
    const DepthView view{camera.width, camera.height, camera.fx, mm_.data()};
    std::array<std::uint16_t, kPartCount> sums{};
    classify(*forest_, view, cell % camera.width, cell / camera.width, sums);
    // Parts of one of P4's count together.
    std::array<std::uint32_t, 13> shares{};
    for (std::size_t c = 0; c < sums.size(); ++c)
        shares[static_cast<std::size_t>(p4_part(static_cast<PartLabel>(c + 1)))] += sums[c];
    return static_cast<std::uint8_t>(std::max_element(shares.begin() + 1, shares.end()) -
                                     shares.begin());
}

void PartPainter::label_cells(const DepthGrid& grid, const PersonTrack& person,
                              std::uint8_t number) noexcept {
    const PersonMask& mask = person.mask();
    for (std::size_t i = 0; i < mm_.size(); ++i)
        mm_[i] = mask.cells[i] != 0
                     ? static_cast<std::uint16_t>(std::lround(1000.0f * grid.depth[i]))
                     : std::uint16_t{0};
    const bool known = person.following() == Following::tracked;
    for (std::size_t i = 0; i < mm_.size(); ++i) {
        if (mm_[i] == 0) continue;
        const auto cell = static_cast<int>(i);
        const Drawing& drawing = person.registration().drawing();
        std::uint8_t part = known ? drawn_part(grid, drawing, cell) : kNone;
        if (part == kNone) part = forest_part(grid.camera, cell);
        if (part == kNone && !known) part = drawn_part(grid, drawing, cell);
        part_[i] = part;
        person_[i] = part == kNone ? kNone : number;
    }
}

void PartPainter::paint(const BodyTracking& tracking, std::span<const float> metres,
                        std::span<std::uint8_t> parts, std::span<std::uint8_t> people) noexcept {
    const DepthGrid& grid = tracking.grid();
    std::fill(part_.begin(), part_.end(), kNone);
    std::fill(person_.begin(), person_.end(), kNone);
    std::uint8_t number = 0;
    for (const auto& person : tracking.people()) {
        if (!person->active()) continue;
        ++number; // as the people are told
        if (person->following() != Following::lost) label_cells(grid, *person, number);
    }
    std::fill(parts.begin(), parts.end(), kNone);
    std::fill(people.begin(), people.end(), kNone);
    const int w = grid.camera.width, h = grid.camera.height;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const float depth = metres[i];
        if (cell_of_[i] < 0 || !(depth > 0.0f)) continue;
        const int x = cell_of_[i] % w, y = cell_of_[i] / w;
        // Its own cell, or at an outline the one beside whose surface it is of.
        float best = kSameCell;
        for (int n = 0; n < 9; ++n) {
            const int k = (n + 4) % 9; // the middle first
            const int nx = x + k % 3 - 1, ny = y + k / 3 - 1;
            if (nx < 0 || ny < 0 || nx >= w || ny >= h) continue;
            const auto cell = static_cast<std::size_t>(ny * w + nx);
            const float off = std::abs(grid.depth[cell] - depth);
            if (part_[cell] == kNone || off >= best) continue;
            best = off;
            parts[i] = part_[cell];
            if (!people.empty()) people[i] = person_[cell];
            if (n == 0) break;
        }
    }
}

} // namespace toile::body_tracker
