// PLY, read by hand: assimp's reader crashes on damaged files, and scans come from anywhere.
#include "assets/formats.h"
#include "core/bytes.h"
#include "core/log.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <span>
#include <string_view>

namespace toile::assets {
namespace {

enum class Type { invalid, i8, u8, i16, u16, i32, u32, f32, f64 };

std::size_t size_of(Type type) {
    switch (type) {
    case Type::i8:
    case Type::u8:
        return 1;
    case Type::i16:
    case Type::u16:
        return 2;
    case Type::f64:
        return 8;
    default:
        return 4;
    }
}

struct Property {
    std::string name;
    Type type = Type::invalid;
    Type count = Type::invalid; // of a list; invalid: a single value
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

template <typename T>
double load(const std::uint8_t* data, bool swap) {
    std::array<std::uint8_t, sizeof(T)> bytes;
    std::memcpy(bytes.data(), data, sizeof(T));
    if (swap) std::reverse(bytes.begin(), bytes.end());
    return static_cast<double>(std::bit_cast<T>(bytes));
}

class PlyReader {
  public:
    PlyReader(std::span<const std::uint8_t> bytes, Budget& budget)
        : bytes_(bytes), budget_(budget) {}

    Scene run() {
        read_header();
        for (const Element& element : elements_) {
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else
                skip(element);
        }
        if (primitive_.positions.empty() || primitive_.triangles.empty())
            throw budget_.error("holds no triangles");
        Scene scene;
        scene.meshes.push_back({"mesh", {std::move(primitive_)}, {}});
        scene.nodes.emplace_back();
        scene.nodes[0].name = "mesh";
        scene.nodes[0].mesh = 0;
        return scene;
    }

  private:
    std::string_view line() {
        const std::string_view rest(reinterpret_cast<const char*>(bytes_.data()) + at_,
                                    bytes_.size() - at_);
        const std::size_t end = rest.find('\n');
        if (end == std::string_view::npos) throw budget_.error("its header does not end");
        at_ += end + 1;
        std::string_view text = rest.substr(0, end);
        if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
        return text;
    }

    static std::vector<std::string> words(std::string_view text) {
        std::vector<std::string> result;
        for (;;) {
            const std::size_t begin = text.find_first_not_of(" \t");
            if (begin == std::string_view::npos) return result;
            text.remove_prefix(begin);
            const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
            result.emplace_back(text.substr(0, end));
            text.remove_prefix(end);
        }
    }

    Type type(const std::string& name) const {
        static const std::map<std::string, Type> types = {
            {"char", Type::i8},    {"int8", Type::i8},     {"uchar", Type::u8},
            {"uint8", Type::u8},   {"short", Type::i16},   {"int16", Type::i16},
            {"ushort", Type::u16}, {"uint16", Type::u16},  {"int", Type::i32},
            {"int32", Type::i32},  {"uint", Type::u32},    {"uint32", Type::u32},
            {"float", Type::f32},  {"float32", Type::f32}, {"double", Type::f64},
            {"float64", Type::f64}};
        const auto it = types.find(name);
        if (it == types.end())
            throw budget_.error("its header names the unknown type '" + name.substr(0, 40) + "'");
        return it->second;
    }

