#include "body_tracker/body_tracking.h"

#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

constexpr float kUsualStep = 1.0f / 30.0f;
constexpr float kLongestStep = 1.0f; // seconds
constexpr float kOwn = 0.12f;        // metres from a person's bones: that person's
constexpr float kGrow = 0.45f;       // as far may what hangs on such cells reach
constexpr float kStray = 0.35f;      // and a small piece that hangs on nothing
constexpr float kSamePerson = 0.9f;  // metres between where somebody went and came back
constexpr std::uint32_t kDoubts = 3; // searches before a piece counts as scene
constexpr float kSamePiece = 0.5f;   // metres that one moves between two frames at most
constexpr std::size_t kFewCells = 80;

std::optional<geometry::Plane> floor_of(const CameraPlace& place) {
    if (!place) return std::nullopt;
    const Eigen::Isometry3d camera_from_world = place->inverse();
    const Vec3f up = (camera_from_world.linear() * Vec3d::UnitY()).cast<float>();
    return geometry::Plane::through(camera_from_world.translation().cast<float>(), up);
}

} // namespace

BodyTracking::BodyTracking(const body::FitModel& model, const imaging::Intrinsics& camera,
                           const CameraPlace& world_from_camera, const TrackingOptions& options)
    : options_(options), reducer_(camera), grid_(reducer_.blank()), picture_(camera),
      scene_(reducer_.grid(), floor_of(world_from_camera)), owner_(reducer_.grid().size(), 0) {
    options_.most_people = std::clamp<std::size_t>(options.most_people, 1, kMostPeople);
    for (std::size_t i = 0; i < options_.most_people; ++i)
        people_.push_back(std::make_unique<PersonTrack>(model, reducer_.grid(), options_.person));
    stack_.reserve(reducer_.grid().size());
}

float BodyTracking::step_to(std::int64_t timestamp_ns) noexcept {
    const float dt = 1e-9f * static_cast<float>(timestamp_ns - last_ns_);
    const bool usual = !started_ || dt <= 0.0f || dt > kLongestStep;
    started_ = true;
    last_ns_ = timestamp_ns;
    return usual ? kUsualStep : dt;
}

SeenPerson BodyTracking::seen_by(PersonTrack& person) const noexcept {
    return {grid_, person.mask(), scene_.floor(), &picture_};
}

/// 1 + whose bones are nearest, within a distance; 0: nobody's.
std::uint8_t BodyTracking::nearest_person(const Vec3f& point, float within) const noexcept {
    std::uint8_t nearest = 0;
    for (std::size_t p = 0; p < people_.size(); ++p) {
        if (!people_[p]->active()) continue;
        const float distance = people_[p]->bones()(point);
        if (distance < within) within = distance, nearest = static_cast<std::uint8_t>(p + 1);
    }
    return nearest;
}

bool BodyTracking::like_a_person(std::uint16_t label) const noexcept {
    const auto pieces = scene_.people_like();
    return std::any_of(pieces.begin(), pieces.end(),
                       [&](const Piece& piece) { return piece.label == label; });
}

/// Foreground cells near somebody's bones are theirs, and so is what hangs on them, and small
/// pieces that came: an arm before or behind which there is another hangs on nothing.
void BodyTracking::share_out() noexcept {
    const GridCamera& camera = grid_.camera;
    std::fill(owner_.begin(), owner_.end(), std::uint8_t{0});
    stack_.clear();
    const auto labels = scene_.labels();
    const auto point = [&](std::size_t i) {
        const auto n = static_cast<int>(i);
        return camera.point(static_cast<float>(n % camera.width),
                            static_cast<float>(n / camera.width), grid_.depth[i]);
    };
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (labels[i] == 0) continue;
        owner_[i] = nearest_person(point(i), kOwn);
        if (owner_[i] != 0) stack_.push_back(static_cast<std::uint32_t>(i));
    }
    for (std::size_t at = 0; at < stack_.size(); ++at) {
        const auto i = static_cast<int>(stack_[at]);
        const int x = i % camera.width, y = i / camera.width;
        constexpr std::array<std::array<int, 2>, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
        for (const auto& [dx, dy] : kSides) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= camera.width || y + dy >= camera.height)
                continue;
            const auto n = static_cast<std::size_t>(i + dy * camera.width + dx);
            const std::uint8_t owner = owner_[static_cast<std::size_t>(i)];
            if (labels[n] == 0 || owner_[n] != 0 ||
                !SceneWatch::joined(grid_.depth[static_cast<std::size_t>(i)], grid_.depth[n]) ||
                people_[static_cast<std::size_t>(owner - 1)]->bones()(point(n)) > kGrow)
                continue;
            owner_[n] = owner;
            stack_.push_back(static_cast<std::uint32_t>(n));
        }
    }
    for (std::size_t i = 0; i < labels.size(); ++i)
        if (labels[i] != 0 && owner_[i] == 0 && scene_.came(i) && !like_a_person(labels[i]))
            owner_[i] = nearest_person(point(i), kStray);
    for (std::size_t p = 0; p < people_.size(); ++p) {
        if (!people_[p]->active()) continue;
        PersonMask& mask = people_[p]->mask();
        for (std::size_t i = 0; i < owner_.size(); ++i)
            mask.cells[i] = owner_[i] == p + 1 ? 1 : 0;
        find_nearest(camera, mask);
    }
}

