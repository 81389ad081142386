#include "body_tracker/registration.h"

#include "body/rotations.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

using body::kJointCount;

constexpr float kLeastCosine = 0.2f;     // between surface and line of sight
constexpr float kBehind = 0.10f;         // metres: what lies so far behind the body is not it
constexpr float kExplained = 0.06f;      // metres (P5 3.6)
constexpr float kCloth = 0.06f;          // metres that cloth hangs beside the body
constexpr float kSlackCells = 1.2f;      // an outline is not known better
constexpr float kShapeSlackCells = 0.6f; // but over many frames
constexpr double kMostTurn = 0.4;        // radians a step
constexpr double kMostShift = 0.25;      // metres a step
constexpr float kFloorDeviation = 0.01f;
constexpr float kStandsBelow = 0.10f, kStandsScale = 0.04f; // metres above the floor
constexpr float kSoleInformation = 2000.0f;                 // 1/m^2
constexpr std::size_t kExtraEvery = 2;                      // every n-th cell is enough

float geman_mcclure(float distance, float scale) noexcept {
    const float s = scale * scale;
    const float root = s / (s + distance * distance);
    return root * root;
}

} // namespace

Registration::Registration(const TrackedBody& body, const GridCamera& camera)
    : body_(body), camera_(camera), prior_(body.model().space().model().skeleton),
      posed_(body.blank()), drawing_(body.blank_drawing(camera)), factor_(kUnknowns) {
    const std::size_t n = posed_.positions.size();
    visible_.reserve(n);
    for (auto* row : {&seen_x_, &seen_y_, &seen_z_})
        row->reserve(n);
    constexpr std::array kSoles{body::Joint::left_foot, body::Joint::left_toes,
                                body::Joint::right_foot, body::Joint::right_toes};
    const body::SkinWeights& skin = body_.level().skin;
    for (std::uint32_t v = 0; v < n; ++v)
        for (std::size_t s = 0; s < kSoles.size(); ++s)
            for (std::size_t k = 0; k < 4; ++k)
                if (skin.joints[v][k] == static_cast<std::size_t>(kSoles[s]) &&
                    skin.weights[v][k] > 0.5f)
                    soles_[s].push_back(v);
    normal_.resize(kUnknowns, kUnknowns);
    gradient_.resize(kUnknowns);
    move_.resize(kUnknowns);
}

Registration::Place Registration::place_of(const DrawnCell& cell) const noexcept {
    Place out;
    out.triangle = cell.triangle;
    out.weights = {1.0f - cell.b1 - cell.b2, cell.b1, cell.b2};
    const Triangle& t = body_.level().triangles[static_cast<std::size_t>(cell.triangle)];
    for (std::size_t k = 0; k < 3; ++k) {
        out.position += out.weights[k] * posed_.positions[t[k]];
        out.normal += out.weights[k] * posed_.normals[t[k]];
    }
    out.normal.normalize();
    return out;
}

void Registration::draw_pose(const body::Pose& pose) noexcept {
    body_.pose(pose, posed_);
    body_.draw(posed_, camera_, drawing_);
}

void Registration::add_row(std::int32_t triangle, const std::array<float, 3>& weights,
                           const Vec3f& at, const Vec3f& along, float residual,
                           float weight) noexcept {
    if (recording_) {
        rows_.push_back({triangle, weights, at, along, residual, weight});
        return;
    }
    PlaceMotion motion;
    body_.motion(posed_, triangle, weights, at, along, motion);
    for (std::size_t a = 0; a < static_cast<std::size_t>(motion.count); ++a) {
        const Vec3f scaled = weight * motion.block[a];
        const int row = motion.start[a];
        for (std::size_t b = 0; b <= a; ++b) {
            const Vec3f& other = motion.block[b];
            float* to = sums_.data() + row * kStride + motion.start[b];
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k < 3; ++k)
                    to[i * kStride + k] += scaled[i] * other[k];
        }
        for (int i = 0; i < 3; ++i)
            sum_[static_cast<std::size_t>(row + i)] += scaled[i] * residual;
    }
}

/// A whole vertex.
void Registration::add_vertex(std::uint32_t vertex, const Vec3f& along, float residual,
                              float weight) noexcept {
    const std::int32_t corner = body_.corner_of(vertex);
    add_row(corner / 3, TrackedBody::weights_of(corner), posed_.positions[vertex], along, residual,
            weight);
}