    void read_header() {
        if (line() != "ply") throw budget_.error("not a PLY file");
        bool format = false;
        for (std::string_view text = line(); text != "end_header"; text = line()) {
            const std::vector<std::string> w = words(text);
            if (w.empty() || w[0] == "comment" || w[0] == "obj_info") continue;
            if (w[0] == "format" && w.size() == 3) {
                format = true;
                ascii_ = w[1] == "ascii";
                swap_ = w[1] == "binary_big_endian";
                if (!ascii_ && !swap_ && w[1] != "binary_little_endian")
                    throw budget_.error("has the unknown format '" + w[1].substr(0, 40) + "'");
            } else if (w[0] == "element" && w.size() == 3) {
                std::size_t count = 0;
                const auto [end, problem] =
                    std::from_chars(w[2].data(), w[2].data() + w[2].size(), count);
                if (problem != std::errc() || end != w[2].data() + w[2].size())
                    throw budget_.error("'" + w[2].substr(0, 40) + "' is not a count");
                if (count > bytes_.size())
                    throw budget_.error("claims " + std::to_string(count) + " of '" +
                                        w[1].substr(0, 40) + "', more than its " +
                                        std::to_string(bytes_.size()) + " bytes can hold");
                elements_.push_back({w[1], count, {}});
            } else if (w[0] == "property" && !elements_.empty() && w.size() == 3) {
                elements_.back().properties.push_back({w[2], type(w[1]), Type::invalid});
            } else if (w[0] == "property" && !elements_.empty() && w.size() == 5 &&
                       w[1] == "list") {
                elements_.back().properties.push_back({w[4], type(w[3]), type(w[2])});
            } else {
                throw budget_.error("its header has the line '" + std::string(text.substr(0, 60)) +
                                    "'");
            }
        }
        if (!format) throw budget_.error("its header names no format");
        for (const Element& element : elements_)
            if (element.count > 0 && element.properties.empty())
                throw budget_.error("its '" + element.name.substr(0, 40) + "' has no properties");
    }

    double value(Type type) {
        if (ascii_) {
            const char* begin = reinterpret_cast<const char*>(bytes_.data());
            while (at_ < bytes_.size() && (begin[at_] == ' ' || begin[at_] == '\t' ||
                                           begin[at_] == '\r' || begin[at_] == '\n'))
                ++at_;
            double number = 0.0;
            const auto [end, problem] = std::from_chars(begin + at_, begin + bytes_.size(), number);
            if (problem != std::errc())
                throw budget_.error(at_ == bytes_.size() ? "ends too early (cut off?)"
                                                         : "has a value that is not a number");
            at_ = static_cast<std::size_t>(end - begin);
            return number;
        }
        const std::size_t size = size_of(type);
        if (bytes_.size() - at_ < size) throw budget_.error("ends too early (cut off?)");
        const std::uint8_t* data = bytes_.data() + at_;
        at_ += size;
        switch (type) {
        case Type::i8:
            return load<std::int8_t>(data, swap_);
        case Type::u8:
            return load<std::uint8_t>(data, swap_);
        case Type::i16:
            return load<std::int16_t>(data, swap_);
        case Type::u16:
            return load<std::uint16_t>(data, swap_);
        case Type::i32:
            return load<std::int32_t>(data, swap_);
        case Type::u32:
            return load<std::uint32_t>(data, swap_);
        case Type::f64:
            return load<double>(data, swap_);
        default:
            return load<float>(data, swap_);
        }
    }

    // Values of a property: one, or as many as its list holds.
    void values(const Property& property, std::vector<double>& result) {
        result.clear();
        if (property.count == Type::invalid) {
            result.push_back(value(property.type));
            return;
        }
        const double count = value(property.count);
        if (!(count >= 0.0 && count <= static_cast<double>(bytes_.size() - at_)))
            throw budget_.error("has a list of " + std::to_string(count) + " values");
        for (double i = 0.0; i < count; i += 1.0)
            result.push_back(value(property.type));
    }

    void skip(const Element& element) {
        log::debug(budget_.file() + ": its '" + element.name + "' elements are not used");
        std::vector<double> ignored;
        for (std::size_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties)
                values(property, ignored);
    }

