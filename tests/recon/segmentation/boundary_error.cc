#include "tests/recon/segmentation/boundary_error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace elbowroom::recon {
namespace {

struct LabelledPixel {
  int x = 0, y = 0;
};

class Truth {
 public:
  Truth(const core::CameraModel& camera, std::span<const Solid> solids) : camera_(camera), solids_(solids) {}

  [[nodiscard]] bool IsObject(const Eigen::Vector2d& position_px) const {
    const auto normalised = camera_.NormalisedFromPixel(position_px);
    if (!normalised) return false;
    const Ray ray{camera_.center_in_world(),
                  (camera_.cam_from_world().rotation.transpose() * normalised->homogeneous()).normalized()};
    return std::ranges::any_of(solids_, [&](const Solid& s) { return FirstHit(s, ray).has_value(); });
  }

  // Along object + t * towards, the t nearest to `located` where object ends; to 1e-4.
  [[nodiscard]] std::optional<double> Crossing(const Eigen::Vector2d& object, const Eigen::Vector2d& towards,
                                               double located) const {
    constexpr double kReach = 2.0, kStep = 0.125;
    std::optional<double> nearest;
    bool before = IsObject(object + (located - kReach) * towards);
    for (double t = located - kReach; t < located + kReach; t += kStep) {
      const bool after = IsObject(object + (t + kStep) * towards);
      if (before && !after) {
        double in = t, out = t + kStep;
        while (out - in > 1e-4) (IsObject(object + 0.5 * (in + out) * towards) ? in : out) = 0.5 * (in + out);
        if (!nearest || std::abs(in - located) < std::abs(*nearest - located)) nearest = in;
      }
      before = after;
    }
    return nearest;
  }

 private:
  const core::CameraModel& camera_;
  std::span<const Solid> solids_;
};

// Share of a step along `axis` that leads across the boundary: by the labels of 7 x 7 pixels.
double Across(const core::BitMask& mask, int x, int y, const Eigen::Vector2d& axis) {
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  for (int v = std::max(y - 3, 0); v <= std::min(y + 3, mask.height_px() - 1); ++v) {
    for (int u = std::max(x - 3, 0); u <= std::min(x + 3, mask.width_px() - 1); ++u)
      if (mask.At(u, v)) gradient += Eigen::Vector2d(u - x, v - y);
  }
  return gradient.norm() > 0.0 ? std::abs(gradient.normalized().dot(axis)) : 1.0;
}

}  // namespace

BoundaryError ErrorOfBoundary(const core::SoftMask& located, const core::CameraModel& camera,
                              std::span<const Solid> solids) {
  const core::BitMask& mask = located.mask;
  const core::BitMask boundary = core::BoundaryPixels(mask);
  std::map<std::pair<int, int>, double> level;
  auto next = located.levels.begin();
  for (int y = 0; y < mask.height_px(); ++y) {
    for (int x = 0; x < mask.width_px(); ++x) {
      if (boundary.At(x, y)) level[{x, y}] = located.levels.empty() ? (mask.At(x, y) ? 255.0 : 0.0) : *next++;
    }
  }
  const Truth truth(camera, solids);
  BoundaryError error;
  const auto measure = [&](const LabelledPixel& object, const LabelledPixel& background) {
    const Eigen::Vector2d from(object.x, object.y), towards(background.x - object.x, background.y - object.y);
    const double a = level.at({object.x, object.y}), b = level.at({background.x, background.y});
    const double t = (a - 127.5) / (a - b);
    const auto wanted = truth.Crossing(from, towards, t);
    if (!wanted) {
      ++error.unmatched;
      return;
    }
    const double outwards_px = (t - *wanted) * Across(mask, object.x, object.y, towards);
    ++error.crossings;
    error.bias_px += outwards_px;
    error.rms_px += outwards_px * outwards_px;
    error.worst_px = std::max(error.worst_px, std::abs(outwards_px));
  };
  for (int y = 0; y < mask.height_px(); ++y) {
    for (int x = 0; x < mask.width_px(); ++x) {
      for (const LabelledPixel& other : {LabelledPixel{x + 1, y}, LabelledPixel{x, y + 1}}) {
        if (other.x >= mask.width_px() || other.y >= mask.height_px()) continue;
        if (mask.At(x, y) == mask.At(other.x, other.y)) continue;
        mask.At(x, y) ? measure({x, y}, other) : measure(other, {x, y});
      }
    }
  }
  const auto n = static_cast<double>(std::max<std::size_t>(error.crossings, 1));
  error.bias_px /= n;
  error.rms_px = std::sqrt(error.rms_px / n);
  return error;
}

BoundaryError Pooled(std::span<const BoundaryError> errors) {
  BoundaryError pooled;
  for (const BoundaryError& error : errors) {
    const auto n = static_cast<double>(error.crossings);
    pooled.bias_px += n * error.bias_px;
    pooled.rms_px += n * error.rms_px * error.rms_px;
    pooled.worst_px = std::max(pooled.worst_px, error.worst_px);
    pooled.crossings += error.crossings;
    pooled.unmatched += error.unmatched;
  }
  const auto n = static_cast<double>(std::max<std::size_t>(pooled.crossings, 1));
  pooled.bias_px /= n;
  pooled.rms_px = std::sqrt(pooled.rms_px / n);
  return pooled;
}

}  // namespace elbowroom::recon
