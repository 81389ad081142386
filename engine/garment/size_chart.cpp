#include "garment/size_chart.h"

#include "body/measurement.h"
#include "core/error.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>

namespace toile::garment {
namespace {

namespace fs = std::filesystem;

constexpr double kLeast_m = 0.03, kMost_m = 3.0; // of a measurement of somebody's

struct Column {
    std::string measurement;
    double unit_m = 0.0; ///< 0: by the number's size
};

std::string trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\"\xEF\xBB\xBF"; // and a byte order mark
    const auto begin = text.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return "";
    return std::string(text.substr(begin, text.find_last_not_of(kBlank) + 1 - begin));
}

std::vector<std::string> cells_of(const std::string& line, char separator) {
    std::vector<std::string> out;
    std::size_t from = 0;
    for (std::size_t at = 0; at != std::string::npos; from = at + 1) {
        at = line.find(separator, from);
        out.push_back(
            trimmed(std::string_view(line).substr(from, at == std::string::npos ? at : at - from)));
    }
    return out;
}

/// What shops call it.
const std::map<std::string, std::string>& usual_names() {
    static const std::map<std::string, std::string> kNames{
        {"bust", "bust_girth"}, {"chest", "bust_girth"},        {"waist", "waist_girth"},
        {"hip", "hip_girth"},   {"hips", "hip_girth"},          {"seat", "hip_girth"},
        {"neck", "neck_girth"}, {"collar", "neck_girth"},       {"thigh", "thigh_girth"},
        {"height", "stature"},  {"inseam", "inside_leg_length"}};
    return kNames;
}

Column column_of(const std::string& title, const std::string& file) {
    std::string name;
    for (const char c : title)
        if (c != ' ' && c != '(' && c != ')')
            name.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
        else if (!name.empty() && name.back() != '_')
            name.push_back('_');
    while (!name.empty() && name.back() == '_')
        name.pop_back();
    Column out;
    for (const auto& [unit, metres] :
         {std::pair{"_cm", 0.01}, std::pair{"_mm", 0.001}, std::pair{"_m", 1.0},
          std::pair{"_inch", 0.0254}, std::pair{"_in", 0.0254}})
        if (name.ends_with(unit) && out.unit_m == 0.0) {
            out.unit_m = metres;
            name.erase(name.size() - std::string_view(unit).size());
        }
    if (const auto usual = usual_names().find(name); usual != usual_names().end())
        name = usual->second;
    try {
        out.measurement = body::measurement_definition(name).name;
    } catch (const Error& e) {
        throw FileError(file, "line 1: the column '" + title + "': " + e.what() +
                                  "; write bust, waist, hip, thigh, neck, or one of those");
    }
    return out;
}

/// Of the text from `at` on, which goes on behind it.
double number(const std::string& text, std::size_t& at, const Column& column,
              const std::string& where) {
    while (at < text.size() && text[at] == ' ')
        ++at;
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data() + at, end, value);
    if (read.ec != std::errc())
        throw Error(where + " is '" + text + "'; write one number, as 92, or two, as 88-96");
    at = static_cast<std::size_t>(read.ptr - text.data());
    while (at < text.size() && text[at] == ' ')
        ++at;
    const double metres = value * (column.unit_m > 0.0 ? column.unit_m
                                   : value > kMost_m   ? 0.01
                                                       : 1.0);
    if (!(metres >= kLeast_m && metres <= kMost_m))
        throw Error(where + " is '" + text + "', " + std::to_string(metres) +
                    " m: out of 0.03 to 3 m; give the unit in the first line, as 'waist in'");
    return metres;
}

ChartRange range_of(std::string text, bool decimal_comma, const Column& column,
                    const std::string& where) {
    for (const char* dash : {"\xE2\x80\x93", "\xE2\x80\x94"}) // en and em dash
        if (const auto found = text.find(dash); found != std::string::npos)
            text.replace(found, 3, "-");
    if (decimal_comma) std::replace(text.begin(), text.end(), ',', '.');
    ChartRange out;
    std::size_t at = 0;
    out.minimum = out.maximum = number(text, at, column, where);
    if (at < text.size() && text[at] == '-') out.maximum = number(text, ++at, column, where);
    if (at != text.size())
        throw Error(where + " is '" + text + "'; write one number, as 92, or two, as 88-96");
    if (out.minimum > out.maximum)
        throw Error(where + " is '" + text + "': the first number is the larger one");
    return out;
}

} // namespace

SizeChart read_size_chart(const fs::path& file) {
    const std::string shown = file.string();
    std::ifstream in(file);
    if (!in) throw FileError(shown, "cannot be read");
    std::string line;
    std::getline(in, line);
    const char separator = line.find(';') != std::string::npos    ? ';'
                           : line.find('\t') != std::string::npos ? '\t'
                                                                  : ',';
    const std::vector<std::string> titles = cells_of(line, separator);
    if (titles.size() < 2)
        throw FileError(shown, "line 1: must name the columns, as 'size,bust,waist,hip'");
    std::vector<Column> columns;
    for (std::size_t i = 1; i < titles.size(); ++i)
        columns.push_back(column_of(titles[i], shown));
    SizeChart out;
    for (std::size_t number = 2; std::getline(in, line); ++number) {
        if (trimmed(line).empty()) continue;
        const std::vector<std::string> cells = cells_of(line, separator);
        const std::string where = shown + ": line " + std::to_string(number);
        if (cells.size() != titles.size())
            throw Error(where + " has " + std::to_string(cells.size()) + " cells, the first " +
                        std::to_string(titles.size()));
        if (cells[0].empty()) throw Error(where + " names no size");
        const bool known = std::any_of(out.begin(), out.end(),
                                       [&](const auto& row) { return row.first == cells[0]; });
        if (known) throw Error(where + ": size " + cells[0] + " stands twice");
        auto& row = out.emplace_back(cells[0], std::map<std::string, ChartRange>{}).second;
        for (std::size_t i = 1; i < cells.size(); ++i)
            if (!cells[i].empty())
                row[columns[i - 1].measurement] = range_of(
                    cells[i], separator != ',', columns[i - 1], where + ", '" + titles[i] + "'");
    }
    if (out.empty()) throw FileError(shown, "has no size");
    return out;
}

} // namespace toile::garment
