// OBJ, read by hand: assimp numbers the vertices anew, and weights, shape targets and cloth
// records refer to them by their place in the file. Here vertices stay in that order.
#include "assets/formats.h"
#include "core/bytes.h"
#include "core/log.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>

namespace toile::assets {
namespace {

struct Corner {
    std::uint32_t position = 0;
    std::uint32_t texcoord = 0; // + 1; 0: none
    std::uint32_t normal = 0;   // + 1; 0: none

    auto operator<=>(const Corner&) const = default;
};

// Triangles of one group and one material.
struct Part {
    std::string group;
    int material = kNone;
    std::vector<std::array<Corner, 3>> triangles;
};

// Words of one line; a backslash at a line's end is not part of anything we read.
class Words {
  public:
    explicit Words(std::string_view line) : rest_(line) {}

    std::string_view next() {
        const std::size_t begin = std::min(rest_.find_first_not_of(" \t\r"), rest_.size());
        rest_.remove_prefix(begin);
        const std::size_t end = std::min(rest_.find_first_of(" \t\r"), rest_.size());
        const std::string_view word = rest_.substr(0, end);
        rest_.remove_prefix(end);
        return word;
    }
    // All that is left, for names with spaces.
    std::string rest() {
        std::string text;
        for (std::string_view word = next(); !word.empty(); word = next())
            text += (text.empty() ? "" : " ") + std::string(word);
        return text;
    }

