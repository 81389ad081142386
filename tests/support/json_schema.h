// Holds JSON against our own JSON Schemas: the part of draft 2020-12 that they use. A keyword that
// is not known here is a fault of its own, so that nothing passes unread.
#pragma once

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace toile::test {

class JsonSchema {
  public:
    using Json = nlohmann::json;

    /// A file of docs/schemas.
    explicit JsonSchema(const std::string& name) {
        const std::string file = std::string(TOILE_SOURCE_DIR) + "/docs/schemas/" + name;
        std::ifstream in(file);
        if (!in) throw std::runtime_error(file + ": cannot be read");
        schema_ = Json::parse(in);
    }

    /// What does not hold, one line each with its place; empty for a valid value.
    [[nodiscard]] std::vector<std::string> faults(const Json& value) const {
        std::vector<std::string> out;
        check(value, schema_, "", out);
        return out;
    }

  private:
    using Faults = std::vector<std::string>;

    static bool has_type(const Json& value, const std::string& type) {
        if (type == "object") return value.is_object();
        if (type == "array") return value.is_array();
        if (type == "string") return value.is_string();
        if (type == "boolean") return value.is_boolean();
        if (type == "null") return value.is_null();
        if (type == "number") return value.is_number();
        return type == "integer" && value.is_number_integer();
    }

    static void check(const Json& value, const Json& schema, const std::string& place,
                      Faults& out) {
        static const std::set<std::string> kNotes = {"$schema", "title", "description", "default",
                                                     "$comment"};
        for (const auto& [key, rule] : schema.items()) {
            if (kNotes.contains(key)) continue;
            if (!general(value, key, rule, place, out) && !number(value, key, rule, place, out) &&
                !text(value, key, rule, place, out) && !list(value, key, rule, place, out) &&
                !object(value, key, rule, schema, place, out))
                out.push_back(place + ": the schema's '" + key + "' is not known to this test");
        }
    }

    static void expect(bool holds, const std::string& place, const std::string& what, Faults& out) {
        if (!holds) out.push_back(place + ": " + what);
    }

    static bool general(const Json& value, const std::string& key, const Json& rule,
                        const std::string& place, Faults& out) {
        if (key == "type") {
            const Json types = rule.is_array() ? rule : Json::array({rule});
            expect(std::any_of(types.begin(), types.end(),
                               [&](const Json& t) { return has_type(value, t); }),
                   place, "is no " + rule.dump(), out);
        } else if (key == "const") {
            expect(value == rule, place, "is not " + rule.dump(), out);
        } else if (key == "enum") {
            expect(std::find(rule.begin(), rule.end(), value) != rule.end(), place,
                   value.dump() + " is none of " + rule.dump(), out);
        } else if (key == "oneOf" || key == "anyOf") {
            const auto fits = std::count_if(rule.begin(), rule.end(), [&](const Json& one) {
                Faults faults;
                check(value, one, place, faults);
                return faults.empty();
            });
            expect(key == "oneOf" ? fits == 1 : fits > 0, place, "fits not " + key, out);
        } else {
            return false;
        }
        return true;
    }

    static bool number(const Json& value, const std::string& key, const Json& rule,
                       const std::string& place, Faults& out) {
        if (key != "minimum" && key != "maximum") return false;
        if (!value.is_number()) return true;
        const bool low = key == "minimum";
        expect(low ? value >= rule : value <= rule, place,
               value.dump() + (low ? " is below " : " is above ") + rule.dump(), out);
        return true;
    }

    static bool text(const Json& value, const std::string& key, const Json& rule,
                     const std::string& place, Faults& out) {
        if (key != "minLength" && key != "maxLength" && key != "pattern") return false;
        if (!value.is_string()) return true;
        const auto words = value.get<std::string>();
        const bool holds = key == "minLength" ? words.size() >= rule.get<std::size_t>()
                           : key == "maxLength"
                               ? words.size() <= rule.get<std::size_t>()
                               : std::regex_search(words, std::regex(rule.get<std::string>()));
        expect(holds, place, value.dump() + " against " + key, out);
        return true;
    }

    static bool list(const Json& value, const std::string& key, const Json& rule,
                     const std::string& place, Faults& out) {
        if (key != "items" && key != "minItems" && key != "maxItems") return false;
        if (!value.is_array()) return true;
        if (key == "items") {
            for (std::size_t i = 0; i < value.size(); ++i)
                check(value[i], rule, place + "/" + std::to_string(i), out);
            return true;
        }
        const auto limit = rule.get<std::size_t>();
        expect(key == "minItems" ? value.size() >= limit : value.size() <= limit, place,
               std::to_string(value.size()) + " items against " + key, out);
        return true;
    }

    static bool object(const Json& value, const std::string& key, const Json& rule,
                       const Json& schema, const std::string& place, Faults& out) {
        static const std::set<std::string> kKnown = {"properties", "required", "propertyNames",
                                                     "additionalProperties", "minProperties"};
        if (!kKnown.contains(key)) return false;
        if (!value.is_object()) return true;
        if (key == "required") {
            for (const Json& name : rule)
                expect(value.contains(name), place, "lacks " + name.dump(), out);
        } else if (key == "minProperties") {
            expect(value.size() >= rule.get<std::size_t>(), place, "has too few keys", out);
        } else {
            const Json known = schema.value("properties", Json::object());
            for (const auto& [name, item] : value.items()) {
                const std::string where = place + "/" + name;
                if (key == "propertyNames") check(name, rule, where, out);
                if (key == "properties" && rule.contains(name)) check(item, rule[name], where, out);
                if (key != "additionalProperties" || known.contains(name)) continue;
                if (rule.is_object())
                    check(item, rule, where, out);
                else
                    expect(rule.get<bool>(), where, "is not known", out);
            }
        }
        return true;
    }

    Json schema_;
};

} // namespace toile::test
