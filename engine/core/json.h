// Strict reading of our own JSON files: every refusal names the file and the place in it.
#pragma once

#include "core/error.h"

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

/// A JSON file that cannot be used: reads "FILE: /place/in/it: WHAT".
class JsonError : public FileError {
  public:
    using FileError::FileError;
};

/// Parses a whole file; duplicate keys, trailing text, bad UTF-8 and files over `max_bytes` are
/// refused. \throw JsonError
nlohmann::json parse_json_file(const std::filesystem::path& file,
                               std::size_t max_bytes = 16u << 20);

/// The same for text already in memory; `name` stands for the file in errors. \throw JsonError
nlohmann::json parse_json(std::string_view text, const std::string& name);

/// One object being read key by key; `finish` refuses the keys nobody asked for.
class JsonObject {
  public:
    /// `value` must outlive this. \throw JsonError when it is not an object
    JsonObject(const nlohmann::json& value, std::string file, std::string place = "");

    [[nodiscard]] bool has(const std::string& key) const;

    /// Required values. \throw JsonError when missing, of the wrong type, or not finite
    std::string text(const std::string& key);
    double number(const std::string& key, double minimum, double maximum);
    std::int64_t integer(const std::string& key, std::int64_t minimum, std::int64_t maximum);
    bool boolean(const std::string& key);
    std::vector<double> numbers(const std::string& key, std::size_t count);
    JsonObject object(const std::string& key);
    std::vector<JsonObject> objects(const std::string& key);
    std::vector<std::string> texts(const std::string& key);
    const nlohmann::json& any(const std::string& key);
    /// The name of a file beside this one: no folder, not "." or "..".
    std::string file_name(const std::string& key);

    /// Optional values.
    std::string text_or(const std::string& key, std::string fallback);
    double number_or(const std::string& key, double minimum, double maximum, double fallback);
    std::int64_t integer_or(const std::string& key, std::int64_t minimum, std::int64_t maximum,
                            std::int64_t fallback);

    /// Keys in file order of nlohmann (sorted).
    [[nodiscard]] std::vector<std::string> keys() const;

    /// \throw JsonError naming the first key that was never read
    void finish() const;

    /// Error that names this file and the place of `key` in it ("" for the object itself).
    [[nodiscard]] JsonError error(const std::string& key, const std::string& what) const;

  private:
    const nlohmann::json& require(const std::string& key);

    const nlohmann::json* value_;
    std::string file_;
    std::string place_;
    std::set<std::string> read_;
};

} // namespace toile
