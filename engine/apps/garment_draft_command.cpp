#include "apps/garment_draft_command.h"

#include "apps/freesewing.h"
#include "assets/files.h"
#include "body/body_file.h"
#include "core/bytes.h"
#include "core/error.h"
#include "core/paths.h"
#include "garment/block_package.h"
#include "garment/cutting_measures.h"
#include "garment/dxf_reader.h"
#include "garment/placed_pattern.h"
#include "garment/recipe_design.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;
namespace block = garment::block;

constexpr std::array kSizes = {"XS", "S", "M", "L", "XL", "XXL"};

struct DraftOptions {
    std::string what; ///< a recipe's id or file, a GarmentCode file, or with --list a .dxf
    std::string size; ///< one of kSizes; "" : all
    fs::path body;    ///< body.json: made to measure
    fs::path out;
    double edge_m = 0.0;                                       ///< 0: the recipe's
    bool list = false;                                         ///< only the pieces and their points
    std::string id, name, kind = "garment", fabric = "jersey"; ///< of what has no recipe
    fs::path stages; ///< folder for the meshes before and after the drape; "" : none
};

std::string lower(std::string text) {
    for (char& c : text) {
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return text;
}

fs::path find_recipe(const std::string& what) {
    if (fs::exists(what) && fs::is_regular_file(what)) {
        return what;
    }
    std::string known;
    for (const auto& folder : data_folders("garments")) {
        if (fs::exists(folder / "recipes" / (what + ".json"))) {
            return folder / "recipes" / (what + ".json");
        }
        if (!fs::is_directory(folder / "recipes")) {
            continue;
        }
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder / "recipes")) {
            names.push_back(entry.path().stem().string());
        }
        std::sort(names.begin(), names.end());
        for (const std::string& name : names) {
            known += (known.empty() ? "" : ", ") + name;
        }
    }
    throw UsageError("there is no recipe '" + what + "'; there are " + known);
}

std::vector<block::SizeOrder> orders_of(const DraftOptions& options, const block::Recipe& recipe) {
    std::vector<block::SizeOrder> orders;
    if (!options.body.empty()) {
        auto body = std::make_shared<body::BodyModel>(
            body::is_body_file(options.body)
                ? body::load_body(options.body)
                : body::load_body_model(body::find_avatar(options.body.string())));
        if (body::is_body_file(options.body)) {
            body->id.clear(); // the package is for this body alone
        }
        orders.push_back({"made-to-measure", body});
        return orders;
    }
    for (const char* size : kSizes) {
        if (options.size.empty() || lower(options.size) == lower(size)) {
            const std::string avatar = recipe.sizes_on + "-" + lower(size);
            orders.push_back({size, std::make_shared<const body::BodyModel>(
                                        body::load_body_model(body::find_avatar(avatar)))});
        }
    }
    if (orders.empty()) {
        throw UsageError("--size '" + options.size + "' is none of XS, S, M, L, XL, XXL");
    }
    return orders;
}

block::CutPieces cutter_of(const block::Recipe& recipe) {
    if (!recipe.pieces_file.empty()) {
        return [pieces = block::read_dxf(recipe.pieces_file)](const block::BodyProbe&) {
            return pieces;
        };
    }
    return [designs = recipe.designs](const block::BodyProbe& body) {
        const auto measures = block::cutting_measures(body);
        std::vector<block::PatternPiece> pieces;
        for (const block::DesignUse& use : designs) {
            auto asked = measures;
            for (const auto& [name, metres] : use.allowances) {
                const auto at = asked.find(name);
                if (at == asked.end()) {
                    throw Error("the recipe's allowance names no measurement: '" + name + "'");
                }
                at->second += 1000.0 * metres;
            }
            for (auto& piece : draft_freesewing(use.name, use.options, asked)) {
                if (designs.size() > 1) {
                    piece.name = use.name + "." + piece.name;
                }
                pieces.push_back(std::move(piece));
            }
        }
        return pieces;
    };
}

