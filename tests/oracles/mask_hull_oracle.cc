#include "tests/oracles/mask_hull_oracle.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "tests/oracles/camera_projection.h"

namespace elbowroom::oracles {
namespace {

constexpr int kTilesASide = 512;
constexpr std::size_t kRow = kTilesASide + 1;
// Around an object pixel's centre: marching squares reach one pixel, a moved boundary half of one.
constexpr double kSurroundingsPx = 2.0;

// The normalised plane's box around a pixel's surroundings; nothing where the domain has a corner missing.
std::optional<Eigen::AlignedBox2d> BoxAround(const core::CameraModel& camera, int x, int y) {
  Eigen::AlignedBox2d box;
  for (const double dx : {-kSurroundingsPx, 0.0, kSurroundingsPx}) {
    for (const double dy : {-kSurroundingsPx, 0.0, kSurroundingsPx}) {
      const auto normalised = camera.NormalisedFromPixel({x + dx, y + dy});
      if (!normalised) return std::nullopt;
      box.extend(*normalised);
    }
  }
  return box;
}

}  // namespace

MaskHullOracle::ObjectTiles::ObjectTiles(const core::CameraModel& camera, const core::BitMask& mask)
    : sums_(kRow * kRow, 0) {
  std::vector<Eigen::AlignedBox2d> boxes;
  for (int y = 0; y < mask.height_px(); ++y) {
    for (int x = 0; x < mask.width_px(); ++x) {
      if (!mask.At(x, y)) continue;
      const auto box = BoxAround(camera, x, y);
      is_everywhere_ = is_everywhere_ || !box;
      if (!box) return;
      boxes.push_back(*box);
      bounds_.extend(*box);
    }
  }
  if (boxes.empty()) return;
  for (const Eigen::AlignedBox2d& box : boxes) {
    const Eigen::Vector2i first = TileOf(box.min()), last = TileOf(box.max());
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x)
        sums_[static_cast<std::size_t>(y + 1) * kRow + static_cast<std::size_t>(x + 1)] = 1;
  }
  for (std::size_t y = 1; y < kRow; ++y)
    for (std::size_t x = 1; x < kRow; ++x)
      sums_[y * kRow + x] +=
          sums_[(y - 1) * kRow + x] + sums_[y * kRow + x - 1] - sums_[(y - 1) * kRow + x - 1];
}

Eigen::Vector2i MaskHullOracle::ObjectTiles::TileOf(const Eigen::Vector2d& normalised) const {
  const Eigen::Vector2d share = (normalised - bounds_.min()).cwiseQuotient(bounds_.sizes());
  return (share * kTilesASide).array().floor().max(0.0).min(kTilesASide - 1.0).cast<int>();
}

bool MaskHullOracle::ObjectTiles::AnyIn(const Eigen::AlignedBox2d& normalised) const {
  if (is_everywhere_) return true;
  const Eigen::AlignedBox2d common = bounds_.intersection(normalised);
  if (common.isEmpty()) return false;
  const Eigen::Vector2i first = TileOf(common.min()), last = TileOf(common.max());
  const auto sum = [&](int x, int y) {
    return sums_[static_cast<std::size_t>(y) * kRow + static_cast<std::size_t>(x)];
  };
  return sum(last.x() + 1, last.y() + 1) - sum(first.x(), last.y() + 1) - sum(last.x() + 1, first.y()) +
             sum(first.x(), first.y()) >
         0;
}

MaskHullOracle::MaskHullOracle(core::Rig rig, std::span<const core::SoftMask> masks,
                               BoundaryConvention convention)
    : rig_(std::move(rig)) {
  core::Require(masks.size() == rig_.cameras.size(), "one mask a camera");
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const core::CameraModel& camera = rig_.cameras[i];
    core::Require(
        masks[i].mask.width_px() == camera.width_px() && masks[i].mask.height_px() == camera.height_px(),
        "a mask has its camera's size");
    const bool abstains = rig_.unseen == core::UnseenPolicy::kAbstain;
    labels_.emplace_back(masks[i], convention, abstains);
    if (abstains)
      outlines_.push_back(OutlineLabels(camera.width_px(), camera.height_px(), convention));
    else
      tiles_.emplace_back(camera, masks[i].mask);
  }
}

bool MaskHullOracle::Contains(const Vector3L& x_in_world, double grow_px) const {
  if (!rig_.workspace_mm.contains(x_in_world.cast<double>())) return false;
  const bool abstains = rig_.unseen == core::UnseenPolicy::kAbstain;
  bool is_seen = !abstains;  // under `outside` whoever doesn't see it says no
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    const std::optional<Vector2L> pixel = Project(rig_.cameras[i], x_in_world);
    if (!(pixel ? labels_[i].IsObject(*pixel, grow_px) : abstains)) return false;
    is_seen = is_seen || (pixel && outlines_[i].IsObject(*pixel, grow_px));
  }
  return is_seen;
}

bool MaskHullOracle::IsEmpty(const Vector3L& a_in_world, const Vector3L& b_in_world) const {
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const Vector3L a = InCam(rig_.cameras[i], a_in_world), b = InCam(rig_.cameras[i], b_in_world);
    if (a.z() <= 0.0L && b.z() <= 0.0L) return true;
    if (a.z() <= 0.0L || b.z() <= 0.0L) continue;
    // A straight line in space is one in the normalised plane: its box holds all between.
    Eigen::AlignedBox2d box;
    box.extend(Vector2L(a.head<2>() / a.z()).cast<double>());
    box.extend(Vector2L(b.head<2>() / b.z()).cast<double>());
    if (!tiles_[i].AnyIn(box)) return true;
  }
  return false;
}

std::optional<double> MaskHullOracle::FirstSurface(const recon::Ray& ray, double grow_px,
                                                   const MarchOptions& options) const {
  const auto span = ClipToBox(rig_.workspace_mm, ray, options.from_mm);
  if (!span) return std::nullopt;
  return FirstAlong(
      span->first, span->second, options.step_mm,
      [&](long double t) { return Contains(PointAt(ray, t), grow_px); },
      [&](long double t0, long double t1) { return IsEmpty(PointAt(ray, t0), PointAt(ray, t1)); });
}

}  // namespace elbowroom::oracles
