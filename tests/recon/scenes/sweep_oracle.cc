#include "tests/recon/scenes/sweep_oracle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kUnit = 0x1p-24;  // half a last place of single precision

Sure SureOf(double value, double tolerance) {
  if (value > tolerance) return Sure::kYes;
  return value < -tolerance ? Sure::kNo : Sure::kUnsure;
}
Sure And(Sure a, Sure b) {
  if (a == Sure::kNo || b == Sure::kNo) return Sure::kNo;
  return a == Sure::kYes && b == Sure::kYes ? Sure::kYes : Sure::kUnsure;
}
Sure Not(Sure a) { return a == Sure::kUnsure ? a : (a == Sure::kYes ? Sure::kNo : Sure::kYes); }
Sure Or(Sure a, Sure b) { return Not(And(Not(a), Not(b))); }

// Coverage of every pixel, 0 to 1.
std::vector<double> CoverageOf(const core::SoftMask& soft) {
  const core::BitMask boundary = core::BoundaryPixels(soft.mask);
  std::vector<double> coverage;
  std::size_t next = 0;
  for (int y = 0; y < soft.mask.height_px(); ++y) {
    for (int x = 0; x < soft.mask.width_px(); ++x) {
      const bool has_level = !soft.levels.empty() && boundary.At(x, y);
      coverage.push_back(has_level ? soft.levels[next++] / 255.0 : (soft.mask.At(x, y) ? 1.0 : 0.0));
    }
  }
  return coverage;
}

Sure InBox(const Eigen::AlignedBox3d& box, const Vector3d& x_in_world, double error_mm) {
  const Vector3d inside = (x_in_world - box.min()).cwiseMin(box.max() - x_in_world);
  return SureOf(inside.minCoeff(), error_mm);
}

}  // namespace

PointOracle::PointOracle(const core::Rig& rig, std::span<const core::SoftMask> masks, const SweepBand& band)
    : rig_(rig), band_(band) {
  for (const core::SoftMask& mask : masks) coverages_.push_back(CoverageOf(mask));
}

double PointOracle::CoverageAt(std::size_t camera, const Vector2d& p) const {
  const int width_px = rig_.cameras[camera].width_px(), height_px = rig_.cameras[camera].height_px();
  const auto at = [&](double x, double y) {
    const auto column = static_cast<std::size_t>(std::clamp(x, 0.0, width_px - 1.0)),
               row = static_cast<std::size_t>(std::clamp(y, 0.0, height_px - 1.0));
    return coverages_[camera][row * static_cast<std::size_t>(width_px) + column];
  };
  const double x = std::floor(p.x()), y = std::floor(p.y()), u = p.x() - x, v = p.y() - y;
  return (1 - v) * ((1 - u) * at(x, y) + u * at(x + 1, y)) +
         v * ((1 - u) * at(x, y + 1) + u * at(x + 1, y + 1));
}

PointOracle::Opinion PointOracle::OpinionOf(std::size_t index, const Vector3d& x_in_world,
                                            double size_mm) const {
  const core::CameraModel& camera = rig_.cameras[index];
  const Vector3d x = camera.cam_from_world() * x_in_world;
  size_mm += camera.cam_from_world().translation_mm.norm() + x.norm();
  const double error_mm = band_.roundings * kUnit * size_mm;
  const Sure in_front = SureOf(x.z(), error_mm);
  if (in_front != Sure::kYes) return {in_front, in_front};
  const Vector2d n = x.head<2>() / x.z();
  const double error_n = error_mm / (x.z() - error_mm) * (1.0 + n.norm());
  const Sure in_domain = SureOf(camera.max_radius() - n.norm(), error_n + kUnit * camera.max_radius());
  if (in_domain != Sure::kYes) return {in_domain, in_domain};
  const Vector2d p = camera.PixelFromNormalised(n);
  const double size_px = camera.width_px() + camera.height_px() +
                         camera.calibration().camera_matrix.cwiseAbs().maxCoeff() * n.norm();
  return OpinionAt(
      index, {p, camera.PixelStretch(n.norm() + error_n) * error_n + band_.roundings * kUnit * size_px});
}

PointOracle::Opinion PointOracle::OpinionAt(std::size_t index, const PicturePosition& position) const {
  const core::CameraModel& camera = rig_.cameras[index];
  const Vector2d half(0.5 * camera.width_px(), 0.5 * camera.height_px());
  const Vector2d center = half - Vector2d::Constant(0.5);
  const Sure in_picture = SureOf((half - (position.px - center).cwiseAbs()).minCoeff(), position.error_px);
  if (in_picture == Sure::kNo) return {Sure::kNo, Sure::kNo};
  const Sure object =
      SureOf(CoverageAt(index, position.px) - 0.5, 2.0 * position.error_px + band_.filter_coverage);
  return {in_picture, And(in_picture, object)};
}

PointOracle::Opinion PointOracle::OpinionOfAny(
    std::size_t index, std::span<const std::optional<PicturePosition>> positions) const {
  std::optional<Opinion> all;
  for (const std::optional<PicturePosition>& position : positions) {
    const Opinion one = position ? OpinionAt(index, *position) : Opinion{Sure::kNo, Sure::kNo};
    if (!all) all = one;
    if (all->seen != one.seen) all->seen = Sure::kUnsure;
    if (all->object != one.object) all->object = Sure::kUnsure;
  }
  return *all;
}

Sure PointOracle::InHull(const Vector3d& x_in_world, double size_mm) const {
  return Decide(x_in_world, size_mm,
                [&](std::size_t camera) { return OpinionOf(camera, x_in_world, size_mm); });
}

Sure PointOracle::InHullAt(const Vector3d& x_in_world, double size_mm,
                           const PositionsOfCamera& positions) const {
  return Decide(x_in_world, size_mm,
                [&](std::size_t camera) { return OpinionOfAny(camera, positions(rig_.cameras[camera])); });
}

