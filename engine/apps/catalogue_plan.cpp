#include "apps/catalogue_plan.h"

#include "apps/contact_sheet.h"
#include "apps/fitting_room.h"
#include "body/body_model.h"
#include "core/bytes.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/json.h"
#include "garment/package.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <tuple>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostItems = 1'000'000;
constexpr std::size_t kMaxFileBytes = std::size_t{512} << 20;

/// A file named in a plan: beside the plan where there is one, else as it was written.
std::string beside(const fs::path& plan, const std::string& name) {
    if (name.empty() || fs::path(name).is_absolute()) return name;
    const fs::path here = plan.parent_path() / name.substr(0, name.rfind('@'));
    return fs::exists(here) ? (plan.parent_path() / name).string() : name;
}

std::vector<std::string> list(JsonObject& json, const std::string& key,
                              std::vector<std::string> otherwise) {
    if (!json.has(key)) {
        if (otherwise.empty()) throw json.error(key, "is missing");
        return otherwise;
    }
    std::vector<std::string> out = json.texts(key);
    if (out.empty()) throw json.error(key, "is empty");
    if (std::set<std::string>(out.begin(), out.end()).size() != out.size())
        throw json.error(key, "names one thing twice");
    return out;
}

std::optional<double> limit(JsonObject& json, const std::string& key) {
    if (!json.has(key)) return std::nullopt;
    return json.number(key, 0.0, 1.0);
}

CatalogueLimits limits_from(JsonObject json) {
    CatalogueLimits out;
    out.deep_fraction = limit(json, "deep_fraction");
    out.skin_visible = limit(json, "skin_visible");
    out.self_intersections = limit(json, "self_intersections");
    out.strain_rms = limit(json, "strain_rms");
    json.finish();
    return out;
}

CatalogueItem look_from(JsonObject& json) {
    CatalogueItem out;
    out.garments = json.text("garments");
    out.body = json.text("body");
    out.size = json.text_or("size", "auto");
    out.pose = json.text_or("pose", "rest");
    out.colourway = json.text_or("colourway", "");
    json.finish();
    return out;
}

void read_picture(JsonObject& json, CataloguePlan& plan) {
    std::string views;
    for (const std::string& view : list(json, "views", {"front", "back"}))
        views += (views.empty() ? "" : ",") + view;
    plan.views = render::views_from_names(views);
    std::tie(plan.picture.width, plan.picture.height) =
        size_from_text(json.text_or("picture", "480x640"));
    const std::string quality = json.text_or("quality", "high");
    if (quality != "high" && quality != "fast")
        throw json.error("quality", "is '" + quality + "'; there are high and fast");
    plan.picture.quality = quality == "high" ? render::Quality::high : render::Quality::fast;
    plan.glb = json.has("glb") && json.boolean("glb");
}

/// Fit for a folder's name: a path's last part without its ending, all else as "-".
std::string short_name(const std::string& text) {
    std::string name = text;
    if (fs::path(text).filename() == "body.json") name = fs::path(text).parent_path().string();
    const std::size_t slash = name.find_last_of('/');
    if (slash != std::string::npos) name = name.substr(slash + 1);
    for (const char* ending : {".json", ".bvh", ".jsonl", ".zip"}) {
        const std::size_t at = name.find(ending);
        if (at != std::string::npos && at > 0) name.erase(at, std::string(ending).size());
    }
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') c = '-';
    return name;
}

std::string id_of(const CatalogueItem& item) {
    std::string garments;
    for (const std::string& garment : split_names(item.garments, "garments"))
        garments += (garments.empty() ? "" : "+") + short_name(garment);
    std::string id = garments + "_" + short_name(item.size) + "_" + short_name(item.body) + "_" +
                     short_name(item.pose);
    if (!item.colourway.empty()) id += "_" + short_name(item.colourway);
    return id;
}

void add_file(Digest& digest, const fs::path& file) {
    digest.add(file.filename().string());
    digest.add(read_bytes(file, kMaxFileBytes));
}

/// A file, or all files right in a folder.
std::string content_of(const fs::path& path) {
    Digest digest;
    if (!fs::is_directory(path)) {
        add_file(digest, path);
        return digest.hex();
    }
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(path))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files)
        add_file(digest, file);
    return digest.hex();
}

} // namespace

