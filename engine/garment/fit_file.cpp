#include "garment/fit_file.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace toile::garment {
namespace {

using Json = nlohmann::ordered_json;

/// Steps in which numbers are written: nobody reads more, and files stay small.
constexpr double kLength_m = 1e-4, kStrain = 1e-4, kPressure_pa = 1.0, kShare = 1e-6;

double rounded(double value, double step) {
    // Steps are powers of ten: the quotient of two whole numbers is written shortly.
    const double per_unit = std::round(1.0 / step);
    return std::round(value * per_unit) / per_unit + 0.0; // no negative zero
}

Json girths_json(const GarmentFit& fit) {
    Json out = Json::array();
    for (const GirthFit& girth : fit.girths) {
        Json row = {{"name", girth.name},
                    {"body_m", rounded(girth.body_m, kLength_m)},
                    {"garment_m", rounded(girth.garment_m, kLength_m)},
                    {"ease_m", rounded(girth.ease_m(), kLength_m)},
                    {"confidence", rounded(girth.confidence, 1e-3)}};
        if (girth.moved_m != 0.0) row["moved_m"] = rounded(girth.moved_m, kLength_m);
        if (girth.open) row["open"] = true;
        for (std::size_t i = 0; i < girth.sizes_m.size(); ++i)
            row["ease_by_size_m"][fit.sizes[i]] =
                rounded(girth.sizes_m[i] - girth.body_m, kLength_m);
        out.push_back(std::move(row));
    }
    return out;
}

Json lengths_json(const GarmentFit& fit) {
    Json out = Json::array();
    for (const LengthFit& length : fit.lengths)
        out.push_back({{"name", length.name},
                       {"body_m", rounded(length.body_m, kLength_m)},
                       {"garment_m", rounded(length.garment_m, kLength_m)},
                       {"text", length.text}});
    return out;
}

Json regions_json(const GarmentFit& fit) {
    Json out = Json::array();
    for (const RegionFit& region : fit.regions)
        out.push_back({{"region", name_of(region.region)},
                       {"measurement", region.girth},
                       {"ease_m", rounded(region.ease_m, kLength_m)},
                       {"ease_class", name_of(region.ease_class)},
                       {"ease_class_from", name_of(region.source)},
                       {"intended_ease_m", rounded(region.intended_m, kLength_m)},
                       {"verdict", name_of(region.verdict)},
                       {"text", region.text},
                       {"stretch_mean", rounded(region.stretch_mean, kStrain)},
                       {"stretch_max", rounded(region.stretch_max, kStrain)},
                       {"pressure_mean_pa", rounded(region.pressure_mean_pa, kPressure_pa)},
                       {"pressure_p95_pa", rounded(region.pressure_p95_pa, kPressure_pa)}});
    return out;
}

Json contact_json(const ContactFit& contact) {
    return {{"deep_fraction", rounded(contact.deep_fraction(), kShare)},
            {"self_intersections", rounded(contact.self_intersections(), kShare)}};
}

Json strain_json(const StrainFigures& strain) {
    return {{"rms", rounded(strain.rms, kStrain)}, {"max", rounded(strain.max, kStrain)}};
}

/// A list that is to stand in one line is written as this and replaced in the text.
std::string mark(std::size_t number) {
    return "@list " + std::to_string(number) + "@";
}

class Lists {
  public:
    Json add(std::span<const float> values, double step) {
        Json list = Json::array();
        for (const float value : values) {
            const double number = rounded(static_cast<double>(value), step);
            if (step >= 1.0)
                list.push_back(static_cast<std::int64_t>(number));
            else
                list.push_back(number);
        }
        texts_.push_back(list.dump());
        return mark(texts_.size() - 1);
    }
    void put_into(std::string& text) const {
        std::size_t from = 0;
        for (std::size_t i = 0; i < texts_.size(); ++i) {
            const std::string quoted = '"' + mark(i) + '"';
            const std::size_t at = text.find(quoted, from);
            text.replace(at, quoted.size(), texts_[i]);
            from = at + texts_[i].size();
        }
    }

  private:
    std::vector<std::string> texts_;
};

Json garment_json(const GarmentFit& fit, Lists& lists) {
    Json out = {{"id", fit.id}, {"name", fit.name}, {"size", fit.size}};
    out["recommended_size"] = fit.recommended_size ? Json(*fit.recommended_size) : Json(nullptr);
    if (fit.between) out["between_sizes"] = Json::array({*fit.recommended_size, *fit.between});
    out["reasons"] = fit.reasons;
    out["measurements"] = girths_json(fit);
    out["lengths"] = lengths_json(fit);
    out["regions"] = regions_json(fit);
    out["contact"] = contact_json(fit.contact);
    out["strain"] = strain_json(fit.strain);
    out["vertices"]["count"] = fit.gap_m.size();
    out["vertices"]["ease_m"] = lists.add(fit.gap_m, kLength_m);
    out["vertices"]["strain_warp"] = lists.add(fit.warp, kStrain);
    out["vertices"]["strain_weft"] = lists.add(fit.weft, kStrain);
    out["vertices"]["pressure_pa"] = lists.add(fit.pressure_pa, kPressure_pa);
    return out;
}

} // namespace

std::string fit_text(const FitReport& report) {
    Lists lists;
    Json json = {{"schema", 1}, {"body", report.body}};
    json["contact"] = contact_json(contact_of(report));
    json["strain"] = strain_json(strain_of(report));
    json["failures"] = Json::array();
    for (const FitFailure& failure : report.failures) {
        Json row = {{"code", name_of(failure.code)}};
        if (!failure.garment.empty()) row["garment"] = failure.garment;
        row["text"] = failure.text;
        json["failures"].push_back(std::move(row));
    }
    json["garments"] = Json::array();
    for (const GarmentFit& fit : report.garments)
        json["garments"].push_back(garment_json(fit, lists));
    std::string text = json.dump(2) + "\n";
    lists.put_into(text);
    return text;
}

void write_fit(const FitReport& report, const std::filesystem::path& file) {
    std::ofstream out(file, std::ios::binary);
    out << fit_text(report);
    out.flush();
    if (!out) throw FileError(file.string(), "the fit report cannot be written");
}

} // namespace toile::garment
