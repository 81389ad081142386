#include "garment/dxf_reader.h"

#include "core/bytes.h"
#include "core/error.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace toile::garment::block {
namespace {

constexpr std::size_t kMostBytes = 50u << 20;
constexpr int kCut = 1, kTurn = 2, kNotch = 4, kGrain = 7, kSew = 14;

struct Group {
    int code = 0;
    std::string_view value;
};

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) {
        text.remove_prefix(1);
    }
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) {
        text.remove_suffix(1);
    }
    return text;
}

std::vector<Group> split(const std::string_view text, const std::string& file) {
    std::vector<Group> groups;
    std::size_t at = 0;
    std::size_t row = 0;
    const auto line = [&]() {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view out = trimmed(text.substr(at, end - at));
        at = end + 1;
        ++row;
        return out;
    };
    while (at < text.size()) {
        const std::string_view code = line();
        if (code.empty() && at >= text.size()) {
            break;
        }
        Group& group = groups.emplace_back();
        const auto read = std::from_chars(code.data(), code.data() + code.size(), group.code);
        if (read.ec != std::errc() || read.ptr != code.data() + code.size() || at > text.size()) {
            throw Error(file + ": line " + std::to_string(row) +
                        " is no group code: this is no DXF text file");
        }
        group.value = line();
    }
    return groups;
}

// One entity's or table row's groups.
struct Entity {
    std::string_view type;
    std::span<const Group> groups;

    [[nodiscard]] std::optional<std::string_view> text(const int code) const {
        for (const Group& group : groups) {
            if (group.code == code) {
                return group.value;
            }
        }
        return std::nullopt;
    }
    [[nodiscard]] double number(const int code) const {
        double value = 0.0;
        if (const auto found = text(code)) {
            const auto read = std::from_chars(found->data(), found->data() + found->size(), value);
            value = read.ec == std::errc() ? value : std::nan("");
        }
        return value;
    }
    [[nodiscard]] int layer() const {
        const double value = number(8);
        return value >= 0.0 && value < 1000.0 ? static_cast<int>(value) : -1;
    }
};

std::vector<Entity> entities_of(const std::vector<Group>& groups) {
    std::vector<Entity> out;
    for (std::size_t i = 0; i < groups.size();) {
        std::size_t next = i + 1;
        while (next < groups.size() && groups[next].code != 0) {
            ++next;
        }
        if (groups[i].code == 0) {
            out.push_back({groups[i].value, {groups.data() + i + 1, next - i - 1}});
        }
        i = next;
    }
    return out;
}

struct Block {
    std::string name;
    std::vector<Vec2d> cut, sew, turns, notches;
    std::optional<Vec2d> grain; ///< direction
};

void add_line(Block& block, const int layer, std::vector<Vec2d> points) {
    auto& line = layer == kSew ? block.sew : block.cut;
    if (points.size() > line.size()) { // the longest is the outline; cut-outs are shorter
        line = std::move(points);
    }
}

std::vector<Vec2d> light_polyline(const Entity& entity) {
    std::vector<Vec2d> points;
    for (const Group& group : entity.groups) {
        double value = 0.0;
        std::from_chars(group.value.data(), group.value.data() + group.value.size(), value);
        if (group.code == 10) {
            points.emplace_back(value, 0.0);
        } else if (group.code == 20 && !points.empty()) {
            points.back().y() = value;
        }
    }
    return points;
}

std::string upper(const std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return out;
}

// Metres a unit, when a text says so.
std::optional<double> unit_of(const std::string_view text) {
    const std::string words = upper(text);
    if (words.find("UNITS") == std::string::npos) {
        return std::nullopt;
    }
    return words.find("ENGLISH") != std::string::npos ? 0.0254 : 0.001;
}

struct Drawing {
    std::vector<Block> blocks;
    double unit = 0.001;
};

