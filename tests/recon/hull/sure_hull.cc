#include "tests/recon/hull/sure_hull.h"

#include <algorithm>
#include <cmath>

#include "tests/oracles/camera_projection.h"

namespace elbowroom::recon {
namespace {

using oracles::Vector2L;
using oracles::Vector3L;

// The oracle moves a boundary no farther.
constexpr long double kMostGrowPx = 0.5L;
constexpr long double kHalfUlp = 0x1p-53L;

Sure SureOf(long double value, long double error) {
  return value > error ? Sure::kYes : value < -error ? Sure::kNo : Sure::kUnsure;
}

// Of all positions within `error_px` of p.
Sure LabelAround(const oracles::PictureLabels& labels, const core::CameraModel& camera,
                 bool exterior_is_object, const Vector2L& p, long double error_px) {
  if (error_px > kMostGrowPx) {
    const long double beyond_px = std::max(
        {-p.x() - 0.5L, -p.y() - 0.5L, p.x() - camera.width_px() + 0.5L, p.y() - camera.height_px() + 0.5L});
    if (!(beyond_px > error_px)) return Sure::kUnsure;
    return exterior_is_object ? Sure::kYes : Sure::kNo;
  }
  const auto grow_px = static_cast<double>(error_px);
  if (labels.IsObject(p, -grow_px)) return Sure::kYes;
  return labels.IsObject(p, grow_px) ? Sure::kUnsure : Sure::kNo;
}

}  // namespace

SureHull::SureHull(const core::Rig& rig, std::span<const core::SoftMask> masks) : rig_(rig) {
  constexpr auto kConvention = oracles::BoundaryConvention::kMarchingSquares;
  for (const core::SoftMask& mask : masks) {
    labels_.emplace_back(mask, kConvention, rig.unseen == core::UnseenPolicy::kAbstain);
    outlines_.push_back(oracles::OutlineLabels(mask.mask.width_px(), mask.mask.height_px(), kConvention));
  }
}

SureHull::Opinion SureHull::Ask(std::size_t camera, const Vector3L& x_in_world,
                                const StressError& error) const {
  const core::CameraModel& model = rig_.cameras[camera];
  const bool exterior_is_object = rig_.unseen == core::UnseenPolicy::kAbstain;
  const Opinion unseen{exterior_is_object ? Sure::kYes : Sure::kNo, Sure::kNo};
  const Vector3L x = oracles::InCam(model, x_in_world);
  const long double rounding = error.roundings * kHalfUlp;
  const long double error_mm =
      error.mm + rounding * (x_in_world.lpNorm<1>() + model.cam_from_world().translation_mm.lpNorm<1>());
  const Sure in_front = SureOf(x.z(), error_mm);
  if (in_front == Sure::kNo) return unseen;
  if (in_front == Sure::kUnsure) return {Sure::kUnsure, Sure::kUnsure};
  const Vector2L n = x.head<2>() / x.z();
  const long double error_n = error_mm * (1.0L + n.norm()) / (x.z() - error_mm) + rounding * n.norm();
  const Sure in_domain = SureOf(model.max_radius() - n.norm(), error_n);
  if (in_domain == Sure::kNo) return unseen;
  if (in_domain == Sure::kUnsure) return {Sure::kUnsure, Sure::kUnsure};
  const Vector2L p = *oracles::Project(model, x_in_world);
  const double radius = std::min(static_cast<double>(n.norm() + error_n), model.max_radius());
  const long double size_px = model.width_px() + model.height_px() + p.norm();
  const long double error_px =
      error_n * model.PixelStretch(radius) + rounding * size_px + (model.is_ideal() ? 0.0L : error.lens_px);
  return {LabelAround(labels_[camera], model, exterior_is_object, p, error_px),
          LabelAround(outlines_[camera], model, false, p, error_px)};
}

Sure SureHull::IsInWorkspace(const Vector3L& x_in_world, const StressError& error) const {
  const long double error_mm = error.mm + error.roundings * kHalfUlp * x_in_world.lpNorm<1>();
  Sure sure = Sure::kYes;
  for (int axis = 0; axis < 3; ++axis) {
    const long double x = x_in_world[axis];
    const long double depth_mm =
        std::min(x - rig_.workspace_mm.min()[axis], rig_.workspace_mm.max()[axis] - x);
    sure = std::min(sure, SureOf(depth_mm, error_mm));
  }
  return sure;
}

Sure SureHull::Contains(const Vector3L& x_in_world, const StressError& error) const {
  Sure sure = IsInWorkspace(x_in_world, error);
  Sure any_sees = rig_.unseen == core::UnseenPolicy::kAbstain ? Sure::kNo : Sure::kYes;
  for (std::size_t i = 0; i < labels_.size() && sure != Sure::kNo; ++i) {
    const Opinion opinion = Ask(i, x_in_world, error);
    sure = std::min(sure, opinion.is_object);
    any_sees = std::max(any_sees, opinion.is_seen);
  }
  return std::min(sure, any_sees);
}

}  // namespace elbowroom::recon