void Registration::add_readings(const SeenPerson& seen,
                                const RegistrationOptions& options) noexcept {
    // Every n-th cell, shifted from row to row; each stands for n.
    const auto every = static_cast<int>(
        std::max<std::size_t>(1, (seen.mask.count + options.most_cells / 2) / options.most_cells));
    const float information = static_cast<float>(every) * options.cell_information /
                              (options.deviation_m * options.deviation_m);
    for (int y = std::max(drawing_.low[1], seen.mask.low[1]);
         y <= std::min(drawing_.high[1], seen.mask.high[1]); ++y)
        for (int x = drawing_.low[0] + (2 * y + every - drawing_.low[0] % every) % every;
             x <= drawing_.high[0]; x += every) {
            const auto i = static_cast<std::size_t>(y * camera_.width + x);
            const DrawnCell& cell = drawing_.cells[i];
            if (cell.depth == 0.0f || seen.mask.cells[i] == 0) continue;
            const float off = cell.depth - seen.grid.depth[i];
            if (std::abs(off) > options.reach_m) continue;
            const Place place = place_of(cell);
            const Vec3f ray = camera_.point(static_cast<float>(x), static_cast<float>(y), 1.0f);
            const float facing = -place.normal.dot(ray) / ray.norm();
            if (facing < kLeastCosine) continue;
            const float residual = place.normal.dot(off * ray);
            add_row(cell.triangle, place.weights, place.position, place.normal, residual,
                    information * geman_mcclure(residual, options.robust_m));
        }
}

/// Vertices that are drawn, not hidden behind another part or a thing before the person.
void Registration::find_visible(const SeenPerson& seen) noexcept {
    visible_.clear();
    seen_x_.clear();
    seen_y_.clear();
    seen_z_.clear();
    for (std::uint32_t v = 0; v < posed_.positions.size(); ++v) {
        const Vec3f& p = posed_.positions[v];
        if (posed_.normals[v].dot(p) > 0.15f * p.norm()) continue;
        const Vec3f& corner = drawing_.corners[v];
        const int x = static_cast<int>(std::lround(corner.x()));
        const int y = static_cast<int>(std::lround(corner.y()));
        if (corner.z() <= 0.0f || x < 0 || y < 0 || x >= camera_.width || y >= camera_.height)
            continue;
        const auto i = static_cast<std::size_t>(y * camera_.width + x);
        const float drawn = drawing_.cells[i].depth;
        if (drawn != 0.0f && -p.z() > drawn + 0.05f) continue;
        const float real = seen.grid.depth[i];
        if (real != 0.0f && seen.mask.cells[i] == 0 && real < -p.z() - 0.05f) continue;
        visible_.push_back(v);
        seen_x_.push_back(p.x());
        seen_y_.push_back(p.y());
        seen_z_.push_back(p.z());
    }
}

void Registration::add_extra(const SeenPerson& seen, const RegistrationOptions& options) noexcept {
    if (visible_.empty()) return;
    const float information = options.extra_weight * options.cell_information *
                              static_cast<float>(kExtraEvery) /
                              (options.deviation_m * options.deviation_m);
    std::size_t number = 0;
    for (int y = seen.mask.low[1]; y <= seen.mask.high[1]; ++y)
        for (int x = seen.mask.low[0]; x <= seen.mask.high[0]; ++x) {
            const auto i = static_cast<std::size_t>(y * camera_.width + x);
            if (seen.mask.cells[i] == 0) continue;
            const float depth = seen.grid.depth[i];
            const DrawnCell& cell = drawing_.cells[i];
            if (cell.depth != 0.0f && std::abs(cell.depth - depth) < options.reach_m) continue;
            if (number++ % kExtraEvery != 0) continue;
            const Vec3f p = camera_.point(static_cast<float>(x), static_cast<float>(y), depth);
            float best = 1e9f;
            std::size_t at = 0;
            for (std::size_t k = 0; k < visible_.size(); ++k) {
                const float dx = seen_x_[k] - p.x(), dy = seen_y_[k] - p.y(),
                            dz = seen_z_[k] - p.z();
                const float squared = dx * dx + dy * dy + dz * dz;
                if (squared < best) best = squared, at = k;
            }
            const float distance = std::sqrt(best);
            const float slack =
                (recording_ ? kShapeSlackCells : kSlackCells) * camera_.footprint(depth);
            if (distance < slack || distance > options.extra_reach_m) continue;
            const std::uint32_t v = visible_[at];
            const Vec3f off = posed_.positions[v] - p;
            const Vec3f way = off / distance;
            const float weight =
                information * geman_mcclure(distance, 0.5f * options.extra_reach_m);
            // Along the way with all weight, across it with none: the nearest place may slide.
            add_vertex(v, way, distance - slack, weight);
        }
}