Drawing read_drawing(const std::vector<Group>& groups) {
    Drawing drawing;
    std::optional<double> said;
    for (std::size_t i = 0; i + 1 < groups.size(); ++i) {
        if (groups[i].code == 9 && groups[i].value == "$INSUNITS" && groups[i + 1].value == "1") {
            drawing.unit = 0.0254;
        }
    }
    Block* block = nullptr;
    std::vector<Vec2d> line;
    int line_layer = -1;
    for (const Entity& e : entities_of(groups)) {
        if (e.type == "TEXT") {
            const std::string_view text = e.text(1).value_or("");
            if (const auto unit = unit_of(text)) {
                said = unit;
            }
            const std::string words = upper(text);
            if (block != nullptr && words.rfind("PIECE NAME:", 0) == 0) {
                block->name = std::string(trimmed(text.substr(11)));
            }
        }
        if (e.type == "BLOCK") {
            block = &drawing.blocks.emplace_back();
            block->name = std::string(e.text(2).value_or("piece"));
        } else if (e.type == "ENDBLK") {
            block = nullptr;
        }
        if (block == nullptr) {
            continue;
        }
        const Vec2d at(e.number(10), e.number(20));
        if (e.type == "POLYLINE") {
            line.clear();
            line_layer = e.layer();
        } else if (e.type == "VERTEX") {
            line.push_back(at);
        } else if (e.type == "SEQEND") {
            if (line_layer == kCut || line_layer == kSew) {
                add_line(*block, line_layer, line);
            }
        } else if (e.type == "LWPOLYLINE" && (e.layer() == kCut || e.layer() == kSew)) {
            add_line(*block, e.layer(), light_polyline(e));
        } else if (e.type == "POINT" && e.layer() == kTurn) {
            block->turns.push_back(at);
        } else if (e.type == "POINT" && e.layer() == kNotch) {
            block->notches.push_back(at);
        } else if (e.type == "LINE" && e.layer() == kGrain) {
            block->grain = Vec2d(e.number(11), e.number(21)) - at;
        }
    }
    drawing.unit = said.value_or(drawing.unit);
    return drawing;
}

// Corners: where the outline turns by more than 20 degrees.
std::vector<Vec2d> corners_of(const std::vector<Vec2d>& outline) {
    std::vector<Vec2d> corners;
    const std::size_t n = outline.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2d in = (outline[i] - outline[(i + n - 1) % n]).normalized();
        const Vec2d out = (outline[(i + 1) % n] - outline[i]).normalized();
        if (in.dot(out) < std::cos(20.0 * std::numbers::pi / 180.0)) {
            corners.push_back(outline[i]);
        }
    }
    return corners;
}

void name_points(PatternPiece& piece, std::vector<Vec2d> points, const char* prefix) {
    const OutlineWalk walk(piece.outline);
    std::vector<std::pair<double, Vec2d>> sorted;
    for (const Vec2d& p : points) {
        double off = 0.0;
        const double place = walk.project(p, off);
        if (off < 0.02) { // what lies inside is a drill hole or a mark
            sorted.emplace_back(place, walk.at(place));
        }
    }
    std::sort(sorted.begin(), sorted.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    std::size_t count = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (i == 0 || sorted[i].first > sorted[i - 1].first + 1e-4) {
            piece.points[prefix + std::to_string(count++)] = sorted[i].second;
        }
    }
}

PatternPiece piece_of(Block block, const double unit) {
    PatternPiece piece;
    piece.name = block.name;
    piece.outline = block.sew.size() >= 3 ? block.sew : block.cut;
    double turn = 0.0;
    if (block.grain && block.grain->norm() > 0.0) {
        turn = std::numbers::pi / 2.0 - std::atan2(block.grain->y(), block.grain->x());
        // A grain has no direction: the smaller turn.
        turn -= std::numbers::pi * std::round(turn / std::numbers::pi);
    }
    const Eigen::Rotation2Dd rotation(turn);
    const auto move = [&](std::vector<Vec2d>& points) {
        for (Vec2d& p : points) {
            p = unit * (rotation * p);
        }
    };
    move(piece.outline);
    move(block.turns);
    move(block.notches);
    check_piece(piece);
    const auto first =
        std::min_element(piece.outline.begin(), piece.outline.end(),
                         [](const Vec2d& a, const Vec2d& b) { return a.sum() < b.sum(); });
    std::rotate(piece.outline.begin(), first, piece.outline.end());
    name_points(piece, block.turns.empty() ? corners_of(piece.outline) : block.turns, "p");
    name_points(piece, block.notches, "n");
    return piece;
}

} // namespace

std::vector<PatternPiece> read_dxf(const std::filesystem::path& file) {
    const std::vector<std::uint8_t> bytes = read_bytes(file, kMostBytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::vector<Group> groups = split(text, file.string());
    const Drawing drawing = read_drawing(groups);
    std::vector<PatternPiece> pieces;
    for (const Block& block : drawing.blocks) {
        if (block.cut.size() < 3 && block.sew.size() < 3) {
            continue; // a block of text or of marks
        }
        try {
            pieces.push_back(piece_of(block, drawing.unit));
        } catch (const Error& error) {
            throw Error(file.string() + ": " + error.what());
        }
    }
    if (pieces.empty()) {
        throw Error(file.string() +
                    ": holds no piece: no block has a closed line on layer 1 or 14");
    }
    return pieces;
}

} // namespace toile::garment::block