  private:
    std::string_view rest_;
};

// Calls `read(keyword, words)` for each line of a text file that is not empty or a comment.
template <typename Read>
void for_each_line(std::string_view text, std::size_t& number, const Read& read) {
    for (number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        Words words(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::string_view keyword = words.next();
        if (!keyword.empty() && keyword.front() != '#') read(keyword, words);
    }
}

class ObjReader {
  public:
    ObjReader(std::filesystem::path file, Budget& budget)
        : file_(std::move(file)), budget_(budget) {}

    Scene run() {
        const std::vector<std::uint8_t> bytes = read_bytes(file_, budget_.limits().max_file_bytes);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        for_each_line(text, line_, [this](std::string_view keyword, Words& words) {
            if (keyword == "v") {
                positions_.push_back(vector<3>(words));
            } else if (keyword == "vt") {
                const Vec2f uv = vector<2>(words);
                texcoords_.emplace_back(uv.x(), 1.0f - uv.y()); // OBJ counts from the bottom
            } else if (keyword == "vn") {
                normals_.push_back(vector<3>(words));
            } else if (keyword == "f") {
                read_face(words);
            } else if (keyword == "g" || keyword == "o") {
                group_ = words.rest();
                part_ = nullptr;
            } else if (keyword == "usemtl") {
                material_ = material(words.rest());
                part_ = nullptr;
            } else if (keyword == "mtllib") {
                read_materials(words.rest());
            }
        });
        if (parts_.empty()) throw budget_.error("holds no faces");
        build();
        return std::move(scene_);
    }

  private:
    [[nodiscard]] FileError fail(const std::string& what) const {
        return budget_.error("line " + std::to_string(line_) + ": " + what);
    }

    float number(std::string_view word) const {
        float value = 0.0f;
        const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (problem != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
            throw fail("'" + std::string(word.substr(0, 40)) + "' is not a finite number");
        return value;
    }

    template <int Count>
    Eigen::Matrix<float, Count, 1> vector(Words& words) const {
        Eigen::Matrix<float, Count, 1> v;
        for (int k = 0; k < Count; ++k) {
            const std::string_view word = words.next();
            if (word.empty()) throw fail("needs " + std::to_string(Count) + " numbers");
            v[k] = number(word);
        }
        return v;
    }

    // 1-based, or negative from the end; returned + 1.
    std::uint32_t index(std::string_view word, std::size_t count, const char* what) const {
        std::int64_t value = 0;
        const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (problem != std::errc() || end != word.data() + word.size())
            throw fail("'" + std::string(word.substr(0, 40)) + "' is not an index");
        const auto size = static_cast<std::int64_t>(count);
        const std::int64_t place = value < 0 ? size + value + 1 : value;
        if (place < 1 || place > size)
            throw fail("index " + std::to_string(value) + " is out of range (" +
                       std::to_string(count) + " " + what + " so far)");
        return static_cast<std::uint32_t>(place);
    }

    Corner corner(std::string_view word) const {
        Corner result;
        const std::size_t first = word.find('/');
        result.position = index(word.substr(0, first), positions_.size(), "vertices") - 1;
        if (first == std::string_view::npos) return result;
        word.remove_prefix(first + 1);
        const std::size_t second = word.find('/');
        const std::string_view texcoord = word.substr(0, second);
        if (!texcoord.empty())
            result.texcoord = index(texcoord, texcoords_.size(), "texture coordinates");
        if (second == std::string_view::npos) return result;
        result.normal = index(word.substr(second + 1), normals_.size(), "normals");
        return result;
    }

    void read_face(Words& words) {
        std::vector<Corner> corners;
        for (std::string_view word = words.next(); !word.empty(); word = words.next())
            corners.push_back(corner(word));
        if (corners.size() < 3) throw fail("a face needs at least 3 corners");
        if (part_ == nullptr) part_ = &part();
        for (std::size_t k = 1; k + 1 < corners.size(); ++k) // convex polygons, as a fan
            part_->triangles.push_back({corners[0], corners[k], corners[k + 1]});
        triangle_count_ += corners.size() - 2;
        if (triangle_count_ > budget_.limits().max_triangles)
            throw fail("more than " + std::to_string(budget_.limits().max_triangles) +
                       " triangles");
    }

    Part& part() {
        const auto [it, fresh] = part_of_.try_emplace({group_, material_}, parts_.size());
        if (fresh) parts_.push_back({group_, material_, {}});
        return parts_[it->second];
    }

    int material(const std::string& name) {
        const auto [it, fresh] =
            material_of_.try_emplace(name, static_cast<int>(scene_.materials.size()));
        if (fresh) {
            scene_.materials.emplace_back();
            scene_.materials.back().name = name;
        }
        return it->second;
    }

    // A file named by this one must stand in its folder or below.
    std::filesystem::path beside(const std::string& name) const {
        const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
        if (relative.empty() || relative.is_absolute() || *relative.begin() == "..")
            throw fail("names a file outside its folder: " + name);
        return file_.parent_path() / relative;
    }

    void read_materials(const std::string& name) {
        const std::filesystem::path library = beside(name);
        if (!std::filesystem::exists(library)) {
            log::warning(file_.string() + ": its materials '" + name + "' are missing");
            return;
        }
        const std::vector<std::uint8_t> bytes = read_bytes(library, 16u << 20);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        int current = kNone;
        const std::size_t line = line_;
        for_each_line(text, line_, [&](std::string_view keyword, Words& words) {
            if (keyword == "newmtl") {
                current = material(words.rest());
                return;
            }
            if (current == kNone) return;
            Material& target = scene_.materials[static_cast<std::size_t>(current)];
            if (keyword == "Kd")
                target.base_color.head<3>() = vector<3>(words);
            else if (keyword == "map_Kd")
                target.base_color_texture = texture(words.rest());
        });
        line_ = line;
    }

    int texture(const std::string& name) {
        const auto [it, fresh] =
            texture_of_.try_emplace(name, static_cast<int>(scene_.textures.size()));
        if (fresh) {
            const std::filesystem::path picture = beside(name);
            if (!std::filesystem::exists(picture))
                throw budget_.error("the texture '" + name + "' is missing");
            scene_.textures.push_back(
                {name,
                 imaging::load_image(picture, static_cast<int>(budget_.limits().max_texture_side)),
                 false});
            budget_.take(scene_.textures.back().image.pixels.size(), 1, name);
        }
        return it->second;
    }

    // One mesh per group, one primitive per material in it.
    void build() {
        std::map<std::string, std::size_t> mesh_of;
        for (const Part& part : parts_) {
            const auto [it, fresh] = mesh_of.try_emplace(part.group, scene_.meshes.size());
            if (fresh) {
                Node node;
                node.name = part.group;
                node.mesh = static_cast<int>(scene_.meshes.size());
                scene_.nodes.push_back(node);
                scene_.meshes.emplace_back();
                scene_.meshes.back().name = part.group;
            }
            scene_.meshes[it->second].primitives.push_back(convert(part));
        }
    }

    Primitive convert(const Part& part) {
        bool texcoords = true;
        bool normals = true;
        std::vector<Corner> corners;
        for (const auto& triangle : part.triangles)
            for (const Corner& c : triangle) {
                texcoords = texcoords && c.texcoord != 0;
                normals = normals && c.normal != 0;
            }
        const auto wanted = [&](Corner c) {
            if (!texcoords) c.texcoord = 0;
            if (!normals) c.normal = 0;
            return c;
        };
        corners.reserve(3 * part.triangles.size());
        for (const auto& triangle : part.triangles)
            for (const Corner& c : triangle)
                corners.push_back(wanted(c));
        std::sort(corners.begin(), corners.end()); // by place in the file
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        budget_.add_mesh(corners.size(), part.triangles.size(), "group '" + part.group + "'");

        Primitive primitive;
        primitive.material = part.material;
        for (const Corner& c : corners) {
            primitive.positions.push_back(positions_[c.position]);
            if (texcoords) primitive.texcoords.push_back(texcoords_[c.texcoord - 1]);
            if (normals) primitive.normals.push_back(normals_[c.normal - 1]);
        }
        for (const auto& triangle : part.triangles) {
            Triangle t;
            for (std::size_t k = 0; k < 3; ++k)
                t[k] = static_cast<std::uint32_t>(
                    std::lower_bound(corners.begin(), corners.end(), wanted(triangle[k])) -
                    corners.begin());
            primitive.triangles.push_back(t);
        }
        return primitive;
    }

    std::filesystem::path file_;
    Budget& budget_;
    Scene scene_;
    std::size_t line_ = 0;
    std::vector<Vec3f> positions_;
    std::vector<Vec2f> texcoords_;
    std::vector<Vec3f> normals_;
    std::string group_;
    int material_ = kNone;
    Part* part_ = nullptr; // set anew after every change of parts_
    std::size_t triangle_count_ = 0;
    std::vector<Part> parts_;
    std::map<std::pair<std::string, int>, std::size_t> part_of_;
    std::map<std::string, int> material_of_;
    std::map<std::string, int> texture_of_;
};

} // namespace

Scene read_obj(const std::filesystem::path& file, Budget& budget) {
    return ObjReader(file, budget).run();
}

} // namespace toile::assets
