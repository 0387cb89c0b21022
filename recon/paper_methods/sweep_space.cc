#include "recon/paper_methods/sweep_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMostPlanes = 100'000;
// Certain answers keep this far from where rounding decides.
constexpr double kMarginPx = 1e-2;
constexpr double kMarginOfDepth = 1e-9;

using Corners = std::array<Vector3d, 8>;

struct CameraAnswer {
  bool is_background = false;  // all of the region
  bool is_object = false;      // all of it
  bool is_seen = false;        // all of it
};

AlignedBox2d Grown(const AlignedBox2d& box, double margin) {
  return {box.min() - Vector2d::Constant(margin), box.max() + Vector2d::Constant(margin)};
}

// Encloses the picture positions of all normalised positions in a box; nothing where the lens isn't known to
// have one for each.
std::optional<AlignedBox2d> PictureBounds(const core::CameraModel& camera, const AlignedBox2d& normalised) {
  const Vector2d far = normalised.min().cwiseAbs().cwiseMax(normalised.max().cwiseAbs());
  if (far.norm() >= camera.max_radius()) return std::nullopt;
  const Vector2d center = camera.PixelFromNormalised(normalised.center());
  const Vector2d half = 0.5 * normalised.sizes();
  Vector2d reach_px;
  if (camera.is_ideal()) {
    reach_px = camera.calibration().camera_matrix.topLeftCorner<2, 2>().cwiseAbs() * half;
  } else {
    reach_px.setConstant(camera.PixelStretch(far.norm()) * half.norm());
  }
  return AlignedBox2d(center - reach_px, center + reach_px);
}

// What the picture says of all positions in `bounds_px`.
CameraAnswer AskPicture(const SweepCamera& camera, const AlignedBox2d& bounds_px, bool exterior_is_object) {
  const int width_px = camera.model.width_px(), height_px = camera.model.height_px();
  const AlignedBox2d picture(Vector2d::Constant(-0.5), Vector2d(width_px - 0.5, height_px - 0.5));
  const CameraAnswer exterior{!exterior_is_object, exterior_is_object, false};
  if (!picture.intersects(bounds_px)) return exterior;
  const bool is_seen = picture.contains(Grown(bounds_px, kMarginPx));
  const AlignedBox2d inside = picture.intersection(bounds_px);
  const int x0 = std::max(static_cast<int>(std::floor(inside.min().x())), 0),
            y0 = std::max(static_cast<int>(std::floor(inside.min().y())), 0),
            x1 = std::min(static_cast<int>(std::floor(inside.max().x())) + 1, width_px - 1),
            y1 = std::min(static_cast<int>(std::floor(inside.max().y())) + 1, height_px - 1);
  return {(is_seen || !exterior_is_object) && !camera.occupancy.MayHoldObject(x0, y0, x1, y1),
          (is_seen || exterior_is_object) && !camera.occupancy.MayHoldBackground(x0, y0, x1, y1), is_seen};
}

CameraAnswer Ask(const SweepCamera& camera, const Corners& corners_in_view, bool exterior_is_object) {
  const CameraAnswer exterior{!exterior_is_object, exterior_is_object, false};
  if (camera.coverage.width_texels == 0 && !exterior_is_object) return exterior;
  AlignedBox2d normalised;
  double nearest = HUGE_VAL, farthest = -HUGE_VAL, size = 0.0;
  for (const Vector3d& corner_in_view : corners_in_view) {
    const Vector3d x_in_cam = camera.cam_from_view * corner_in_view;
    nearest = std::min(nearest, x_in_cam.z());
    farthest = std::max(farthest, x_in_cam.z());
    size = std::max(size, x_in_cam.cwiseAbs().maxCoeff());
    normalised.extend(x_in_cam.head<2>() / x_in_cam.z());
  }
  if (farthest <= -kMarginOfDepth * size) return exterior;
  if (nearest <= kMarginOfDepth * size) return {};
  const std::optional<AlignedBox2d> bounds_px = PictureBounds(camera.model, normalised);
  if (!bounds_px) {
    const bool is_beyond = normalised.exteriorDistance(Vector2d::Zero().eval()) >
                           camera.model.max_radius() * (1.0 + kMarginOfDepth);
    return is_beyond ? exterior : CameraAnswer{};
  }
  return AskPicture(camera, Grown(*bounds_px, kMarginPx), exterior_is_object);
}

}  // namespace

void PlaneSweepOptions::Validate() const {
  core::Require(spacing_mm > 0.0 && std::isfinite(spacing_mm), "planes have a positive spacing");
  core::Require(near_mm >= 0.0 && far_mm >= near_mm, "planes lie in front of the view, near before far");
  core::Require(undistortion_grid >= 0 && undistortion_grid <= 1024,
                "an undistortion grid has 1 to 1024 cells a side, or there is none (0)");
}

