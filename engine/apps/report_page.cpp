#include "apps/report_page.h"

#include "core/bytes.h"
#include "core/error.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;
using garment::GarmentFit;
using garment::RegionFit;

constexpr std::size_t kMostBytes = std::size_t{16} << 20; // of the skeleton, of the viewer

std::string line(const char* format, auto... values) {
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

std::string data_uri(const char* type, std::span<const std::uint8_t> bytes) {
    return std::string("data:") + type + ";base64," + base64(bytes);
}

std::string picture_uri(const imaging::Image& picture) {
    return data_uri("image/png", imaging::encode_png(picture));
}

/// "upper_arm_girth" -> "Upper arm girth"
std::string words(std::string_view name) {
    std::string out(name);
    std::replace(out.begin(), out.end(), '_', ' ');
    if (!out.empty() && out[0] >= 'a' && out[0] <= 'z') out[0] = static_cast<char>(out[0] - 32);
    return out;
}

std::string sentence(std::string text) {
    if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
        text[0] = static_cast<char>(text[0] - 32);
    if (!text.empty() && text.back() != '.') text += '.';
    return html_text(text);
}

std::string advice_of(const GarmentFit& fit) {
    std::string out = "<h2>" + html_text(fit.name) + "</h2>\n";
    if (fit.recommended_size && fit.between)
        out += "<p class=\"advice\">Between <b>" + html_text(*fit.recommended_size) +
               "</b> and <b>" + html_text(*fit.between) + "</b>: both can be worn.</p>\n";
    else if (fit.recommended_size)
        out += "<p class=\"advice\">Size <b>" + html_text(*fit.recommended_size) +
               "</b> is made for these measurements.</p>\n";
    if (fit.recommended_size && *fit.recommended_size != fit.size)
        out += "<p>The pictures show size <b>" + html_text(fit.size) + "</b>.</p>\n";
    for (const std::string& reason : fit.reasons)
        out += "<p class=\"quiet\">" + sentence(reason) + "</p>\n";
    out += "<ul class=\"regions\">\n";
    for (const RegionFit& region : fit.regions)
        out += "<li class=\"" + std::string(name_of(region.verdict)) + "\"><b>" +
               words(name_of(region.region)) + "</b>: " + sentence(region.text) + "</li>\n";
    for (const garment::LengthFit& length : fit.lengths)
        out += "<li>" + sentence(length.text) + "</li>\n";
    return out + "</ul>\n";
}

const garment::GirthFit* girth_of(const GarmentFit& fit, std::string_view name) {
    const auto found = std::find_if(fit.girths.begin(), fit.girths.end(),
                                    [name](const auto& girth) { return girth.name == name; });
    return found == fit.girths.end() ? nullptr : &*found;
}

const garment::RegionRule& rule_of(const RegionFit& region) {
    const auto rules = garment::region_rules();
    return *std::find_if(rules.begin(), rules.end(),
                         [&](const auto& rule) { return rule.region == region.region; });
}

/// Room of each region in each size, coloured by what it means there.
std::string sizes_of(const GarmentFit& fit) {
    std::string head = "<tr><th>Room, cm</th>";
    for (const std::string& size : fit.sizes)
        head += std::string("<th") + (size == fit.size ? " class=\"worn\"" : "") + ">" +
                html_text(size) + "</th>";
    std::string out =
        "<h3>" + html_text(fit.name) + "</h3>\n<div class=\"scroll\"><table>\n" + head + "</tr>\n";
    for (const RegionFit& region : fit.regions) {
        const garment::GirthFit* girth = girth_of(fit, region.girth);
        if (girth == nullptr || girth->sizes_m.size() != fit.sizes.size()) continue;
        out += "<tr><td>" + words(name_of(region.region)) + "</td>";
        for (std::size_t i = 0; i < fit.sizes.size(); ++i) {
            const double ease = girth->sizes_m[i] - girth->body_m;
            const garment::Verdict verdict = garment::verdict_of(
                ease, region.intended_m, region.ease_class, rule_of(region), girth->body_m);
            out += "<td class=\"" + std::string(name_of(verdict)) +
                   (fit.sizes[i] == fit.size ? " worn" : "") + "\">" + line("%+.1f", 100.0 * ease) +
                   "</td>";
        }
        out += "</tr>\n";
    }
    return out + "</table></div>\n";
}

std::string measurements_of(const std::vector<body::LaidMeasurement>& measurements) {
    std::string out = "<table>\n<tr><th>Measurement</th><th>cm</th><th>Confidence</th></tr>\n";
    for (const body::LaidMeasurement& m : measurements)
        out += "<tr><td>" + words(m.definition->name) + "</td><td>" +
               line("%.1f</td><td>%.2f", 100.0 * m.reading.value_m, m.reading.confidence) +
               "</td></tr>\n";
    return out + "</table>";
}

/// A script element ends at the first closing tag, wherever that stands in the code.
std::string inline_script(std::string code) {
    for (std::size_t at = 0; (at = code.find("</script", at)) != std::string::npos; at += 9)
        code.replace(at, 8, "<\\/script");
    return code;
}

std::string text_of(const fs::path& file) {
    const auto bytes = read_bytes(file, kMostBytes);
    return {bytes.begin(), bytes.end()};
}

std::string viewer_code(const fs::path& folder) {
    const fs::path file =
        folder / "node_modules" / "@google" / "model-viewer" / "dist" / "model-viewer.min.js";
    if (!fs::exists(file)) throw Error(file.string() + ": is not there; scripts/setup fetches it");
    return inline_script(text_of(file));
}

} // namespace

