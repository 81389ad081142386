// What the contract's cases are written with.
#pragma once

#include "host/contract.h"
#include "host/contract_figure.h"
#include "host/faults.h"
#include "host/instance.h"
#include "host/views.h"

#include <cstring>

namespace toile::host {

/// An instance under test. Every check throws PluginRefused with a text that names the call.
class Bench {
  public:
    explicit Bench(const std::shared_ptr<const Plugin>& plugin, std::uint32_t threads = 1);

    void activate();
    Instance& instance() { return *instance_; }
    template <class Table>
    const Table& table() {
        return instance_->table<Table>();
    }

    /// The call must do its work: a negative status or an exception breaks the rule.
    template <class Work>
    toile_status ok(const char* what, const Work& work) {
        const toile_status status = run(what, work);
        if (status < 0) throw failed(what, status);
        return status;
    }
    /// The call must be refused with a negative status and a reported text, and not throw.
    template <class Work>
    void fails(const char* what, const char* when, const Work& work) {
        (void)instance_->take_error();
        must_have_failed(what, when, run(what, work));
    }
    /// Whatever it answers, it must come back and not throw.
    template <class Work>
    toile_status any(const char* what, const Work& work) {
        return run(what, work);
    }

    /// \throw PluginRefused non_finite
    void finite(const char* what, const std::vector<Float3>& rows) const;
    void finite(const char* what, std::span<const float> values) const;
    /// \throw PluginRefused contract_broken when `holds` is false
    void rule(bool holds, const std::string& text) const;
    /// Largest distance between rows, metres.
    [[nodiscard]] static double distance(const std::vector<Float3>& a,
                                         const std::vector<Float3>& b);

  private:
    template <class Work>
    toile_status run(const char* what, const Work& work) {
        try {
            return work(instance_->handle());
        } catch (...) {
            throw PluginRefused(Refusal::call_threw, shown_,
                                std::string(what) + ": threw an exception across the boundary");
        }
    }
    [[nodiscard]] PluginRefused failed(const char* what, toile_status status);
    void must_have_failed(const char* what, const char* when, toile_status status);

    std::string shown_;
    Services services_;
    std::unique_ptr<Instance> instance_;
};

/// A buffer with guards on both sides that tells when something was written beyond it.
template <class T>
class Guarded {
  public:
    explicit Guarded(std::size_t count) : rows_(count + 2 * kGuard) {
        std::memset(static_cast<void*>(rows_.data()), kByte, rows_.size() * sizeof(T));
    }
    [[nodiscard]] toile_view_mut view() {
        return view_mut(std::span<T>(rows_).subspan(kGuard, rows_.size() - 2 * kGuard));
    }
    [[nodiscard]] std::vector<T> rows() const {
        return {rows_.begin() + kGuard, rows_.end() - kGuard};
    }
    [[nodiscard]] bool intact() const {
        return untouched(0, kGuard) && untouched(rows_.size() - kGuard, kGuard);
    }

  private:
    static constexpr std::size_t kGuard = 16;
    static constexpr unsigned char kByte = 0xff; // as floats: NaN, so that unwritten rows show

    [[nodiscard]] bool untouched(std::size_t begin, std::size_t count) const {
        const auto* bytes = reinterpret_cast<const unsigned char*>(rows_.data() + begin);
        for (std::size_t i = 0; i < count * sizeof(T); ++i)
            if (bytes[i] != kByte) return false;
        return true;
    }
    std::vector<T> rows_;
};

/// An in-struct as a newer host would give it: longer than this build's, the rest garbage.
template <class T>
class Longer {
  public:
    explicit Longer(const T& value) : bytes_(sizeof(T) + 64, std::byte{0xa5}) {
        std::memcpy(bytes_.data(), &value, sizeof(T));
        get()->size = static_cast<std::uint32_t>(bytes_.size());
    }
    [[nodiscard]] T* get() { return reinterpret_cast<T*>(bytes_.data()); }

  private:
    std::vector<std::byte> bytes_;
};

// The cases of each kind; see contract.cpp.
[[nodiscard]] std::span<const ContractCase> life_cases();
[[nodiscard]] std::span<const ContractCase> skinning_cases();
[[nodiscard]] std::span<const ContractCase> garment_cases();
[[nodiscard]] std::span<const ContractCase> cloth_cases();
[[nodiscard]] std::span<const ContractCase> body_source_cases();
[[nodiscard]] std::span<const ContractCase> sensor_cases();
[[nodiscard]] std::span<const ContractCase> tool_cases();
[[nodiscard]] std::span<const ContractCase> resizer_cases();
[[nodiscard]] std::span<const ContractCase> scanner_cases();

} // namespace toile::host
