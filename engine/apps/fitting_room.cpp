#include "apps/fitting_room.h"

#include "apps/plugin_limits.h"
#include "body/body_file.h"
#include "core/error.h"
#include "garment/size_choice.h"

#include <algorithm>
#include <sstream>

namespace toile::apps {
namespace {

std::string known(const std::vector<std::string>& ids) {
    std::string text;
    for (const std::string& id : ids)
        text += (text.empty() ? "" : ", ") + id;
    return text;
}

} // namespace

std::vector<std::string> split_names(const std::string& list, const std::string& option) {
    std::vector<std::string> out;
    std::istringstream in(list);
    for (std::string name; std::getline(in, name, ',');) {
        if (name.empty()) throw UsageError(option + " '" + list + "': a name is empty");
        if (std::find(out.begin(), out.end(), name) != out.end())
            throw UsageError(option + " '" + list + "': " + name + " is named twice");
        out.push_back(name);
    }
    if (out.empty()) throw UsageError(option + " needs at least one name");
    return out;
}

FittingRoom::FittingRoom(const GlobalOptions& options, const Outfit& outfit, bool live_clock)
    : services_(options.threads), registry_(services_, registry_options(options)),
      job_({}, &host::interrupt_flag()) {
    if (outfit.garments.size() > pipeline::kMostGarments)
        throw UsageError("--garment names " + std::to_string(outfit.garments.size()) +
                         " garments; at most " + std::to_string(pipeline::kMostGarments) +
                         " are worn together");
    dressing_.limits = limits_of(options, services_, kDressedPerson, live_clock);
    body_ = load_body(outfit.body);
    std::vector<std::shared_ptr<const pipeline::BoundaryGarment>> garments;
    garments.reserve(outfit.garments.size());
    for (const std::string& id : outfit.garments)
        garments.push_back(load_garment(id, outfit.size));
    std::stable_sort(garments.begin(), garments.end(),
                     [](const auto& a, const auto& b) { return a->abi().layer < b->abi().layer; });
    person_ = std::make_unique<pipeline::DressedPerson>(registry_, services_, body_,
                                                        std::move(garments), dressing_, job_);
}

FittingRoom::~FittingRoom() = default;

std::shared_ptr<const pipeline::BoundaryBody> FittingRoom::load_body(const std::string& id) {
    namespace fs = std::filesystem;
    const fs::path path(id);
    if (body::is_body_file(path)) return keep(path, body::load_body(path));
    if (path.has_extension() && fs::is_regular_file(path))
        throw Error(id + ": a mesh is fitted before it is dressed: toile fit --scan " + id +
                    " --out body.json; or choose one of " + known(body::list_avatars()));
    const fs::path folder = fs::is_directory(path) ? path : body::find_avatar(id);
    for (const LoadedBody& loaded : bodies_)
        if (loaded.from == folder) return loaded.body;
    return keep(folder, body::load_body_model(folder));
}

std::shared_ptr<const pipeline::BoundaryBody> FittingRoom::keep(const std::filesystem::path& from,
                                                                body::BodyModel model) {
    bodies_.push_back(
        {from, std::make_shared<const pipeline::BoundaryBody>(
                   std::make_shared<const body::BodyModel>(std::move(model)), next_revision_++)});
    return bodies_.back().body;
}

std::shared_ptr<const pipeline::BoundaryGarment>
FittingRoom::load_garment(const std::string& id, const std::string& size) {
    auto package = garment::load_package(garment::find_garment(id));
    const garment::GarmentSize* chosen = nullptr;
    if (size == "auto" && package->sizes.size() > 1) {
        const auto choice = garment::choose_size(*package, body_->model().measurements);
        chosen = &package->sizes[choice.index];
        choices_.push_back(package->manifest.id + ": " + choice.reason);
    } else {
        chosen = size == "auto" ? &package->sizes.front() : &package->size(size);
        choices_.push_back(package->manifest.id + ": " + chosen->entry.name +
                           (size == "auto" ? ", the only size" : ", as asked for"));
    }
    const std::string& made_on =
        chosen->entry.made_on.empty() ? package->manifest.made_on : chosen->entry.made_on;
    auto made = made_on.empty() ? nullptr : load_body(made_on);
    return std::make_shared<const pipeline::BoundaryGarment>(std::move(package), *chosen,
                                                             std::move(made));
}

} // namespace toile::apps
