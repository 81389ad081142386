// Reading JSON strictly: what is taken, and that each refusal names the file and the place in it.
#include "core/json.h"

#include "core/bytes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

namespace toile {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

nlohmann::json parse(std::string_view text) {
    return parse_json(text, "a.json");
}

// `text` parsed and opened as an object; the reader keeps a reference, so both stay together.
class Opened {
  public:
    explicit Opened(std::string_view text) : json(parse(text)), object(json, "a.json") {}

    nlohmann::json json;
    JsonObject object;
};

TEST(ParseJson, TakesEveryKindOfValue) {
    const auto json = parse(R"({"a": [1, -2, 3.5e2], "b": {"c": null}, "d": true, "e": "ü\n"})");
    EXPECT_EQ(json["a"][1], -2);
    EXPECT_EQ(json["a"][2], 350.0);
    EXPECT_TRUE(json["b"]["c"].is_null());
    EXPECT_EQ(json["d"], true);
    EXPECT_EQ(json["e"], "ü\n");
}

TEST(ParseJson, KeysMayRepeatInDifferentObjectsOnly) {
    EXPECT_NO_THROW(parse(R"([{"a": 1}, {"a": 2}, {"b": {"b": 3}}])"));
    EXPECT_ERROR(parse(R"({"a": 1, "b": 2, "a": 3})"), "the key 'a' stands twice in one object");
    EXPECT_ERROR(parse(R"([{"x": {"a": 1, "a": 1}}])"), "the key 'a' stands twice");
}

TEST(ParseJson, WhatIsNotJsonIsRefusedWithItsByte) {
    EXPECT_ERROR(parse(""), "a.json: not valid JSON at byte 1");
    EXPECT_ERROR(parse("{"), "not valid JSON at byte 2");
    EXPECT_ERROR(parse(R"({"a": 1,})"), "not valid JSON at byte 9");
    EXPECT_ERROR(parse(R"({"a": 1} tail)"), "not valid JSON at byte 11");
    EXPECT_ERROR(parse(R"({'a': 1})"), "not valid JSON");
    EXPECT_ERROR(parse(R"({"a": NaN})"), "not valid JSON");
    EXPECT_ERROR(parse(R"({"a": 1} // why)"), "not valid JSON");
    EXPECT_ERROR(parse("{\"a\": \"\xff\"}"), "not valid JSON");
    EXPECT_ERROR(parse("{\"a\": \"\xc3\"}"), "not valid JSON"); // cut short
}

TEST(ParseJson, NumbersThatDoNotFitAreRefused) {
    EXPECT_ERROR(parse(R"({"a": 1e999})"), "a number is out of range");
    EXPECT_ERROR(parse(R"({"a": -1e999})"), "a number is out of range");
    EXPECT_EQ(parse("1e-999"), 0.0);
}

TEST(ParseJson, DeepNestingIsRefusedNotFollowed) {
    EXPECT_NO_THROW(parse(std::string(64, '[') + std::string(64, ']')));
    EXPECT_ERROR(parse(std::string(65, '[') + std::string(65, ']')), "nested more than 64 deep");
    EXPECT_ERROR(parse(std::string(1u << 20, '[')), "nested more than 64 deep");
}

TEST(ParseJsonFile, ReadsAFileAndNamesOneThatItCannot) {
    const test::TemporaryFolder folder;
    write_text(folder / "good.json", R"({"a": 1})");
    EXPECT_EQ(parse_json_file(folder / "good.json")["a"], 1);
    EXPECT_ERROR(parse_json_file(folder / "none.json"), "none.json: no such file");
    EXPECT_ERROR(parse_json_file(folder.path()), "is not a regular file");
    write_text(folder / "empty.json", "");
    EXPECT_ERROR(parse_json_file(folder / "empty.json"), "empty.json: not valid JSON at byte 1");
}

TEST(ParseJsonFile, SizeIsCheckedBeforeReading) {
    const test::TemporaryFolder folder;
    write_text(folder / "a.json", "[1, 2]");
    EXPECT_NO_THROW(parse_json_file(folder / "a.json", 6));
    EXPECT_ERROR(parse_json_file(folder / "a.json", 5), "larger than the 5 bytes");
}

TEST(JsonObjectReading, ValuesOfEachType) {
    Opened read(R"({"text": "hem", "number": 2.5, "whole": -7, "flag": false, "row": [1, 2.5, 3],
                    "names": ["warp", "weft"], "inner": {"x": 1}, "list": [{"x": 1}, {"x": 2}]})");
    JsonObject& object = read.object;
    EXPECT_EQ(object.text("text"), "hem");
    EXPECT_EQ(object.number("number", 0.0, 3.0), 2.5);
    EXPECT_EQ(object.number("whole", -10.0, 0.0), -7.0) << "a whole number is a number";
    EXPECT_EQ(object.integer("whole", -7, -7), -7);
    EXPECT_FALSE(object.boolean("flag"));
    EXPECT_THAT(object.numbers("row", 3), ElementsAre(1.0, 2.5, 3.0));
    EXPECT_THAT(object.texts("names"), ElementsAre("warp", "weft"));
    EXPECT_EQ(object.object("inner").integer("x", 0, 9), 1);
    auto list = object.objects("list");
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[1].integer("x", 0, 9), 2);
    EXPECT_TRUE(object.any("flag").is_boolean());
    EXPECT_NO_THROW(object.finish());
}

