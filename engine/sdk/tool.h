// Kind toile.tool/1 for a class P with
//     toile_tool_info describe_tool();                                                   // [main]
//     void run_tool(const ToolArguments& arguments, Job job); // throws Failure when wrong //
//     [worker]
#pragma once

#include "abi/tool.h"
#include "sdk/guard.h"
#include "sdk/job.h"
#include "sdk/structs.h"

#include <charconv>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace toile::sdk {

/// What was given on the command line, already checked by the host against the options' types and
/// ranges. Borrowed for the call.
class ToolArguments {
  public:
    explicit ToolArguments(std::span<const char* const> words) : words_(words) {
        for (const char* word : words_)
            if (word == nullptr) throw bad_argument("argv: null");
    }

    /// Every value of an option, in order. `name` without dashes.
    [[nodiscard]] std::vector<std::string> values(std::string_view name) const {
        std::vector<std::string> out;
        for (std::size_t i = 0; i + 1 < words_.size(); ++i)
            if (is(words_[i], name)) out.emplace_back(words_[++i]);
        return out;
    }
    [[nodiscard]] std::optional<std::string> text(std::string_view name) const {
        const auto all = values(name);
        return all.empty() ? std::nullopt : std::optional(all.back());
    }
    /// \throw Failure TOILE_E_ARGUMENT when it is no number
    template <class Number>
    [[nodiscard]] Number number(std::string_view name, Number without) const {
        const auto given = text(name);
        if (!given) return without;
        Number out{};
        const char* end = given->data() + given->size();
        const auto [stop, code] = std::from_chars(given->data(), end, out);
        if (code != std::errc{} || stop != end)
            throw bad_argument("--" + std::string(name) + ": '" + *given + "' is no such number");
        return out;
    }
    [[nodiscard]] bool has(std::string_view name) const {
        for (const char* word : words_)
            if (is(word, name)) return true;
        return false;
    }

  private:
    static bool is(std::string_view word, std::string_view name) {
        return word.starts_with("--") && word.substr(2) == name;
    }
    std::span<const char* const> words_;
};

struct Tool {
    static constexpr const char* id = TOILE_TOOL;

    template <class P>
    static toile_status describe(toile_instance* instance, toile_tool_info* out) noexcept {
        return guarded<P>(instance, [&](P& p) { write_struct(out, p.describe_tool(), "out"); });
    }
    template <class P>
    static toile_status run(toile_instance* instance, std::int32_t argc, const char* const* argv,
                            toile_job* job) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (argc < 0 || (argc > 0 && argv == nullptr)) throw bad_argument("argv: null");
            p.run_tool(ToolArguments({argv, static_cast<std::size_t>(argc)}), Job(job));
        });
    }
    template <class P>
    static constexpr toile_tool table{sizeof(toile_tool), 0, &describe<P>, &run<P>};
};

} // namespace toile::sdk
