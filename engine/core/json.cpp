#include "core/json.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>

namespace toile {
namespace {

// nlohmann keeps the last of two equal keys; a SAX pass in front refuses them.
class DuplicateKeyCheck : public nlohmann::json_sax<nlohmann::json> {
  public:
    std::string error;

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t value, const string_t&) override {
        if (std::isfinite(value)) return true;
        error = "a number is out of range";
        return false;
    }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override {
        keys_.emplace_back();
        return within_depth();
    }
    bool key(string_t& name) override {
        if (keys_.back().insert(name).second) return true;
        error = "the key '" + name + "' stands twice in one object";
        return false;
    }
    bool end_object() override {
        keys_.pop_back();
        return true;
    }
    bool start_array(std::size_t) override {
        keys_.emplace_back();
        return within_depth();
    }
    bool end_array() override { return end_object(); }
    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::json::exception& e) override {
        error = "not valid JSON at byte " + std::to_string(position);
        if (dynamic_cast<const nlohmann::json::out_of_range*>(&e) != nullptr)
            error += " (a number is out of range)";
        return false;
    }

  private:
    bool within_depth() {
        if (keys_.size() <= 64) return true;
        error = "nested more than 64 deep";
        return false;
    }

    std::vector<std::set<std::string>> keys_;
};

/// Keys and texts of a file may hold line breaks; messages are one line.
std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
    return text;
}

} // namespace

nlohmann::json parse_json(std::string_view text, const std::string& name) {
    DuplicateKeyCheck check;
    if (!nlohmann::json::sax_parse(text, &check))
        throw JsonError(name, check.error.empty() ? "not valid JSON" : one_line(check.error));
    return nlohmann::json::parse(text);
}

nlohmann::json parse_json_file(const std::filesystem::path& file, std::size_t max_bytes) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code))
        throw JsonError(file.string(), std::filesystem::exists(file, code) ? "is not a regular file"
                                                                           : "no such file");
    const auto bytes = std::filesystem::file_size(file, code);
    if (code || bytes > max_bytes)
        throw JsonError(file.string(), "larger than the " + std::to_string(max_bytes) +
                                           " bytes that such a file may have");
    const std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) throw JsonError(file.string(), "cannot be read");
    return parse_json(text.str(), file.string());
}

JsonObject::JsonObject(const nlohmann::json& value, std::string file, std::string place)
    : value_(&value), file_(std::move(file)), place_(std::move(place)) {
    if (!value.is_object()) throw error("", "must be an object");
}

bool JsonObject::has(const std::string& key) const {
    return value_->contains(key);
}

JsonError JsonObject::error(const std::string& key, const std::string& what) const {
    const std::string place = key.empty() ? place_ : place_ + "/" + key;
    return {file_, one_line((place.empty() ? std::string("/") : place) + ": " + what)};
}

const nlohmann::json& JsonObject::require(const std::string& key) {
    const auto found = value_->find(key);
    if (found == value_->end()) throw error(key, "is missing");
    read_.insert(key);
    return *found;
}

const nlohmann::json& JsonObject::any(const std::string& key) {
    return require(key);
}

std::string JsonObject::text(const std::string& key) {
    const auto& value = require(key);
    if (!value.is_string()) throw error(key, "must be a text");
    return value.get<std::string>();
}

double JsonObject::number(const std::string& key, double minimum, double maximum) {
    const auto& value = require(key);
    if (!value.is_number()) throw error(key, "must be a number");
    const double number = value.get<double>();
    if (!(number >= minimum && number <= maximum)) {
        std::ostringstream what;
        what << "is " << number << ", must lie between " << minimum << " and " << maximum;
        throw error(key, what.str());
    }
    return number;
}

std::int64_t JsonObject::integer(const std::string& key, std::int64_t minimum,
                                 std::int64_t maximum) {
    const auto& value = require(key);
    if (!value.is_number_integer()) throw error(key, "must be a whole number");
    const auto within = [&](auto number) {
        return std::cmp_greater_equal(number, minimum) && std::cmp_less_equal(number, maximum);
    };
    if (value.is_number_unsigned() ? !within(value.get<std::uint64_t>())
                                   : !within(value.get<std::int64_t>()))
        throw error(key, "must lie between " + std::to_string(minimum) + " and " +
                             std::to_string(maximum));
    return value.get<std::int64_t>();
}

bool JsonObject::boolean(const std::string& key) {
    const auto& value = require(key);
    if (!value.is_boolean()) throw error(key, "must be true or false");
    return value.get<bool>();
}

std::vector<double> JsonObject::numbers(const std::string& key, std::size_t count) {
    const auto& value = require(key);
    if (!value.is_array() || value.size() != count)
        throw error(key, "must be an array of " + std::to_string(count) + " numbers");
    std::vector<double> out;
    for (const auto& element : value) {
        if (!element.is_number()) throw error(key, "must hold numbers only");
        out.push_back(element.get<double>());
    }
    return out;
}

std::string JsonObject::file_name(const std::string& key) {
    const std::filesystem::path name(text(key));
    if (name.empty() || name.filename() != name || name == "." || name == "..")
        throw error(key, "must be the name of a file in this folder");
    return name.string();
}

JsonObject JsonObject::object(const std::string& key) {
    return {require(key), file_, place_ + "/" + key};
}

std::vector<JsonObject> JsonObject::objects(const std::string& key) {
    const auto& value = require(key);
    if (!value.is_array()) throw error(key, "must be an array of objects");
    std::vector<JsonObject> out;
    for (std::size_t i = 0; i < value.size(); ++i)
        out.emplace_back(value[i], file_, place_ + "/" + key + "/" + std::to_string(i));
    return out;
}

std::vector<std::string> JsonObject::texts(const std::string& key) {
    const auto& value = require(key);
    if (!value.is_array()) throw error(key, "must be an array of texts");
    std::vector<std::string> out;
    for (const auto& element : value) {
        if (!element.is_string()) throw error(key, "must hold texts only");
        out.push_back(element.get<std::string>());
    }
    return out;
}

std::string JsonObject::text_or(const std::string& key, std::string fallback) {
    return has(key) ? text(key) : std::move(fallback);
}

double JsonObject::number_or(const std::string& key, double minimum, double maximum,
                             double fallback) {
    return has(key) ? number(key, minimum, maximum) : fallback;
}

std::int64_t JsonObject::integer_or(const std::string& key, std::int64_t minimum,
                                    std::int64_t maximum, std::int64_t fallback) {
    return has(key) ? integer(key, minimum, maximum) : fallback;
}

std::vector<std::string> JsonObject::keys() const {
    std::vector<std::string> out;
    for (const auto& item : value_->items())
        out.push_back(item.key());
    return out;
}

void JsonObject::finish() const {
    for (const auto& item : value_->items())
        if (!read_.contains(item.key())) throw error(item.key(), "is not a known key");
}

} // namespace toile