block::WatchDrape watch_of(const DraftOptions& options) {
    if (options.stages.empty()) {
        return {};
    }
    return [folder = options.stages](const std::string& size, const std::string& stage,
                                     const std::span<const Vec3d> positions,
                                     const std::span<const Triangle> triangles) {
        assets::Primitive primitive;
        for (const Vec3d& p : positions) {
            primitive.positions.push_back(p.cast<float>());
        }
        primitive.triangles.assign(triangles.begin(), triangles.end());
        assets::Scene scene;
        scene.meshes.push_back({stage, {std::move(primitive)}, {}});
        assets::Node node;
        node.name = stage;
        node.mesh = 0;
        scene.nodes.push_back(node);
        fs::create_directories(folder);
        assets::save_scene(scene, folder / (size + "-" + stage + ".obj"));
    };
}

// A GarmentCode pattern says how it is sewn and where it lies, but not what it looks like.
block::Design design_of_file(const DraftOptions& options) {
    block::Recipe look;
    look.id = options.id.empty() ? lower(fs::path(options.what).stem().string()) : options.id;
    std::replace(look.id.begin(), look.id.end(), ' ', '-');
    look.name = options.name.empty() ? look.id : options.name;
    look.kind = options.kind;
    look.layer = 1;
    look.fabric = options.fabric;
    look.edge_m = options.edge_m > 0.0 ? options.edge_m : 0.02;
    block::RecipePart part;
    part.name = "body";
    part.panels = {""};
    part.weave = block::Weave::plain;
    look.parts = {part};
    look.colourways = {{"natural", Vec3f(0.85f, 0.82f, 0.76f)},
                       {"blue", Vec3f(0.25f, 0.36f, 0.52f)}};
    look.chart = {"bust_girth", "waist_girth", "hip_girth"};
    look.held_strengths = {1.0, 0.35, 0.1};
    block::Design design = block::design_of(look, {});
    design.draft = [pattern = block::read_garmentcode(options.what), clearance = look.clearance_m](
                       const block::BodyProbe& body, std::optional<double>) {
        return block::pattern_of(pattern, body, clearance);
    };
    return design;
}

// Helps to write a recipe.
void list_pieces(const std::vector<block::PatternPiece>& pieces) {
    for (const block::PatternPiece& piece : pieces) {
        std::printf("%s: %.0f cm2\n", piece.name.c_str(), 1e4 * block::signed_area(piece.outline));
        for (const auto& [name, p] : piece.points) {
            double off = 0.0;
            (void)block::OutlineWalk(piece.outline).project(p, off);
            std::printf("  %-24s %7.1f %7.1f mm%s\n", name.c_str(), 1e3 * p.x(), 1e3 * p.y(),
                        off < 0.003 ? "  on the outline" : "");
        }
    }
}

/// Keeps what a drape was tried with, and how it ended, beside where the package would be.
fs::path keep_refused(const block::Design& design, const block::DrapeRefused& refused,
                      const fs::path& out) {
    const auto number = [](double value) {
        return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
    };
    nlohmann::ordered_json json;
    json["schema"] = 1;
    json["id"] = design.id;
    json["size"] = refused.size();
    json["reason"] = refused.what();
    json["panel"] = refused.panel();
    json["edge_m"] = design.edge_m;
    const block::DrapeOptions& o = refused.options();
    json["drape"] = {{"clearance_m", o.clearance_m},   {"density_kg_m2", o.density_kg_m2},
                     {"stretch_n_m", o.stretch_n_m},   {"bending", o.bending},
                     {"friction", o.friction},         {"shrink_steps", o.shrink_steps},
                     {"settle_steps", o.settle_steps}, {"finish_steps", o.finish_steps},
                     {"iterations", o.iterations},     {"rest_m_s", o.rest_m_s},
                     {"most_strain", o.most_strain}};
    const block::DrapeReport& r = refused.report();
    json["result"] = {{"speed_m_s", number(r.rms_speed)},
                      {"strain", number(r.worst_strain)},
                      {"sank_m", number(r.dropped_m)}};
    fs::create_directories(out);
    write_text(out / "refused.json", json.dump(2) + "\n");
    return out / "refused.json";
}