std::string html_text(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (const char c : text)
        switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        default:
            out += c;
        }
    return out;
}

std::string base64(std::span<const std::uint8_t> bytes) {
    static constexpr char kLetters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += k <= count ? kLetters[group >> (18 - 6 * k) & 63u] : '=';
    }
    return out;
}

std::string report_page(const ReportContent& content, const fs::path& folder) {
    std::map<std::string, std::string> parts;
    parts["title"] = html_text(content.title);
    parts["subtitle"] = html_text(content.subtitle);
    parts["look"] = data_uri("model/gltf-binary", content.look);
    parts["poster"] = picture_uri(content.pictures.views.front().second);
    for (const GarmentFit& fit : content.fit.garments) {
        parts["advice"] += advice_of(fit);
        parts["sizes"] += sizes_of(fit);
    }
    for (const auto& [caption, picture] : content.pictures.views)
        parts["views"] +=
            "<img src=\"" + picture_uri(picture) + "\" alt=\"" + html_text(caption) + "\">\n";
    for (const auto* map : {&content.pictures.ease_map, &content.pictures.strain_map})
        parts["maps"] +=
            "<img class=\"wide\" src=\"" + picture_uri(*map) + "\" alt=\"Map of the fit\">\n";
    parts["tapes"] = picture_uri(content.pictures.tapes);
    parts["measurements"] = measurements_of(content.measurements);
    for (const std::string& note : content.notes)
        parts["notes"] += sentence(note) + " ";
    parts["viewer"] = viewer_code(folder);

    const std::string page = text_of(folder / "page.html");
    std::string out;
    std::size_t at = 0;
    for (std::size_t open = 0; (open = page.find("{{", at)) != std::string::npos;) {
        const std::size_t close = page.find("}}", open);
        const auto part = close == std::string::npos
                              ? parts.end()
                              : parts.find(page.substr(open + 2, close - open - 2));
        if (part == parts.end())
            throw FileError((folder / "page.html").string(),
                            "names a part that there is not: " + page.substr(open, 24));
        out += page.substr(at, open - at) + part->second;
        at = close + 2;
    }
    return out + page.substr(at);
}

} // namespace toile::apps