void BodyTracking::follow_all(float dt) noexcept {
    for (const auto& person : people_) {
        if (!person->active()) continue;
        const std::uint32_t id = person->id();
        const bool known = person->sure();
        person->follow(seen_by(*person), scene_.up(), dt);
        if (!person->active() && !person->sure()) forget(id, *person);
        if (person->unseen_s() > options_.forget_s) person->stop();
        if (known || !person->active() || !person->sure()) continue;
        // Somebody is there after all: what was doubted there before counts no more.
        if (Doubt* const old = doubt_near(person->pose().hips_position)) old->times = 0;
    }
}

/// Somebody who turned out to be nobody: the piece is doubted, the number is used again.
void BodyTracking::forget(std::uint32_t id, PersonTrack& person) noexcept {
    if (id + 1 == next_id_) --next_id_;
    for (const Piece& piece : scene_.people_like()) {
        std::size_t shared = 0;
        for (std::size_t i = 0; i < owner_.size(); ++i)
            shared += scene_.labels()[i] == piece.label && person.mask().cells[i] != 0 ? 1 : 0;
        if (2 * shared > piece.cells) doubt(piece);
    }
}

bool BodyTracking::mask_piece(const Piece& piece, PersonTrack& person) const noexcept {
    PersonMask& mask = person.mask();
    for (std::size_t i = 0; i < owner_.size(); ++i)
        mask.cells[i] = scene_.labels()[i] == piece.label && owner_[i] == 0 ? 1 : 0;
    find_nearest(grid_.camera, mask);
    return mask.count >= kFewCells && 2 * mask.count >= piece.cells;
}

PersonTrack* BodyTracking::free_track() noexcept {
    for (const auto& person : people_)
        if (!person->active()) return person.get();
    return nullptr;
}

PersonTrack* BodyTracking::remembered_near(const Vec3f& place) noexcept {
    for (const auto& person : people_)
        if (person->active() && person->following() == Following::lost &&
            (person->pose().hips_position - place).norm() < kSamePerson)
            return person.get();
    return nullptr;
}

/// What is known of nobody there; null: nothing.
BodyTracking::Doubt* BodyTracking::doubt_near(const Vec3f& place) noexcept {
    for (Doubt& doubt : doubts_)
        if (doubt.times > 0 && (place - doubt.place).norm() < kSamePiece) return &doubt;
    return nullptr;
}

/// Looks for somebody new, once a frame: first where nobody was looked for in vain.
void BodyTracking::welcome() noexcept {
    for (std::uint32_t doubts = 0; doubts < kDoubts; ++doubts)
        for (const Piece& piece : scene_.people_like()) {
            const Doubt* const known = doubt_near(piece.middle);
            if ((known != nullptr ? known->times : 0) == doubts && look_at(piece)) return;
        }
}

/// False when there was nothing to look at, or nobody to look with.
bool BodyTracking::look_at(const Piece& piece) noexcept {
    PersonTrack* const known = remembered_near(piece.middle);
    PersonTrack* const person = known != nullptr ? known : free_track();
    if (person == nullptr) return false;
    if (!mask_piece(piece, *person)) return false;
    if (person->start(known != nullptr ? known->id() : next_id_, seen_by(*person), scene_.up())) {
        if (known == nullptr) ++next_id_;
        for (std::size_t i = 0; i < owner_.size(); ++i)
            if (person->mask().cells[i] != 0) owner_[i] = 1;
    } else {
        doubt(piece);
    }
    return true;
}

/// What was no person several times is scene.
void BodyTracking::doubt(const Piece& piece) noexcept {
    Doubt* mine = doubt_near(piece.middle);
    if (mine == nullptr) {
        mine = &*std::min_element(doubts_.begin(), doubts_.end(),
                                  [](const Doubt& a, const Doubt& b) { return a.times < b.times; });
        mine->times = 0;
    }
    ++mine->times;
    mine->place = piece.middle;
    if (mine->times < kDoubts) return;
    scene_.dismiss(grid_, piece.label);
    mine->times = 0;
}

/// Where somebody is followed.
void BodyTracking::take_picture(const std::uint8_t* rgba) noexcept {
    std::array<int, 2> low{grid_.camera.width, grid_.camera.height}, high{-1, -1};
    if (options_.person.marks.weight > 0.0f && rgba != nullptr)
        for (const auto& person : people_) {
            if (!person->active()) continue;
            for (std::size_t k = 0; k < 2; ++k) {
                low[k] = std::min(low[k], person->mask().low[k]);
                high[k] = std::max(high[k], person->mask().high[k]);
            }
        }
    constexpr int kBeside = 2; // cells
    if (picture_.camera().distorted() && high[0] >= 0) {
        low = {0, 0}; // cells are not where their pixels are
        high = {grid_.camera.width, grid_.camera.height};
    }
    const int step = reducer_.step();
    for (std::size_t k = 0; k < 2; ++k) {
        low[k] = step * (low[k] - kBeside);
        high[k] = step * (high[k] + 1 + kBeside);
    }
    picture_.take(high[0] > low[0] ? rgba : nullptr, low, high);
}

void BodyTracking::update(const float* metres, std::int64_t timestamp_ns,
                          const std::uint8_t* rgba) noexcept {
    const float dt = step_to(timestamp_ns);
    reducer_.reduce(metres, grid_);
    scene_.look(grid_);
    for (const auto& person : people_)
        if (person->active()) person->predict(dt);
    share_out();
    take_picture(rgba);
    follow_all(dt);
    welcome();
    scene_.learn(grid_, owner_, dt);
}

} // namespace toile::body_tracker