garment::GarmentPackage make(const block::Design& design, const DraftOptions& options,
                             const std::vector<block::SizeOrder>& orders) {
    try {
        return block::make_block(design, orders, watch_of(options));
    } catch (const block::DrapeRefused& refused) {
        throw Error(std::string(refused.what()) + " (what it was tried with: " +
                    keep_refused(design, refused, options.out).string() + ")");
    }
}

void write(const block::Design& design, const DraftOptions& options,
           const std::vector<block::SizeOrder>& orders, const garment::PackageLimits& limits) {
    if (options.out.empty()) {
        throw UsageError("garment draft: --out is required (a folder to write)");
    }
    const garment::GarmentPackage package = make(design, options, orders);
    fs::remove(options.out / "refused.json");
    garment::write_package(package, options.out, true);
    for (const auto& size : package.sizes) {
        std::printf("size %s: %zu vertices, %zu triangles\n", size.entry.name.c_str(),
                    size.simulation.positions.size(), size.simulation.triangles.size());
    }
    const auto faults = garment::check_package(options.out, limits);
    if (!faults.empty()) {
        throw Error(options.out.string() + ": " + faults.front().text);
    }
    std::printf("written: %s\n", (options.out / "garment.json").string().c_str());
}

void draft(DraftOptions options, const garment::PackageLimits& limits) {
    if (options.list && lower(fs::path(options.what).extension().string()) == ".dxf") {
        list_pieces(block::read_dxf(options.what));
        return;
    }
    const fs::path file = find_recipe(options.what);
    if (block::is_garmentcode(file)) {
        options.body = options.body.empty() ? fs::path("women-m") : options.body;
        options.what = file.string();
        const block::Recipe none;
        write(design_of_file(options), options, orders_of(options, none), limits);
        return;
    }
    block::Recipe recipe = block::load_recipe(file);
    recipe.edge_m = options.edge_m > 0.0 ? options.edge_m : recipe.edge_m;
    recipe.id = options.id.empty() ? recipe.id : options.id;
    recipe.name = options.name.empty() ? recipe.name : options.name;
    const auto orders = orders_of(options, recipe);
    if (options.list) {
        list_pieces(cutter_of(recipe)(block::BodyProbe(*orders.front().body)));
        return;
    }
    write(block::design_of(recipe, cutter_of(recipe)), options, orders, limits);
}

} // namespace

void add_garment_draft(CLI::App& garment, std::function<garment::PackageLimits()> limits) {
    auto* const command =
        garment.add_subcommand("draft", "Make a garment package from a sewing pattern");
    const auto options = std::make_shared<DraftOptions>();
    command
        ->add_option("design", options->what,
                     "A recipe: its id (garments/recipes) or its file; or a GarmentCode pattern "
                     "(.json)")
        ->required();
    auto* const size =
        command->add_option("--size", options->size, "One size, XS to XXL")->default_str("all");
    command
        ->add_option("--body", options->body,
                     "Made to measure for this body: body.json or an avatar")
        ->excludes(size);
    command->add_option("--out", options->out, "Folder to write")->type_name("DIR");
    command->add_flag(
        "--list", options->list,
        "Only lists the pieces and their points, of a .dxf too: for writing a recipe");
    command->add_option("--id", options->id, "Id of the garment")->default_str("the recipe's");
    command->add_option("--name", options->name, "For people")->default_str("the recipe's");
    command->add_option("--kind", options->kind, "Of a GarmentCode pattern: dress, trousers, ...")
        ->capture_default_str();
    command->add_option("--fabric", options->fabric, "Of a GarmentCode pattern")
        ->capture_default_str();
    command->add_option("--edge", options->edge_m, "Edge length of the simulation mesh, metres")
        ->check(CLI::Range(0.006, 0.05))
        ->default_str("the recipe's");
    command
        ->add_option("--stages", options->stages,
                     "Folder for each size's mesh as placed and as draped (.obj): shows why a "
                     "pattern does not hang")
        ->type_name("DIR");
    command->footer("Example: toile garment draft tank-top --out garments/tank-top\n"
                    "         toile garment draft tank-top --body anna.json --out annas-top");
    command->callback([options, limits = std::move(limits)] { draft(*options, limits()); });
}

} // namespace toile::apps
