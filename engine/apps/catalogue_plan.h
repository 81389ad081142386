// What `toile catalogue` is asked for: garments x sizes x bodies x poses x colourways, seen from
// several sides (docs/catalogue.md, docs/schemas/catalogue.schema.json).
#pragma once

#include "render/renderer.h"
#include "render/views.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace toile::apps {

/// Largest figures that an item may have; none: not held against anything.
struct CatalogueLimits {
    std::optional<double> deep_fraction;      ///< worst frame of hanging
    std::optional<double> skin_visible;       ///< worst frame of hanging
    std::optional<double> self_intersections; ///< share of triangles, at rest
    std::optional<double> strain_rms;         ///< at rest
};

/// One thing to make; a folder of its name under `out`.
struct CatalogueItem {
    std::string id; ///< letters, digits, "._+-"; differs from that of all others
    std::string garments, size, body, pose, colourway;
};

struct CataloguePlan {
    std::filesystem::path file;
    std::filesystem::path out;         ///< of the plan, or beside it under its name
    std::vector<std::string> garments; ///< "tee", or "tee,shorts" worn together
    std::vector<std::string> sizes{"auto"};
    std::vector<std::string> bodies;
    std::vector<std::string> poses{"rest"}; ///< as of tryon --pose
    std::vector<std::string> colourways{""};
    std::vector<CatalogueItem> looks; ///< one by one, after the combinations; no ids
    std::vector<render::View> views;
    render::RendererOptions picture;
    bool glb = false; ///< the look as a 3D file, too
    CatalogueLimits limits;
};

/// Names of files in a plan are looked for beside it. \throw Error, JsonError
[[nodiscard]] CataloguePlan load_catalogue_plan(const std::filesystem::path& file);

/// All of a plan: garments x sizes x bodies x poses x colourways, the last list fastest, then its
/// looks. \throw Error when two have one id
[[nodiscard]] std::vector<CatalogueItem> items_of(const CataloguePlan& plan);

/// Of all that decides about an item: the plan's options, body, garments, pose, seed and the
/// program's version. What cannot be read counts by its name: making it will say what is wrong.
class CatalogueInputs {
  public:
    CatalogueInputs(const CataloguePlan& plan, std::uint64_t seed);
    [[nodiscard]] std::string digest(const CatalogueItem& item);

  private:
    const std::string& of_path(const std::filesystem::path& path);

    const CataloguePlan& plan_;
    std::string common_;
    std::vector<std::pair<std::filesystem::path, std::string>> known_;
};

} // namespace toile::apps
