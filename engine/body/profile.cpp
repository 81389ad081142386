#include "body/profile.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace toile::body {
namespace {

std::optional<std::size_t> peak(const std::vector<float>& value, float drop) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < value.size(); ++i) {
        if (value[i] > value[best]) best = i;
        if (value[i] < value[best] - drop * std::abs(value[best])) {
            if (best == 0) { // falls from the start: the peak lies behind the next hollow
                best = i;
                continue;
            }
            return best;
        }
    }
    return std::nullopt;
}

/// Farthest from the chord between the ends on one side.
std::size_t corner(const Profile& p, float side) {
    std::size_t best = 0;
    float most = -1.0f;
    const float run = p.at.back() - p.at.front();
    for (std::size_t i = 0; i < p.size(); ++i) {
        const float t = run != 0.0f ? (p.at[i] - p.at.front()) / run : 0.0f;
        const float chord = p.value.front() + t * (p.value.back() - p.value.front());
        const float off = side * (p.value[i] - chord);
        if (off <= most) continue;
        most = off;
        best = i;
    }
    return best;
}

void require(const Profile& p) {
    if (p.size() == 0) throw Error("a part of the body is too short to be measured");
}

} // namespace

Profile Profile::between(float a, float b) const {
    Profile out;
    for (std::size_t i = 0; i < size(); ++i)
        if (at[i] >= std::min(a, b) && at[i] <= std::max(a, b)) out.add(at[i], value[i]);
    return out;
}

std::size_t Profile::largest() const {
    require(*this);
    return static_cast<std::size_t>(std::max_element(value.begin(), value.end()) - value.begin());
}

std::size_t Profile::smallest() const {
    require(*this);
    return static_cast<std::size_t>(std::min_element(value.begin(), value.end()) - value.begin());
}

std::optional<std::size_t> Profile::first_peak(float drop) const {
    return peak(value, drop);
}

std::optional<std::size_t> Profile::first_hollow(float rise) const {
    std::vector<float> turned;
    for (const float v : value)
        turned.push_back(-v);
    return peak(turned, rise);
}

std::size_t Profile::corner_above() const {
    require(*this);
    return corner(*this, 1.0f);
}

std::size_t Profile::corner_below() const {
    require(*this);
    return corner(*this, -1.0f);
}

std::size_t Profile::steepest(std::size_t window) const {
    require(*this);
    std::size_t best = size() / 2;
    float most = -1e9f;
    for (std::size_t i = window; i + window < size(); ++i) {
        const float slope =
            (value[i + window] - value[i - window]) / (at[i + window] - at[i - window]);
        if (slope <= most) continue;
        most = slope;
        best = i;
    }
    return best;
}

} // namespace toile::body
