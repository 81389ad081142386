// Every word that a shopper or an operator reads, one file per language.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace toile::apps::kiosk {

/// The keys of a language's file, in its order; names in texts.cpp.
enum class Text : std::size_t {
    attract_title,
    attract_line,
    consent_title,
    consent_camera,
    consent_measure,
    consent_kept,
    consent_network,
    agree,
    decline,
    measure_title,
    measure_front,
    measure_left,
    measure_back,
    measure_right,
    measure_working,
    measure_done,
    measure_failed,
    skip,
    try_again,
    next_garment,
    previous_garment,
    size,
    size_auto,
    colour,
    freeze,
    turn,
    live,
    compare,
    compare_done,
    snapshot,
    snapshot_kept,
    finish,
    dressing,
    fits,
    between_sizes,
    not_measured,
    frozen_title,
    goodbye_title,
    goodbye_line,
    declined_line,
    come_closer,
    hand_hint,
    setup_title,
    setup_sensor,
    setup_no_sensor,
    setup_floor,
    setup_no_floor,
    setup_camera,
    setup_mirror,
    setup_light,
    setup_light_good,
    setup_light_dark,
    setup_light_bright,
    setup_keys,
    setup_saved,
    safe_title,
    safe_line,
    camera_lost,
    camera_back,
    garment_changed,
    garment_refused,
    plugin_off,
    disk_full,
    picture_lost,
    clock_changed,
    restarted,
    stock_plugins,
    count_
};

inline constexpr std::size_t kTextCount = static_cast<std::size_t>(Text::count_);

/// Immutable once loaded.
class Texts {
  public:
    /// `language`: "en" for en.json of a texts folder. \throw Error naming the file and the key
    /// that is missing, unknown or empty; UsageError listing the languages for one not there
    [[nodiscard]] static Texts load(const std::string& language);
    /// \throw Error
    [[nodiscard]] static Texts load_file(const std::filesystem::path& file);

    [[nodiscard]] const std::string& operator[](Text text) const {
        return texts_[static_cast<std::size_t>(text)];
    }
    /// With {name} replaced by words.
    [[nodiscard]] std::string
    with(Text text, std::initializer_list<std::pair<const char*, std::string>> replacements) const;

  private:
    std::array<std::string, kTextCount> texts_;
};

[[nodiscard]] const char* text_key(Text text);
/// Languages that are shipped or stand in TOILE_DATA_PATH, sorted.
[[nodiscard]] std::vector<std::string> list_languages();
/// Some letters fewer at the end (UTF-8, none cut in two), and three dots; shorter in bytes.
[[nodiscard]] std::string shortened(const std::string& words);

} // namespace toile::apps::kiosk
