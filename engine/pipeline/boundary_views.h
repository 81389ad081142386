// Engine data as the plugin boundary wants it: C structs over memory that these objects keep.
#pragma once

#include "abi/toile.h"
#include "body/body_model.h"
#include "garment/package.h"
#include "host/views.h"

#include <memory>
#include <span>
#include <vector>

namespace toile::pipeline {

/// A body model as a `toile_body`. Not movable: the struct points into it.
class BoundaryBody {
  public:
    /// `revision` must differ from that of every other body alive.
    BoundaryBody(std::shared_ptr<const body::BodyModel> model, std::uint64_t revision);
    BoundaryBody(const BoundaryBody&) = delete;
    BoundaryBody& operator=(const BoundaryBody&) = delete;

    [[nodiscard]] const toile_body& abi() const { return abi_; }
    [[nodiscard]] const body::BodyModel& model() const { return *model_; }

  private:
    std::shared_ptr<const body::BodyModel> model_;
    std::vector<std::uint8_t> parts_;
    std::vector<toile_landmark> landmarks_;
    std::vector<toile_measurement> measurements_;
    toile_body abi_{};
};

/// One size of a garment package as a `toile_garment_package`. Not movable.
class BoundaryGarment {
  public:
    /// `made_on` may be null; it and `package` are kept.
    BoundaryGarment(std::shared_ptr<const garment::GarmentPackage> package,
                    const garment::GarmentSize& size, std::shared_ptr<const BoundaryBody> made_on);
    BoundaryGarment(const BoundaryGarment&) = delete;
    BoundaryGarment& operator=(const BoundaryGarment&) = delete;

    [[nodiscard]] const toile_garment_package& abi() const { return abi_; }
    [[nodiscard]] const garment::GarmentPackage& package() const { return *package_; }
    [[nodiscard]] const garment::GarmentSize& size() const { return size_; }
    /// ISO names to metres of the body that it was made on; null when that is not known.
    [[nodiscard]] const std::map<std::string, double>* made_on_measurements() const {
        return made_on_ ? &made_on_->model().measurements : nullptr;
    }

  private:
    std::shared_ptr<const garment::GarmentPackage> package_;
    const garment::GarmentSize& size_;
    std::shared_ptr<const BoundaryBody> made_on_;
    toile_garment_package abi_{};
};

} // namespace toile::pipeline