    void read_vertices(const Element& element) {
        static const std::map<std::string, int> slots = {
            {"x", 0},         {"y", 1},         {"z", 2},   {"nx", 3},    {"ny", 4},
            {"nz", 5},        {"s", 6},         {"t", 7},   {"u", 6},     {"v", 7},
            {"texture_u", 6}, {"texture_v", 7}, {"red", 8}, {"green", 9}, {"blue", 10}};
        std::vector<int> slot;
        std::array<bool, 11> present{};
        for (const Property& property : element.properties) {
            const auto it = slots.find(property.name);
            slot.push_back(it == slots.end() || property.count != Type::invalid ? -1 : it->second);
            if (slot.back() >= 0) present[static_cast<std::size_t>(slot.back())] = true;
        }
        if (!present[0] || !present[1] || !present[2])
            throw budget_.error("its vertices have no x, y and z");
        const bool normals = present[3] && present[4] && present[5];
        const bool texcoords = present[6] && present[7];
        const bool colors = present[8] && present[9] && present[10];
        float full = 255.0f; // what a colour's property counts up to
        for (const Property& property : element.properties) {
            if (property.name != "red") continue;
            if (property.type == Type::f32 || property.type == Type::f64) full = 1.0f;
            if (property.type == Type::u16) full = 65535.0f;
        }
        budget_.add_mesh(element.count, 0, "vertices");
        std::vector<double> ignored;
        for (std::size_t i = 0; i < element.count; ++i) {
            std::array<float, 11> v{};
            for (std::size_t p = 0; p < slot.size(); ++p) {
                values(element.properties[p], ignored);
                if (slot[p] >= 0)
                    v[static_cast<std::size_t>(slot[p])] = static_cast<float>(ignored[0]);
            }
            for (const float c : v)
                if (!std::isfinite(c))
                    throw budget_.error("vertex " + std::to_string(i) + " is not finite");
            primitive_.positions.emplace_back(v[0], v[1], v[2]);
            if (normals) primitive_.normals.emplace_back(v[3], v[4], v[5]);
            if (texcoords) primitive_.texcoords.emplace_back(v[6], 1.0f - v[7]);
            if (!colors) continue;
            auto& color = primitive_.colors.emplace_back();
            for (std::size_t k = 0; k < 3; ++k)
                color[k] = static_cast<std::uint8_t>(
                    std::lround(255.0f * std::clamp(v[8 + k] / full, 0.0f, 1.0f)));
            color[3] = 255;
        }
    }

    void read_faces(const Element& element) {
        std::vector<double> corners;
        std::vector<double> ignored;
        bool listed = false;
        for (const Property& property : element.properties)
            listed = listed || indices(property);
        if (!listed && element.count > 0) throw budget_.error("its faces have no vertex_indices");
        for (std::size_t i = 0; i < element.count; ++i) {
            for (const Property& property : element.properties)
                values(property, indices(property) ? corners : ignored);
            if (corners.size() < 3)
                throw budget_.error("face " + std::to_string(i) + " has fewer than 3 corners");
            for (const double c : corners)
                if (!(c >= 0.0 && c < static_cast<double>(primitive_.positions.size())))
                    throw budget_.error("face " + std::to_string(i) +
                                        " has an index out of range (it has " +
                                        std::to_string(primitive_.positions.size()) + " vertices)");
            for (std::size_t k = 1; k + 1 < corners.size(); ++k)
                primitive_.triangles.push_back({static_cast<std::uint32_t>(corners[0]),
                                                static_cast<std::uint32_t>(corners[k]),
                                                static_cast<std::uint32_t>(corners[k + 1])});
            if (primitive_.triangles.size() > budget_.limits().max_triangles)
                throw budget_.error("more than " + std::to_string(budget_.limits().max_triangles) +
                                    " triangles");
        }
    }

    static bool indices(const Property& property) {
        return property.count != Type::invalid &&
               (property.name == "vertex_indices" || property.name == "vertex_index");
    }

    std::span<const std::uint8_t> bytes_;
    Budget& budget_;
    std::size_t at_ = 0;
    bool ascii_ = false;
    bool swap_ = false; // the file is big-endian
    std::vector<Element> elements_;
    Primitive primitive_;
};

} // namespace

Scene read_ply(const std::filesystem::path& file, Budget& budget) {
    const std::vector<std::uint8_t> bytes = read_bytes(file, budget.limits().max_file_bytes);
    return PlyReader(bytes, budget).run();
}

} // namespace toile::assets