TEST(JsonObjectReading, MissingKeysAndFallbacks) {
    Opened read(R"({"given": 3, "name": "x"})");
    JsonObject& object = read.object;
    EXPECT_TRUE(object.has("given"));
    EXPECT_FALSE(object.has("absent"));
    EXPECT_ERROR(object.text("absent"), "a.json: /absent: is missing");
    EXPECT_EQ(object.number_or("absent", 0.0, 1.0, 0.25), 0.25);
    EXPECT_EQ(object.integer_or("absent", 0, 1, 9), 9) << "the fallback is not held to the range";
    EXPECT_EQ(object.text_or("absent", "plain"), "plain");
    EXPECT_EQ(object.integer_or("given", 0, 5, 9), 3);
    EXPECT_EQ(object.text_or("name", "plain"), "x");
    EXPECT_ERROR(object.integer_or("given", 0, 2, 1), "must lie between 0 and 2");
}

TEST(JsonObjectReading, AWrongTypeIsRefusedWhateverTheType) {
    Opened read(R"({"text": "1", "number": 1.5, "list": [1, "a"], "object": {}})");
    JsonObject& object = read.object;
    EXPECT_ERROR(object.text("number"), "/number: must be a text");
    EXPECT_ERROR(object.number("text", 0, 2), "/text: must be a number");
    EXPECT_ERROR(object.integer("number", 0, 2), "/number: must be a whole number");
    EXPECT_ERROR(object.boolean("number"), "/number: must be true or false");
    EXPECT_ERROR(object.numbers("list", 2), "/list: must hold numbers only");
    EXPECT_ERROR(object.numbers("list", 3), "/list: must be an array of 3 numbers");
    EXPECT_ERROR(object.numbers("object", 0), "/object: must be an array of 0 numbers");
    EXPECT_ERROR(object.texts("list"), "/list: must hold texts only");
    EXPECT_ERROR(object.texts("object"), "/object: must be an array of texts");
    EXPECT_ERROR(object.object("list"), "/list: must be an object");
    EXPECT_ERROR(object.objects("object"), "/object: must be an array of objects");
    EXPECT_ERROR(object.objects("list"), "/list/0: must be an object");
}

TEST(JsonObjectReading, RangesIncludeTheirEnds) {
    Opened read(R"({"a": 2, "b": 0.1})");
    JsonObject& object = read.object;
    EXPECT_EQ(object.number("a", 2.0, 2.0), 2.0);
    EXPECT_EQ(object.integer("a", 2, 2), 2);
    EXPECT_ERROR(object.number("b", 0.2, 1.0), "/b: is 0.1, must lie between 0.2 and 1");
    EXPECT_ERROR(object.integer("a", 3, 9), "/a: must lie between 3 and 9");
}

TEST(JsonObjectReading, WholeNumbersBeyond64BitsDoNotWrap) {
    constexpr auto kLowest = std::numeric_limits<std::int64_t>::min();
    constexpr auto kHighest = std::numeric_limits<std::int64_t>::max();
    Opened read(R"({"highest": 9223372036854775807, "above": 9223372036854775808,
                    "all_ones": 18446744073709551615, "lowest": -9223372036854775808})");
    JsonObject& object = read.object;
    EXPECT_EQ(object.integer("highest", kLowest, kHighest), kHighest);
    EXPECT_EQ(object.integer("lowest", kLowest, kHighest), kLowest);
    EXPECT_ERROR(object.integer("above", kLowest, kHighest), "must lie between");
    EXPECT_ERROR(object.integer("all_ones", -1, kHighest), "must lie between");
    EXPECT_ERROR(object.integer("highest", 0, kHighest - 1), "must lie between");
}

TEST(JsonObjectReading, ErrorsNameThePlaceHoweverDeep) {
    Opened read(R"({"sizes": [{"chart": {"waist": [1, 2]}}, {"chart": {"waist": "wide"}}]})");
    auto sizes = read.object.objects("sizes");
    JsonObject chart = sizes[1].object("chart");
    EXPECT_ERROR(chart.numbers("waist", 2), "a.json: /sizes/1/chart/waist: must be an array");
    EXPECT_THAT(chart.error("", "is odd").what(), HasSubstr("a.json: /sizes/1/chart: is odd"));
    EXPECT_THAT(read.object.error("", "is odd").what(), HasSubstr("a.json: /: is odd"));
}

TEST(JsonObjectReading, FinishRefusesTheFirstKeyThatNobodyRead) {
    Opened read(R"({"b": 1, "a": 2, "c": 3})");
    EXPECT_ERROR(read.object.finish(), "a.json: /a: is not a known key");
    (void)read.object.integer("a", 0, 9);
    EXPECT_ERROR(read.object.finish(), "/b: is not a known key");
    (void)read.object.integer("b", 0, 9);
    EXPECT_TRUE(read.object.has("c"));
    EXPECT_ERROR(read.object.finish(), "/c: is not a known key"); // asking is not reading
    EXPECT_THAT(read.object.keys(), ElementsAre("a", "b", "c"));
}

TEST(JsonObjectReading, OnlyAnObjectOpens) {
    const nlohmann::json list = parse("[1]");
    EXPECT_ERROR(JsonObject(list, "a.json"), "a.json: /: must be an object");
}

} // namespace
} // namespace toile
