#include "recon/straightened_mask.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/coverage_texture.h"

namespace elbowroom::recon {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr double kThreshold = 127.5;
constexpr double kMostGrowth = 2.0;

// Where the picture's border lies in the normalised plane.
AlignedBox2d StraightBounds(const core::CameraModel& camera) {
  constexpr int kSteps = 64;  // a side
  AlignedBox2d bounds;
  const double width_px = camera.width_px(), height_px = camera.height_px();
  for (int i = 0; i <= kSteps; ++i) {
    const double x = width_px * i / kSteps - 0.5, y = height_px * i / kSteps - 0.5;
    for (const Vector2d& pixel :
         {Vector2d(x, -0.5), Vector2d(x, height_px - 0.5), Vector2d(-0.5, y), Vector2d(width_px - 0.5, y)}) {
      if (const auto normalised = camera.NormalisedFromPixel(pixel)) bounds.extend(*normalised);
    }
  }
  // A lens that folds before the picture's corners shows all of its domain.
  const Vector2d reach = Vector2d::Constant(camera.max_radius());
  return bounds.isEmpty() ? AlignedBox2d(-reach, reach) : bounds;
}

core::CameraModel StraightCamera(const core::CameraModel& camera) {
  const AlignedBox2d bounds = StraightBounds(camera);
  core::CameraCalibration c = camera.calibration();
  const auto growth = [](double extent_px, int size_px) {
    return std::max(1.0, extent_px / (kMostGrowth * size_px));
  };
  const double fx =
      c.camera_matrix(0, 0) / growth(bounds.sizes().x() * c.camera_matrix(0, 0), c.image_width_px);
  const double fy =
      c.camera_matrix(1, 1) / growth(bounds.sizes().y() * c.camera_matrix(1, 1), c.image_height_px);
  c.camera_matrix << fx, 0.0, -0.5 - fx * bounds.min().x(), 0.0, fy, -0.5 - fy * bounds.min().y(), 0.0, 0.0,
      1.0;
  c.image_width_px = std::max(2, static_cast<int>(std::ceil(fx * bounds.sizes().x())));
  c.image_height_px = std::max(2, static_cast<int>(std::ceil(fy * bounds.sizes().y())));
  c.distortion_model = core::DistortionModel::kPlumbBob;
  c.distortion_coefficients = {};
  return core::CameraModel(std::move(c));
}

// The coverage, 0 to 255, at a position of the real picture.
class Sampler {
 public:
  Sampler(const core::SoftMask& mask, bool exterior_is_object)
      : texture_(MakeCoverageTexture(mask)),
        picture_(Vector2d::Constant(-0.5), Vector2d(mask.mask.width_px() - 0.5, mask.mask.height_px() - 0.5)),
        exterior_(exterior_is_object ? 255.0 : 0.0) {}

  [[nodiscard]] double At(const Vector2d& position_px) const {
    if (!Holds(picture_, position_px)) return exterior_;
    if (!Holds(texture_.valid_px, position_px)) return 0.0;
    const double x = position_px.x() - texture_.left_px, y = position_px.y() - texture_.top_px;
    const double column = std::floor(x), row = std::floor(y), u = x - column, v = y - row;
    const auto width = static_cast<std::size_t>(texture_.width_texels);
    const std::uint8_t* texel =
        texture_.texels.data() + static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
    return (1.0 - v) * ((1.0 - u) * texel[0] + u * texel[1]) +
           v * ((1.0 - u) * texel[width] + u * texel[width + 1]);
  }

 private:
  static bool Holds(const AlignedBox2d& box, const Vector2d& p) {
    return (p.array() >= box.min().array()).all() && (p.array() < box.max().array()).all();
  }

  CoverageTexture texture_;
  AlignedBox2d picture_;
  double exterior_;
};

// Positions in the real picture of grid x grid places spread over the straight one.
std::vector<Vector2d> GridPositions(const core::CameraModel& real, const core::CameraModel& straight,
                                    int grid) {
  std::vector<Vector2d> positions;
  const Vector2d last(straight.width_px() - 1, straight.height_px() - 1);
  for (int j = 0; j < grid; ++j) {
    for (int i = 0; i < grid; ++i) {
      const Vector2d pixel = Vector2d(i, j).cwiseProduct(last) / (grid - 1);
      Vector2d normalised = *straight.NormalisedFromPixel(pixel);
      // The lens has no place beyond its domain: such a corner stands where the domain ends.
      const double radius = normalised.norm(), most = 0.999'999 * real.max_radius();
      if (radius > most) normalised *= most / radius;
      positions.push_back(real.PixelFromNormalised(normalised));
    }
  }
  return positions;
}

core::SoftMask SoftMaskOf(const std::vector<std::uint8_t>& coverage, int width_px, int height_px) {
  core::SoftMask soft{core::BitMask(width_px, height_px), {}};
  const auto pixels = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  const auto width = static_cast<std::size_t>(width_px);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (coverage[i] >= 128) soft.mask.Set(static_cast<int>(i % width), static_cast<int>(i / width), true);
  }
  const core::BitMask boundary = core::BoundaryPixels(soft.mask);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (boundary.At(static_cast<int>(i % width), static_cast<int>(i / width)))
      soft.levels.push_back(coverage[i]);
  }
  return soft;
}

}  // namespace

StraightenedMask Straighten(const core::CameraModel& camera, const core::SoftMask& mask, int grid,
                            bool exterior_is_object) {
  core::Require(grid >= 2, "an undistortion grid has at least 2 positions a side");
  core::CameraModel straight = StraightCamera(camera);
  const int width_px = straight.width_px(), height_px = straight.height_px();
  const std::vector<Vector2d> positions = GridPositions(camera, straight, grid);
  const Sampler sampler(mask, exterior_is_object);
  std::vector<std::uint8_t> coverage;
  coverage.reserve(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  const auto at = [&](int i, int j) {
    return positions[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid) +
                     static_cast<std::size_t>(i)];
  };
  for (int y = 0; y < height_px; ++y) {
    const double row = static_cast<double>(y) * (grid - 1) / (height_px - 1);
    const int j = std::min(static_cast<int>(row), grid - 2);
    for (int x = 0; x < width_px; ++x) {
      const double column = static_cast<double>(x) * (grid - 1) / (width_px - 1);
      const int i = std::min(static_cast<int>(column), grid - 2);
      const double u = column - i, v = row - j;
      const Vector2d position_px = (1.0 - v) * ((1.0 - u) * at(i, j) + u * at(i + 1, j)) +
                                   v * ((1.0 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
      const double value = sampler.At(position_px);
      // Half a level up is object, as the threshold has it.
      coverage.push_back(static_cast<std::uint8_t>(value >= kThreshold ? std::max(128.0, std::round(value))
                                                                       : std::min(127.0, std::round(value))));
    }
  }
  return {std::move(straight), SoftMaskOf(coverage, width_px, height_px)};
}

}  // namespace elbowroom::recon
