// What `tryon` and `mirror` need before the first frame: plugins, a body, and its garments.
#pragma once

#include "apps/global_options.h"
#include "host/job.h"
#include "host/registry.h"
#include "pipeline/dressed_person.h"

#include <memory>
#include <string>
#include <vector>

namespace toile::apps {

/// What is to be worn by whom.
struct Outfit {
    std::string body = "mannequin";    ///< avatar id, its folder, or a body.json
    std::vector<std::string> garments; ///< ids, folders or zips; inner to outer by their layer
    std::string size = "auto";         ///< a size's name, or "auto": from the size chart
};

/// Everything loaded and bound. Not movable.
class FittingRoom {
  public:
    /// \throw Error naming what cannot be found, read or bound
    FittingRoom(const GlobalOptions& options, const Outfit& outfit, bool live_clock);
    ~FittingRoom();
    FittingRoom(const FittingRoom&) = delete;
    FittingRoom& operator=(const FittingRoom&) = delete;

    [[nodiscard]] host::Services& services() { return services_; }
    [[nodiscard]] host::Registry& registry() { return registry_; }
    [[nodiscard]] host::Job& job() { return job_; }
    [[nodiscard]] const toile_limits& limits() const { return dressing_.limits; }
    [[nodiscard]] const pipeline::BoundaryBody& body() const { return *body_; }
    [[nodiscard]] pipeline::DressedPerson& person() { return *person_; }
    /// One line a garment: which size was chosen and why.
    [[nodiscard]] const std::vector<std::string>& choices() const { return choices_; }

  private:
    struct LoadedBody {
        std::filesystem::path from; ///< an avatar's folder, or a body.json
        std::shared_ptr<const pipeline::BoundaryBody> body;
    };
    std::shared_ptr<const pipeline::BoundaryBody> load_body(const std::string& id);
    std::shared_ptr<const pipeline::BoundaryBody> keep(const std::filesystem::path& from,
                                                       body::BodyModel model);
    std::shared_ptr<const pipeline::BoundaryGarment> load_garment(const std::string& id,
                                                                  const std::string& size);

    host::Services services_;
    host::Registry registry_;
    host::Job job_;
    pipeline::DressingOptions dressing_;
    std::uint64_t next_revision_ = 1;
    std::vector<LoadedBody> bodies_;
    std::shared_ptr<const pipeline::BoundaryBody> body_;
    std::unique_ptr<pipeline::DressedPerson> person_;
    std::vector<std::string> choices_;
};

/// "t-shirt,skirt" -> {"t-shirt", "skirt"}. \throw UsageError for an empty or repeated name
[[nodiscard]] std::vector<std::string> split_names(const std::string& list,
                                                   const std::string& option);

} // namespace toile::apps
