#include "apps/catalogue_item.h"

#include "apps/fitting_room.h"
#include "apps/look.h"
#include "apps/look_file.h"
#include "apps/still_look.h"
#include "core/bytes.h"
#include "core/error.h"
#include "core/log.h"
#include "garment/fit_file.h"
#include "imaging/image.h"
#include "pipeline/person_fit.h"

#include <array>
#include <cmath>
#include <unistd.h>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A folder that takes another's place when it is whole, and is gone when it never was.
class NewFolder {
  public:
    explicit NewFolder(const fs::path& place)
        : place_(place), folder_(place.parent_path() / (".making_" + place.filename().string() +
                                                        "_" + std::to_string(getpid()))) {
        fs::remove_all(folder_);
        std::error_code code;
        fs::create_directories(folder_, code);
        if (code) throw FileError(folder_.string(), "cannot be made: " + code.message());
    }
    ~NewFolder() {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;

    [[nodiscard]] fs::path operator/(const std::string& name) const { return folder_ / name; }
    void finish() {
        fs::remove_all(place_);
        fs::rename(folder_, place_);
    }

  private:
    fs::path place_, folder_;
};

double rounded(double value) {
    return std::round(value * 1e6) * 1e-6;
}

Json header(const CatalogueItem& item, const std::string& inputs, const char* state) {
    Json json;
    json["schema"] = 1;
    json["id"] = item.id;
    json["state"] = state;
    json["garments"] = split_names(item.garments, "garments");
    json["size"] = item.size;
    json["body"] = item.body;
    json["pose"] = item.pose;
    if (!item.colourway.empty()) json["colourway"] = item.colourway;
    json["inputs"] = inputs;
    return json;
}

Json figures(const pipeline::ContactWorst& worst, const garment::FitReport* fit) {
    Json json;
    json["deep_fraction_max"] = rounded(worst.deep_fraction);
    json["deep_fraction_self_intersecting_max"] = rounded(worst.deep_fraction_apart);
    json["skin_visible_max"] = rounded(worst.visible_fraction);
    json["skin_visible_self_intersecting_max"] = rounded(worst.visible_fraction_apart);
    if (fit == nullptr) return json;
    const garment::ContactFit contact = garment::contact_of(*fit);
    const garment::StrainFigures strain = garment::strain_of(*fit);
    json["deep_fraction"] = rounded(contact.deep_fraction());
    json["self_intersections"] = rounded(contact.self_intersections());
    json["strain_rms"] = rounded(strain.rms);
    json["strain_max"] = rounded(strain.max);
    return json;
}

void draw_views(const CataloguePlan& plan, const CatalogueItem& item, FittingRoom& room,
                const NewFolder& folder) {
    const auto context = render::make_offscreen_context();
    Look look(*context, plan.picture, room.person(), item.colourway);
    look.update();
    const render::Box box = bounds_now(room.person());
    for (const render::View& view : plan.views) {
        look.draw(view, box);
        imaging::save_image(look.renderer().read(), folder / (view.name + ".png"));
    }
}

/// None for a body without landmarks, which has no girths.
std::optional<garment::FitReport> fit_if_measured(FittingRoom& room, Json& json) {
    try {
        return pipeline::fit_of(room.person());
    } catch (const Error& e) {
        json["fit_missing"] = e.what();
        return std::nullopt;
    }
}

void tell_fit(const garment::FitReport& fit, Json& json) {
    Json& worn = json["worn"] = Json::object();
    for (const garment::GarmentFit& garment : fit.garments) {
        Json& one = worn[garment.id];
        one["size"] = garment.size;
        if (garment.recommended_size) one["recommended_size"] = *garment.recommended_size;
    }
    json["failures"] = Json::array();
    for (const garment::FitFailure& failure : fit.failures)
        json["failures"].push_back({{"code", garment::name_of(failure.code)},
                                    {"garment", failure.garment},
                                    {"text", failure.text}});
}

} // namespace

std::optional<double> ItemRecord::figure(const std::string& name) const {
    const auto figures = json.find("figures");
    if (figures == json.end() || !figures->contains(name)) return std::nullopt;
    return (*figures)[name].get<double>();
}

void make_item(const CataloguePlan& plan, const CatalogueItem& item, const GlobalOptions& global) {
    const std::string inputs = CatalogueInputs(plan, global.seed).digest(item);
    FittingRoom room(global, {item.body, split_names(item.garments, "garments"), item.size}, false);
    pipeline::RunOptions options;
    options.measure_contact = true;
    options.seed = global.seed;
    options.interrupted = [] { return host::interrupt_flag().load(); };
    const pipeline::RunReport run = leave_to_hang(room, item.pose, options);
    if (host::interrupt_flag()) throw host::Cancelled("interrupted");
    if (const auto faults = room.person().faults(); !faults.empty()) throw Error(faults.front());

    NewFolder folder(plan.out / item.id);
    Json json = header(item, inputs, "done");
    const auto fit = fit_if_measured(room, json);
    if (fit) {
        tell_fit(*fit, json);
        garment::write_fit(*fit, folder / "fit.json");
    }
    json["figures"] = figures(run.contact.value(), fit ? &*fit : nullptr);
    draw_views(plan, item, room, folder);
    if (plan.glb) save_look(room.person(), folder / "look.glb");
    write_text(folder / "item.json", json.dump(2) + "\n");
    folder.finish();
}

void keep_failure(const CataloguePlan& plan, const CatalogueItem& item, const std::string& inputs,
                  const std::string& error) {
    NewFolder folder(plan.out / item.id);
    Json json = header(item, inputs, "failed");
    json["error"] = error;
    write_text(folder / "item.json", json.dump(2) + "\n");
    folder.finish();
}

ItemRecord read_record(const CataloguePlan& plan, const CatalogueItem& item) {
    constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
    const fs::path file = plan.out / item.id / "item.json";
    ItemRecord out;
    if (!fs::exists(file)) return out;
    try {
        const auto bytes = read_bytes(file, kMaxBytes);
        out.json = Json::parse(bytes.begin(), bytes.end());
        out.inputs = out.json.at("inputs").get<std::string>();
        out.error = out.json.value("error", "");
        out.state = out.json.at("state") == "done" ? ItemState::done : ItemState::failed;
    } catch (const std::exception& e) {
        log::warning(file.string() + ": is damaged and will be made again (" + e.what() + ")");
        return {};
    }
    return out;
}

std::vector<std::string> beyond_limits(const CataloguePlan& plan, const ItemRecord& record) {
    const std::array<std::pair<const char*, std::optional<double>>, 4> limits = {{
        {"deep_fraction_max", plan.limits.deep_fraction},
        {"skin_visible_max", plan.limits.skin_visible},
        {"self_intersections", plan.limits.self_intersections},
        {"strain_rms", plan.limits.strain_rms},
    }};
    std::vector<std::string> out;
    for (const auto& [name, limit] : limits) {
        const std::optional<double> figure = record.figure(name);
        if (limit && figure && *figure > *limit) {
            std::array<char, 96> text{};
            std::snprintf(text.data(), text.size(), "%s %.3g (at most %.3g)", name, *figure,
                          *limit);
            out.emplace_back(text.data());
        }
    }
    return out;
}

} // namespace toile::apps