CataloguePlan load_catalogue_plan(const fs::path& file) {
    const nlohmann::json parsed = parse_json_file(file);
    JsonObject json(parsed, file.string());
    CataloguePlan plan;
    plan.file = file;
    (void)json.integer("schema", 1, 1);
    plan.out = file.parent_path() / json.text_or("out", file.stem().string());
    if (json.has("looks"))
        for (JsonObject& look : json.objects("looks"))
            plan.looks.push_back(look_from(look));
    if (plan.looks.empty() || json.has("garments") || json.has("bodies")) {
        plan.garments = list(json, "garments", {});
        plan.bodies = list(json, "bodies", {});
    }
    plan.sizes = list(json, "sizes", plan.sizes);
    plan.poses = list(json, "poses", plan.poses);
    plan.colourways = list(json, "colourways", plan.colourways);
    read_picture(json, plan);
    if (json.has("limits")) plan.limits = limits_from(json.object("limits"));
    json.finish();
    for (auto* names : {&plan.bodies, &plan.poses})
        for (std::string& name : *names)
            name = beside(file, name);
    const auto worn = [&](const std::string& garments) {
        std::string resolved;
        for (const std::string& name : split_names(garments, file.string() + ": garments"))
            resolved += (resolved.empty() ? "" : ",") + beside(file, name);
        return resolved;
    };
    for (std::string& garments : plan.garments)
        garments = worn(garments);
    for (CatalogueItem& look : plan.looks) {
        look.garments = worn(look.garments);
        look.body = beside(file, look.body);
        look.pose = beside(file, look.pose);
    }
    return plan;
}

std::vector<CatalogueItem> items_of(const CataloguePlan& plan) {
    const std::size_t count = plan.garments.size() * plan.sizes.size() * plan.bodies.size() *
                                  plan.poses.size() * plan.colourways.size() +
                              plan.looks.size();
    if (count > kMostItems)
        throw Error(plan.file.string() + ": is " + std::to_string(count) + " items; at most " +
                    std::to_string(kMostItems) + " are made of one plan");
    std::vector<CatalogueItem> items;
    items.reserve(count);
    for (const std::string& garments : plan.garments)
        for (const std::string& size : plan.sizes)
            for (const std::string& body : plan.bodies)
                for (const std::string& pose : plan.poses)
                    for (const std::string& colourway : plan.colourways)
                        items.push_back({"", garments, size, body, pose, colourway});
    items.insert(items.end(), plan.looks.begin(), plan.looks.end());
    std::set<std::string> ids;
    for (CatalogueItem& item : items) {
        item.id = id_of(item);
        if (!ids.insert(item.id).second)
            throw Error(plan.file.string() + ": two items would be called " + item.id +
                        "; give their files different names");
    }
    return items;
}

CatalogueInputs::CatalogueInputs(const CataloguePlan& plan, std::uint64_t seed) : plan_(plan) {
    Digest digest;
    for (const render::View& view : plan.views)
        digest.add(view.name);
    digest.add(TOILE_VERSION);
    for (const std::uint64_t number :
         {static_cast<std::uint64_t>(plan.picture.width),
          static_cast<std::uint64_t>(plan.picture.height),
          static_cast<std::uint64_t>(plan.picture.quality == render::Quality::high ? 1 : 0),
          static_cast<std::uint64_t>(plan.glb ? 1 : 0), seed})
        digest.add(std::to_string(number));
    common_ = digest.hex();
}

const std::string& CatalogueInputs::of_path(const fs::path& path) {
    for (const auto& [known, content] : known_)
        if (known == path) return content;
    std::string content = path.string();
    try {
        content = content_of(path);
    } catch (const std::exception&) { // by its name, as promised
    }
    return known_.emplace_back(path, std::move(content)).second;
}

std::string CatalogueInputs::digest(const CatalogueItem& item) {
    Digest digest;
    digest.add(common_);
    digest.add(item.size);
    digest.add(item.colourway);
    digest.add(item.pose);
    for (const std::string& garment : split_names(item.garments, "garments")) {
        try {
            digest.add(of_path(garment::find_garment(garment)));
        } catch (const Error&) {
            digest.add(garment);
        }
    }
    try {
        const fs::path body(item.body);
        digest.add(of_path(fs::exists(body) ? body : body::find_avatar(item.body)));
    } catch (const Error&) {
        digest.add(item.body);
    }
    const fs::path pose(item.pose.substr(0, item.pose.rfind('@')));
    if (fs::is_regular_file(pose)) digest.add(of_path(pose));
    return digest.hex();
}

} // namespace toile::apps
