#include "garment/fit_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace toile::garment {
namespace {

using body::Landmark;
using body::Part;

constexpr std::size_t kLeastOfSleeve = 12; // vertices; fewer are the edge of a shoulder

std::string centimetres(double metres) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.0f cm", 100.0 * std::abs(metres));
    return text.data();
}

/// "ends 3 cm above the knee"; closer than 1 cm: "ends at the knee".
std::string ends(double above_m, const std::string& where) {
    if (std::abs(above_m) < 0.01) return "ends at " + where;
    return "ends " + centimetres(above_m) + (above_m > 0.0 ? " above " : " below ") + where;
}

/// How far along the right arm the garment reaches, from the shoulder point.
std::optional<LengthFit> sleeve(const WearerView& wearer, const body::Figure& figure,
                                const SkinGap& gap, std::span<const Vec3f> cloth) {
    const auto at = [&](Landmark l) { return figure.landmarks[static_cast<std::size_t>(l)]; };
    const Vec3f shoulder = at(Landmark::right_shoulder), elbow = at(Landmark::right_elbow);
    const Vec3f wrist = at(Landmark::right_wrist);
    const float upper = (elbow - shoulder).norm(), lower = (wrist - elbow).norm();
    float farthest = 0.0f;
    std::size_t count = 0;
    for (std::size_t v = 0; v < cloth.size(); ++v) {
        const Part part = wearer.model.parts[gap.body_triangles()[gap.beneath()[v]][0]];
        float along = 0.0f;
        if (part == Part::right_upper_arm)
            along = std::min((cloth[v] - shoulder).dot(elbow - shoulder) / upper, upper);
        else if (part == Part::right_lower_arm)
            along = upper + (cloth[v] - elbow).dot(wrist - elbow) / lower;
        else
            continue;
        ++count;
        farthest = std::max(farthest, along);
    }
    if (count < kLeastOfSleeve) return std::nullopt;
    LengthFit out;
    out.name = "arm_length";
    out.body_m = static_cast<double>(upper + lower);
    out.garment_m = static_cast<double>(farthest);
    out.text = "the sleeve " + ends(out.body_m - out.garment_m, "the wrist");
    return out;
}

struct Height {
    std::string_view name;
    Landmark landmark;
    const char* in_words;
};
constexpr std::array<Height, 5> kHeights = {
    {{"ankle_height", Landmark::right_ankle, "the ankle"},
     {"knee_height", Landmark::right_knee, "the knee"},
     {"crotch_height", Landmark::crotch, "the crotch"},
     {"trochanter_height", Landmark::right_trochanter, "the top of the thigh"},
     {"ansur_waist_height", Landmark::navel, "the navel"}}};

/// The hem against the landmark whose height is nearest.
LengthFit hem(const body::Figure& figure, std::span<const Vec3f> cloth) {
    float floor = std::numeric_limits<float>::infinity(), low = floor;
    for (const Vec3f& p : figure.positions)
        floor = std::min(floor, figure.up.dot(p));
    for (const Vec3f& p : cloth)
        low = std::min(low, figure.up.dot(p));
    LengthFit best;
    double least = std::numeric_limits<double>::infinity();
    const auto hem_m = static_cast<double>(low - floor);
    for (const Height& height : kHeights) {
        const Vec3f& mark = figure.landmarks[static_cast<std::size_t>(height.landmark)];
        const auto body_m = static_cast<double>(figure.up.dot(mark) - floor);
        if (std::abs(hem_m - body_m) >= least) continue;
        least = std::abs(hem_m - body_m);
        best = {height.name, body_m, hem_m, "the hem " + ends(hem_m - body_m, height.in_words)};
    }
    return best;
}

void fail(const GarmentFit& fit, FitFailureCode code, std::string text,
          std::vector<FitFailure>& failures) {
    failures.push_back({code, fit.id, "garment " + fit.id + ": " + std::move(text)});
}

std::string of(std::size_t part, std::size_t whole) {
    return std::to_string(part) + " of " + std::to_string(whole);
}

} // namespace

std::vector<LengthFit> lengths_of(const WearerView& wearer, const body::Figure& figure,
                                  const SkinGap& gap, std::span<const Vec3f> cloth) {
    std::vector<LengthFit> out;
    if (auto found = sleeve(wearer, figure, gap, cloth)) out.push_back(std::move(*found));
    out.push_back(hem(figure, cloth));
    return out;
}

void add_failures(const GarmentFit& fit, std::vector<FitFailure>& failures) {
    constexpr double kDeep = 0.001, kCutting = 0.002, kStrain = 0.04;
    constexpr float kFar_m = 0.25f;
    const ContactFit& contact = fit.contact;
    if (contact.deep_fraction() > kDeep)
        fail(fit, FitFailureCode::deep_contact,
             of(contact.deep, contact.vertices) + " vertices lie more than 2 mm inside the body",
             failures);
    if (contact.self_intersections() > kCutting)
        fail(fit, FitFailureCode::self_intersections,
             of(contact.cutting, contact.triangles) + " triangles pass through others", failures);
    if (fit.strain.rms > kStrain)
        fail(fit, FitFailureCode::overstretched,
             "its cloth is strained by " + std::to_string(std::lround(100.0 * fit.strain.rms)) +
                 " % (rms), 4 % is much; try a larger size",
             failures);
    const auto far =
        std::count_if(fit.gap_m.begin(), fit.gap_m.end(), [](float gap) { return gap > kFar_m; });
    if (2 * static_cast<std::size_t>(far) > fit.gap_m.size())
        fail(fit, FitFailureCode::fell_off, "half of it is more than 25 cm from the body",
             failures);
    if (fit.girths.empty())
        fail(fit, FitFailureCode::not_measured,
             "no girth could be measured around the body; it gives no verdict", failures);
}

} // namespace toile::garment
