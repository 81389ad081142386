// The garments of a world of cloth, by handles that are never used twice.
#pragma once

#include "cloth/moving_body.h"
#include "cloth/step.h"
#include "core/error.h"

#include <algorithm>
#include <string>
#include <vector>

namespace toile::cloth {

/// `Cloth` is one solver's garment: bind(body), vertex_count().
template <class Cloth>
class GarmentRoster {
  public:
    struct Entry {
        std::uint32_t handle;
        bool fresh = true;     ///< begins from its targets at the next step
        std::size_t first = 0; ///< of its rows, where a world keeps all garments' together
        Cloth cloth;
    };

    /// Handle, never 0.
    std::uint32_t add(Cloth cloth) {
        entries_.push_back({next_handle_, true, 0, std::move(cloth)});
        note();
        return next_handle_++;
    }
    /// \throw Error when there is no such garment
    void remove(std::uint32_t garment) {
        const auto it = std::find_if(entries_.begin(), entries_.end(),
                                     [&](const Entry& entry) { return entry.handle == garment; });
        if (it == entries_.end())
            throw Error("remove_garment: there is no garment " + std::to_string(garment));
        entries_.erase(it);
        note();
    }
    /// All begin anew on another body. \throw Error, then they are on `before` as they were
    void bind(const MovingBody& body, const MovingBody* before) {
        try {
            for (Entry& entry : entries_)
                entry.cloth.bind(body);
        } catch (...) {
            for (Entry& entry : entries_)
                if (before != nullptr) entry.cloth.bind(*before);
            throw;
        }
        for (Entry& entry : entries_)
            entry.fresh = true;
    }

    [[nodiscard]] Entry* find(std::uint32_t handle) noexcept {
        for (Entry& entry : entries_)
            if (entry.handle == handle) return &entry;
        return nullptr;
    }
    /// \throw Error when there is no such garment
    [[nodiscard]] const Cloth& at(std::uint32_t handle) const {
        for (const Entry& entry : entries_)
            if (entry.handle == handle) return entry.cloth;
        throw Error("there is no garment " + std::to_string(handle));
    }
    [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }
    [[nodiscard]] auto begin() noexcept { return entries_.begin(); }
    [[nodiscard]] auto end() noexcept { return entries_.end(); }
    [[nodiscard]] auto begin() const noexcept { return entries_.begin(); }
    [[nodiscard]] auto end() const noexcept { return entries_.end(); }
    /// The same, as the check of a step reads them.
    [[nodiscard]] std::span<const KnownGarment> known() const noexcept { return known_; }

  private:
    void note() {
        known_.clear();
        for (const Entry& entry : entries_)
            known_.push_back({entry.handle, entry.cloth.vertex_count()});
    }

    std::vector<Entry> entries_;
    std::vector<KnownGarment> known_;
    std::uint32_t next_handle_ = 1;
};

} // namespace toile::cloth