void Registration::add_outline(const SeenPerson& seen,
                               const RegistrationOptions& options) noexcept {
    const float information = options.outline_weight * options.cell_information /
                              (options.deviation_m * options.deviation_m);
    for (const std::uint32_t v : visible_) {
        const Vec3f& corner = drawing_.corners[v];
        const int x = static_cast<int>(std::lround(corner.x()));
        const int y = static_cast<int>(std::lround(corner.y()));
        const auto i = static_cast<std::size_t>(y * camera_.width + x);
        const float depth = -posed_.positions[v].z();
        const float real = seen.grid.depth[i];
        if (seen.mask.cells[i] != 0 || (real != 0.0f && real < depth + kBehind)) continue;
        const std::int32_t nearest = seen.mask.nearest[i];
        if (nearest < 0) continue;
        const auto nx = static_cast<float>(nearest % camera_.width);
        const auto ny = static_cast<float>(nearest / camera_.width);
        const Vec3f off =
            camera_.point(corner.x(), corner.y(), depth) - camera_.point(nx, ny, depth);
        const float distance = off.norm();
        const float slack =
            (recording_ ? kShapeSlackCells : kSlackCells) * camera_.footprint(depth);
        if (distance < slack) continue;
        const float reach = std::min(distance, options.outline_reach_m);
        // A vertex stands for the cells that its surface fills.
        const float cells =
            body_.level().areas[v] / (camera_.footprint(depth) * camera_.footprint(depth));
        add_vertex(v, off / distance, reach - slack,
                   information * cells * geman_mcclure(reach, 0.5f * options.outline_reach_m));
    }
}

void Registration::add_floor(const SeenPerson& seen) noexcept {
    if (!seen.floor) return;
    const float information = 0.02f / (kFloorDeviation * kFloorDeviation);
    for (std::uint32_t v = 0; v < posed_.positions.size(); ++v) {
        const float height = seen.floor->normal.dot(posed_.positions[v]) - seen.floor->offset;
        if (height >= 0.0f) continue;
        add_vertex(v, seen.floor->normal, std::max(height, -0.1f), information);
    }
}

/// Heels and toes that are hardly above the floor stand on it: what is so low is cut off with it,
/// and trousers hide the ankle.
void Registration::add_soles(const SeenPerson& seen, const RegistrationOptions& options) noexcept {
    if (!seen.floor) return;
    for (std::size_t s = 0; s < soles_.size(); ++s) {
        if (options.stands[s / 2] <= 0.0f) continue;
        float lowest = kStandsBelow;
        std::uint32_t at = 0;
        for (const std::uint32_t v : soles_[s]) {
            const float height = seen.floor->normal.dot(posed_.positions[v]) - seen.floor->offset;
            if (height < lowest) lowest = height, at = v;
        }
        if (lowest <= 0.0f || lowest >= kStandsBelow) continue;
        add_vertex(at, seen.floor->normal, lowest,
                   options.stands[s / 2] * kSoleInformation * geman_mcclure(lowest, kStandsScale));
    }
}

/// P5 3.2.1 with lines of sight for points: the depth along them is the readings' matter.
void Registration::add_pulls(const SeenPerson& seen) noexcept {
    for (const SkinPull& pull : seen.pulls) {
        const std::int32_t corner = body_.corner_of(pull.vertex);
        const Vec3f at =
            posed_.positions[pull.vertex] + posed_.rotations[pull.vertex] * pull.offset;
        for (std::size_t k = 0; k < 2; ++k) {
            const float residual = pull.along[k].dot(at);
            add_row(corner / 3, TrackedBody::weights_of(corner), at, pull.along[k], residual,
                    pull.weight[k] * geman_mcclure(residual, pull.robust_m));
        }
    }
}

void Registration::add_motion(const MotionPrior& motion, const body::Pose& pose) noexcept {
    const double place = 1.0 / (motion.place_m * motion.place_m);
    normal_.diagonal().head<3>().array() += place;
    gradient_.head<3>() += place * (pose.hips_position - motion.pose.hips_position).cast<double>();
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const double stiffness = 1.0 / (motion.turn[j] * motion.turn[j]);
        const Vec3f off =
            body::rotation_vector(pose.rotations[j] * motion.pose.rotations[j].conjugate());
        const int at = 3 + 3 * static_cast<int>(j);
        normal_.diagonal().segment<3>(at).array() += stiffness;
        gradient_.segment<3>(at) += stiffness * off.cast<double>();
    }
}

