// A recipe: which pieces a design is made of, how they are sewn, and where they lie on the body.
#pragma once

#include "garment/block_fabric.h"
#include "garment/manifest.h"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace toile::garment::block {

/// Where a panel lies. Half panels lie on the body's left and have their mirror image on the right.
enum class WrapOn : std::uint8_t {
    invalid,
    torso_front, ///< from the centre front to the side
    torso_back,  ///< from the centre back to the side
    torso_half,  ///< from the centre front over the side to the centre back
    leg_front,   ///< above the crotch as torso_front, below it around the front of the leg
    leg_back,
    arm, ///< once around the arm, its middle on top
};

struct PanelWrap {
    WrapOn on = WrapOn::invalid;
    std::map<std::string, std::string> levels; ///< point of the piece -> level of the body
    std::string neck, shoulder;     ///< points: ends of the shoulder seam, where there is one
    std::string seam_of;            ///< panel whose shoulder seam tells the place; "" : this one
    std::vector<std::string> inner; ///< edges on the side of the centre; an arm's one side
    std::vector<std::string> outer; ///< edges on the other side
    std::string front;              ///< arm: a point on the front side
    std::string polar;              ///< torso_half: the centre of a ring sector; "" : none
};

struct RecipeCorner {
    std::string point;     ///< of the piece
    std::string edge;      ///< from here to the next corner
    bool straight = false; ///< instead of along the outline
};

struct PanelRecipe {
    std::string name, piece;
    std::vector<RecipeCorner> border; ///< once around, either way
    PanelWrap wrap;
};

/// A straight band sewn to edges in a row: collars, cuffs, waistbands.
struct StripRecipe {
    /// on: goes on as its neighbour does; neck: bent up to the neck; waist: level around the trunk,
    /// as tight as it is cut
    enum class Way : std::uint8_t { invalid, on, neck, waist };
    std::string name;
    std::vector<std::string> along; ///< "front.neck", from centre front to centre back
    double height_m = 0.0;
    double ratio = 1.0; ///< its length over that of the edges
    Way way = Way::on;
};

/// An edge as its panel's border lists it, or the other way round.
struct EdgeUse {
    std::string panel, edge;
    bool reversed = false;
};

/// Two rows of edges sewn together, start to start. "-front.side" is an edge the other way round,
/// "back.armhole+yoke.armhole" a row; a row against one edge parts that edge by the row's lengths.
struct RecipeSeam {
    std::vector<EdgeUse> a, b;
};

/// A FreeSewing design and its options.
struct DesignUse {
    std::string name;
    nlohmann::json options;
    std::map<std::string, double> allowances; ///< metres added to measurements
};

struct RecipePart {
    std::string name;
    std::vector<std::string> panels; ///< beginnings of panels' names; "" takes the rest
    Weave weave = Weave::invalid;
    double turn_in_m = 0.012;
};

struct Recipe {
    std::string id, name, kind;
    std::uint32_t layer = 0;
    std::vector<DesignUse> designs;    ///< FreeSewing's, or none when the pieces come from a file
    std::filesystem::path pieces_file; ///< a DXF beside the recipe, or ""
    std::string sizes_on;              ///< "women", "men"
    std::string fabric;                ///< a name of fabric_table.h
    EaseIntent ease_class;
    double ease_m = 0.004;
    double edge_m = 0.016;
    double clearance_m = 0.008; ///< while draping
    std::vector<PanelRecipe> panels;
    std::vector<StripRecipe> strips;
    std::vector<RecipeSeam> seams;
    std::vector<std::string> centres; ///< "front.centre": sewn to its own mirror image
    std::vector<RecipePart> parts;
    std::vector<std::pair<std::string, Vec3f>> colourways; ///< sRGB
    std::vector<std::string> chart;
    std::string held_prefix; ///< panels held to the body, "" for none
    std::vector<double> held_strengths;
    std::vector<body::Part> body_mask;
};

/// docs/schemas/recipe.schema.json. \throw Error naming file and place
[[nodiscard]] Recipe load_recipe(const std::filesystem::path& file);

/// "front.side" -> panel and edge. \throw Error when it is not of that form
[[nodiscard]] std::pair<std::string, std::string> split_edge(const std::string& text);

} // namespace toile::garment::block
