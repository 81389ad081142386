// From what cameras or a scanner gave to one fitted person, or the reason why there is none.
#pragma once

#include "body/measurer.h"
#include "core/error.h"
#include "scape_fit/camera_placement.h"
#include "scape_fit/scan_input.h"

#include <nlohmann/json.hpp>

namespace toile::scape_fit {

struct SessionOptions {
    std::optional<body::Sex> sex;
    bool dressed = false;
    std::function<bool(double)> progress = [](double) { return false; };
};

/// What was seen is no person, or cannot be used. The text says why and what to do.
class NotFitted : public Error {
  public:
    using Error::Error;
};

class FitSession {
  public:
    explicit FitSession(const FitModel& model);

    /// Forgets what was fed. No cameras: a scan will be fed.
    void begin(std::vector<FitCamera> cameras);
    /// One picture of each camera, of one instant; `colors` of the same pixels, or empty ones.
    /// \throw NotFitted when sizes differ
    void add_instant(std::vector<imaging::DepthImage> depths,
                     std::vector<imaging::Image> colors = {});
    /// `colors` (nv) sRGB of its vertices, or none; of a dressed person they tell skin from cloth.
    void add_scan(geometry::TriangleMesh scan,
                  std::vector<std::array<std::uint8_t, 4>> colors = {});

    /// \throw NotFitted, Cancelled
    void fit(const SessionOptions& options, const RowLoop& rows);

    [[nodiscard]] bool fitted() const { return fitted_; }
    [[nodiscard]] const FitCamera& camera(std::size_t index) const { return cameras_.at(index); }
    [[nodiscard]] const FitModel& model() const { return model_; }
    [[nodiscard]] const FitResult& result() const { return result_; }
    /// At rest, with all detail, on the model's topology.
    [[nodiscard]] const body::BodyShape& rest() const { return rest_; }
    [[nodiscard]] const body::Measurements& measurements() const { return measurements_; }
    [[nodiscard]] std::size_t instant_count() const { return result_.state.poses.size(); }
    /// The surface in the pose of an instant, as it was seen; metres.
    [[nodiscard]] PosedLevel surface(std::size_t instant) const;
    [[nodiscard]] const nlohmann::ordered_json& report() const { return report_; }

  private:
    struct Input;
    [[nodiscard]] Input scan_input();
    [[nodiscard]] Input depth_input(const SessionOptions& options, const RowLoop& rows);
    void place_lost_cameras(const SessionOptions& options, const RowLoop& rows, Input& input);
    void add_pictures(Input& input) const;
    void judge(const Input& input) const;
    void report_cameras(const Input& input);

    const FitModel& model_;
    Fitter fitter_;
    body::Measurer measurer_;
    std::vector<FitCamera> cameras_;
    std::vector<std::vector<imaging::DepthImage>> instants_;
    std::vector<std::vector<imaging::Image>> colors_; ///< of the instants
    std::optional<geometry::TriangleMesh> scan_;
    std::vector<std::array<std::uint8_t, 4>> scan_colors_;
    bool fitted_ = false;
    FitResult result_;
    body::BodyShape rest_;
    body::Measurements measurements_;
    nlohmann::ordered_json report_;
};

} // namespace toile::scape_fit