SweepSpace::SweepSpace(const core::Rig& rig, std::span<const core::SoftMask> masks,
                       const core::CameraModel& view, const SweepRays& rays, const PlaneSweepOptions& options)
    : rays_(rays),
      world_from_view_(view.cam_from_world().Inverse()),
      workspace_mm_(rig.workspace_mm),
      exterior_is_object_(rig.unseen == core::UnseenPolicy::kAbstain),
      spacing_mm_(options.spacing_mm) {
  options.Validate();
  core::Require(rays.width_px() == view.width_px() && rays.height_px() == view.height_px(),
                "a view's rays are its own");
  cameras_ = MakeSweepCameras(rig, masks, world_from_view_);
  PlacePlanes(options);
}

void SweepSpace::PlacePlanes(const PlaneSweepOptions& options) {
  const core::RigidTransform view_from_world = world_from_view_.Inverse();
  double near_mm = HUGE_VAL, far_mm = -HUGE_VAL;
  for (int i = 0; i < 8; ++i) {
    const Vector3d corner = workspace_mm_.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    const double depth_mm = (view_from_world * corner).z();
    near_mm = std::min(near_mm, depth_mm);
    far_mm = std::max(far_mm, depth_mm);
  }
  const double first = std::max(1.0, std::ceil(std::max(near_mm, options.near_mm) / spacing_mm_));
  const double last = std::floor(std::min(far_mm, options.far_mm) / spacing_mm_);
  if (!(first <= last)) return;
  if (last - first >= kMostPlanes) {
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("a spacing of {} mm puts {:.0f} planes into the workspace; choose a wider one "
                    "(at most {:.0f} planes)",
                    spacing_mm_, last - first + 1.0, kMostPlanes));
  }
  first_multiple_ = static_cast<std::int64_t>(first);
  plane_count_ = static_cast<int>(last - first) + 1;
}

OpenQuestions SweepSpace::AllQuestions() const {
  const std::uint64_t all =
      cameras_.size() == kMostSweepCameras ? ~std::uint64_t{0} : (std::uint64_t{1} << cameras_.size()) - 1;
  // Where the unseen is outside, a point that is object to every camera is seen by all.
  return {all, !exterior_is_object_, false};
}

std::optional<OpenQuestions> SweepSpace::Narrow(const SweepRegion& region, const OpenQuestions& open) const {
  const AlignedBox2d rays = rays_.BoundsOf(region.x0, region.y0, region.x1, region.y1);
  if (rays.isEmpty()) return std::nullopt;
  Corners corners_in_view;
  const double depths_mm[] = {DepthMmOf(region.first_plane), DepthMmOf(region.end_plane - 1)};
  for (std::size_t i = 0; i < corners_in_view.size(); ++i) {
    const Vector3d ray((i & 1U) != 0 ? rays.max().x() : rays.min().x(),
                       (i & 2U) != 0 ? rays.max().y() : rays.min().y(), 1.0);
    corners_in_view[i] = depths_mm[i >> 2U] * ray;
  }
  OpenQuestions left = open;
  if (!left.in_workspace) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& corner_in_view : corners_in_view) box.extend(world_from_view_ * corner_in_view);
    const Vector3d margin = Vector3d::Constant(1e-6 * depths_mm[1]);
    if (!workspace_mm_.intersects(Eigen::AlignedBox3d(box.min() - margin, box.max() + margin)))
      return std::nullopt;
    left.in_workspace = workspace_mm_.contains(Eigen::AlignedBox3d(box.min() - margin, box.max() + margin));
  }
  for (std::uint64_t bits = open.cameras; bits != 0; bits &= bits - 1) {
    const CameraAnswer answer =
        Ask(cameras_[static_cast<std::size_t>(std::countr_zero(bits))], corners_in_view, exterior_is_object_);
    if (answer.is_background) return std::nullopt;
    left.is_seen |= answer.is_seen;
    // A camera that may be the only one to see a point is asked until another is known to.
    if (answer.is_object && (answer.is_seen || left.is_seen)) left.cameras &= ~(bits & (~bits + 1));
  }
  return left;
}

bool SweepSpace::IsDeep(const SweepRegion& region) const {
  const double depth_mm = DepthMmOf(region.end_plane - 1) - DepthMmOf(region.first_plane);
  const AlignedBox2d rays = rays_.BoundsOf(region.x0, region.y0, region.x1, region.y1);
  return depth_mm > rays.sizes().maxCoeff() * DepthMmOf(region.first_plane);
}

}  // namespace elbowroom::recon
