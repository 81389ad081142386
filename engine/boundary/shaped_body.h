// A shape of a body model as the plugin boundary tells it.
#pragma once

#include "abi/body.h"
#include "body/body_model.h"
#include "body/body_shape.h"
#include "body/measurement.h"
#include "sdk/views.h"

#include <vector>

namespace toile::boundary {

/// Owns what `abi` points to, beside the model, which must outlive it. Not movable.
class ShapedBody {
  public:
    ShapedBody(const body::BodyModel& model, const body::BodyShape& shape,
               std::span<const double> coefficients, const body::Measurements& measurements,
               std::uint64_t revision)
        : rest_(shape.positions), normals_(rest_.size()),
          joints_(shape.skeleton.rest_positions.begin(), shape.skeleton.rest_positions.end()) {
        for (const double c : coefficients)
            coefficients_.push_back(static_cast<float>(c));
        geometry::vertex_normals(rest_, model.rest.triangles, normals_);
        for (const auto part : model.parts)
            parts_.push_back(static_cast<std::uint8_t>(part));
        for (const auto& [name, vertex] : model.landmarks)
            landmarks_.push_back({name.c_str(), vertex, 0});
        for (const body::Measurement& m : measurements)
            measurements_.push_back(
                {m.name.data(), static_cast<float>(m.value_m), static_cast<float>(m.confidence)});
        abi_.size = sizeof(abi_);
        abi_.revision = revision;
        abi_.model_id = model.id.c_str();
        abi_.coefficients = view_of(coefficients_, TOILE_F32);
        abi_.rest.size = sizeof(abi_.rest);
        abi_.rest.positions = view_of(rest_, TOILE_F32X3);
        abi_.rest.normals = view_of(normals_, TOILE_F32X3);
        abi_.rest.triangles = view_of(model.rest.triangles, TOILE_U32X3);
        abi_.rest.topology_id = 1;
        abi_.rest_joints = view_of(joints_, TOILE_F32X3);
        abi_.joint_indices = view_of(model.skin.joints, TOILE_U16X4);
        abi_.joint_weights = view_of(model.skin.weights, TOILE_F32X4);
        abi_.part_labels = view_of(parts_, TOILE_U8);
        abi_.landmarks = view_of(landmarks_, TOILE_STRUCT);
        abi_.measurements = view_of(measurements_, TOILE_STRUCT);
    }
    ShapedBody(const ShapedBody&) = delete;
    ShapedBody& operator=(const ShapedBody&) = delete;

    [[nodiscard]] const toile_body& abi() const noexcept { return abi_; }

  private:
    template <class T>
    static toile_view view_of(const std::vector<T>& rows, std::uint32_t format) noexcept {
        return {rows.data(), static_cast<std::uint32_t>(rows.size()),
                static_cast<std::uint32_t>(sizeof(T)), format, 0};
    }

    std::vector<float> coefficients_;
    std::vector<Vec3f> rest_, normals_, joints_;
    std::vector<std::uint8_t> parts_;
    std::vector<toile_landmark> landmarks_;
    std::vector<toile_measurement> measurements_;
    toile_body abi_{};
};

} // namespace toile::boundary
