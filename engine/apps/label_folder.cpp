#include "apps/label_folder.h"

#include "core/bytes.h"
#include "core/error.h"

#include <nlohmann/json.hpp>

namespace toile::apps {
namespace {

constexpr std::uint8_t kPeopleApart = 16;

using Color = std::array<std::uint8_t, 3>;

/// Of P4's parts; neighbours differ.
constexpr std::array<Color, 13> kColors{{{0, 0, 0},
                                         {240, 200, 80},
                                         {60, 130, 220},
                                         {220, 70, 60},
                                         {250, 150, 120},
                                         {50, 160, 80},
                                         {150, 220, 130},
                                         {170, 60, 170},
                                         {230, 150, 230},
                                         {20, 150, 160},
                                         {130, 225, 225},
                                         {110, 80, 40},
                                         {190, 190, 190}}};

/// Others are drawn paler than the first.
Color shade(const Color& color, std::uint32_t person) {
    Color out = color;
    for (std::uint8_t& c : out)
        c = static_cast<std::uint8_t>(c + (255 - c) * static_cast<int>(person) / 8);
    return out;
}

} // namespace

LabelFolder::LabelFolder(const std::filesystem::path& folder, const pipeline::PeopleSource& source,
                         std::uint32_t most_people)
    : pictures_(folder) {
    if (!source.tells_parts())
        throw Error(source.tracker_id() + ": does not tell body parts, which --labels needs");
    nlohmann::ordered_json json;
    json["schema"] = 1;
    json["pictures"] = "%06d.png";
    json["value"] = "person * 16 + part; 0: nobody";
    json["person"] = "place among the people of the frame's line in the track, from 0";
    json["parts"] = nlohmann::ordered_json::array();
    for (std::size_t part = 1; part < kColors.size(); ++part)
        json["parts"].push_back({{"part", part},
                                 {"name", body::part_label(static_cast<body::Part>(part))},
                                 {"color", kColors[part]}});
    write_text(folder / "labels.json", json.dump(2) + "\n");
    image_.colors.assign(std::size_t{kPeopleApart} * most_people, Color{});
    for (std::uint32_t person = 0; person < most_people; ++person)
        for (std::size_t part = 1; part < kColors.size(); ++part)
            image_.colors[kPeopleApart * person + part] = shade(kColors[part], person);
}

void LabelFolder::add(pipeline::PeopleSource& source) {
    source.read_parts(parts_);
    image_.width = parts_.width;
    image_.height = parts_.height;
    image_.values = parts_.parts;
    for (std::size_t i = 0; i < image_.values.size(); ++i)
        if (parts_.people[i] > 1 && image_.values[i] != 0)
            image_.values[i] =
                static_cast<std::uint8_t>(image_.values[i] + kPeopleApart * (parts_.people[i] - 1));
    pictures_.add(image_);
}

} // namespace toile::apps