Sure PointOracle::Decide(const Vector3d& x_in_world, double size_mm,
                         const std::function<Opinion(std::size_t)>& opinion_of) const {
  const double error_mm = band_.roundings * kUnit * (size_mm + x_in_world.norm());
  Sure inside = InBox(rig_.workspace_mm, x_in_world, error_mm), seen = Sure::kNo;
  for (std::size_t i = 0; i < coverages_.size(); ++i) {
    if (inside == Sure::kNo) return inside;
    const Opinion opinion = opinion_of(i);
    seen = Or(seen, opinion.seen);
    const bool abstains = rig_.unseen == core::UnseenPolicy::kAbstain;
    inside = And(inside, abstains ? Or(opinion.object, Not(opinion.seen)) : opinion.object);
  }
  return And(inside, seen);
}

namespace {

// Which points of planes are in the hull, with a grid and without.
class SweptHull {
 public:
  SweptHull(const core::Rig& rig, std::span<const core::SoftMask> masks, const core::CameraModel& view,
            int undistortion_grid, const SweepBand& band)
      : points_(rig, masks, band), band_(band), world_from_view_(view.cam_from_world().Inverse()) {
    if (undistortion_grid > 0) grid_.emplace(view, undistortion_grid);
  }

  [[nodiscard]] Sure Holds(const Eigen::Vector2i& pixel, const Vector3d& x_in_view) const {
    const Vector3d x_in_world = world_from_view_ * x_in_view;
    const double size_mm = x_in_view.norm() + world_from_view_.translation_mm.norm();
    if (!grid_) return points_.InHull(x_in_world, size_mm);
    return points_.InHullAt(x_in_world, size_mm, [&](const core::CameraModel& camera) {
      return grid_->PositionsOf(camera, pixel.x(), pixel.y(), x_in_view.z(),
                                {band_.roundings, band_.corner_px});
    });
  }

 private:
  PointOracle points_;
  SweepBand band_;
  core::RigidTransform world_from_view_;
  std::optional<GridOracle> grid_;
};

}  // namespace

SweepCheck CheckSweep(const core::Rig& rig, std::span<const core::SoftMask> masks,
                      const core::CameraModel& view, const PlaneSweepOptions& options,
                      const DepthMap& picture, const SweepBand& band) {
  const SweptHull hull(rig, masks, view, options.undistortion_grid, band);
  double far_mm = 0.0;
  for (int i = 0; i < 8; ++i) {
    const auto corner = rig.workspace_mm.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    far_mm = std::max(far_mm, (view.cam_from_world() * corner).z());
  }
  SweepCheck check;
  for (int y = 0; y < view.height_px(); ++y) {
    for (int x = 0; x < view.width_px(); ++x) {
      const float depth = picture.depth_mm[static_cast<std::size_t>(y * view.width_px() + x)];
      const auto ray = view.NormalisedFromPixel({x, y});
      bool is_wrong = !ray && depth != 0.0F, is_unsure = false, is_found = depth == 0.0F;
      for (double k = 1; ray && k * options.spacing_mm <= std::min(far_mm, options.far_mm); ++k) {
        const double z_mm = k * options.spacing_mm;
        if (z_mm < options.near_mm) continue;
        const Sure inside = hull.Holds({x, y}, z_mm * ray->homogeneous());
        is_unsure |= inside == Sure::kUnsure;
        is_found |= static_cast<float>(z_mm) == depth;
        const bool is_here = depth != 0.0F && is_found;
        is_wrong |= inside == (is_here ? Sure::kNo : Sure::kYes);
        if (is_wrong && check.wrong_pixels == 0) {
          check.first_wrong = fmt::format("pixel ({}, {}): {} mm, oracle at {} mm: {}", x, y, depth, z_mm,
                                          inside == Sure::kYes ? "inside" : "outside");
        }
        if (is_here || is_wrong) break;
      }
      check.wrong_pixels += is_wrong || !is_found ? 1 : 0;
      check.unsure_pixels += is_unsure ? 1 : 0;
      check.hit_pixels += depth != 0.0F ? 1 : 0;
    }
  }
  return check;
}

core::SoftMask WithRandomLevels(Random* random, core::BitMask mask) {
  const core::BitMask boundary = core::BoundaryPixels(mask);
  core::SoftMask soft{std::move(mask), {}};
  for (int y = 0; y < boundary.height_px(); ++y) {
    for (int x = 0; x < boundary.width_px(); ++x) {
      if (!boundary.At(x, y)) continue;
      const int low = soft.mask.At(x, y) ? 128 : 0;
      soft.levels.push_back(static_cast<std::uint8_t>(random->Whole(low, low + 127)));
    }
  }
  soft.Validate();
  return soft;
}

core::CameraModel RandomView(Random* random, LensKind kind, const core::Rig& rig) {
  core::CameraCalibration c = RandomCamera(random, kind).calibration();
  const double size_mm = rig.workspace_mm.diagonal().norm();
  const double distance_mm = size_mm * random->Uniform(0.3, 1.5);
  // As wide as shows about the workspace: a telephoto's pictures would be all hull or none.
  const double f = std::clamp(c.camera_matrix(0, 0), 60.0, 400.0) / c.camera_matrix(0, 0);
  c.camera_matrix.topLeftCorner<2, 2>() *= f;
  const Vector3d center = rig.workspace_mm.center();
  c.cam_from_world =
      core::CamFromWorldLookingAt(center + distance_mm * random->Direction(),
                                  center + 0.1 * size_mm * random->Direction(), random->Direction());
  return core::CameraModel(std::move(c));
}

}  // namespace elbowroom::recon