double Registration::step(const SeenPerson& seen, const RegistrationOptions& options,
                          const MotionPrior* motion, body::Pose& pose) noexcept {
    draw_pose(pose);
    sums_.fill(0.0f);
    sum_.fill(0.0f);
    find_visible(seen);
    add_readings(seen, options);
    add_extra(seen, options);
    add_outline(seen, options);
    add_floor(seen);
    add_soles(seen, options);
    add_pulls(seen);
    for (int a = 0; a < kUnknowns; ++a) {
        gradient_[a] = static_cast<double>(sum_[static_cast<std::size_t>(a)]);
        for (int b = 0; b <= a; ++b)
            normal_(a, b) = normal_(b, a) =
                static_cast<double>(sums_[static_cast<std::size_t>(a * kStride + b)]);
    }
    prior_.add(pose, options.pose_weight, 0, normal_, gradient_);
    if (motion != nullptr) add_motion(*motion, pose);
    normal_.diagonal() *= 1.0 + options.damping;
    normal_.diagonal().array() += 1e-3;
    factor_.compute(normal_);
    move_ = gradient_;
    factor_.solveInPlace(move_);
    move_ = -move_;
    const double turn = move_.tail(kUnknowns - 3).cwiseAbs().maxCoeff();
    const double shift = move_.head<3>().norm();
    const double scale =
        std::min({1.0, kMostTurn / std::max(turn, 1e-9), kMostShift / std::max(shift, 1e-9)});
    move_ *= scale;
    pose = body::moved_pose(pose, move_.data());
    return turn * scale;
}

/// Is the body drawn in a neighbouring cell, about as deep? An outline may be a cell off.
bool Registration::beside_body(int x, int y, float depth) const noexcept {
    for (int n = 0; n < 9; ++n) {
        const int nx = x + n % 3 - 1, ny = y + n / 3 - 1;
        if (nx < 0 || ny < 0 || nx >= camera_.width || ny >= camera_.height) continue;
        const float drawn = drawing_.cells[static_cast<std::size_t>(ny * camera_.width + nx)].depth;
        if (drawn != 0.0f && std::abs(drawn - depth) < kExplained) return true;
    }
    return false;
}

bool Registration::lacks_body(const SeenPerson& seen, int x, int y) const noexcept {
    const auto i = static_cast<std::size_t>(y * camera_.width + x);
    if (seen.mask.cells[i] == 0) return false;
    const float drawn = drawing_.cells[i].depth, real = seen.grid.depth[i];
    return (drawn == 0.0f || std::abs(drawn - real) >= kExplained) && !beside_body(x, y, real);
}

Agreement Registration::judge(const SeenPerson& seen, const body::Pose& pose, bool whole) noexcept {
    if (whole)
        body_.pose(pose, posed_);
    else
        body_.place(pose, posed_);
    body_.draw(posed_, camera_, drawing_);
    Agreement out;
    out.cells = seen.mask.count;
    double sum = 0.0;
    std::size_t explained = 0, lacking = 0;
    const PersonMask& mask = seen.mask;
    for (int y = std::min(mask.low[1], drawing_.low[1]);
         y <= std::max(mask.high[1], drawing_.high[1]); ++y)
        for (int x = std::min(mask.low[0], drawing_.low[0]);
             x <= std::max(mask.high[0], drawing_.high[0]); ++x) {
            const auto i = static_cast<std::size_t>(y * camera_.width + x);
            const DrawnCell& cell = drawing_.cells[i];
            const float real = seen.grid.depth[i];
            if (mask.cells[i] != 0) {
                const float off = std::abs(cell.depth - real);
                if (cell.depth != 0.0f && off < kExplained)
                    ++explained, sum += static_cast<double>(off);
                else if (!beside_body(x, y, real))
                    ++lacking;
            } else if (cell.depth != 0.0f && (real == 0.0f || real > cell.depth + kBehind)) {
                // Beside an outline a cell may be either's.
                const std::int32_t near = mask.nearest[i];
                if (near < 0 || std::abs(near % camera_.width - x) > 1 ||
                    std::abs(near / camera_.width - y) > 1)
                    ++lacking;
            }
        }
    if (explained > 0) out.error_m = static_cast<float>(sum / static_cast<double>(explained));
    out.unexplained = static_cast<float>(lacking) /
                      static_cast<float>(std::max<std::size_t>(1, explained + lacking));
    return out;
}

} // namespace toile::body_tracker
