#include "recon/paper_methods/undistorted_mask.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/paper_methods/coverage_texture.h"

namespace elbowroom::recon {
namespace {

using Eigen::AlignedBox1d;
using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr double kThreshold = 127.5;
constexpr double kMostGrowth = 2.0;

// Where the picture's border lies in the normalised plane.
AlignedBox2d UndistortedBounds(const core::CameraModel& camera) {
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

core::CameraModel CameraWithoutLens(const core::CameraModel& camera) {
  const AlignedBox2d bounds = UndistortedBounds(camera);
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

// Positions in the real picture of grid x grid places spread over the undistorted one.
std::vector<Vector2d> GridPositions(const core::CameraModel& real, const core::CameraModel& undistorted,
                                    int grid) {
  std::vector<Vector2d> positions;
  const Vector2d last(undistorted.width_px() - 1, undistorted.height_px() - 1);
  for (int j = 0; j < grid; ++j) {
    for (int i = 0; i < grid; ++i) {
      const Vector2d pixel = Vector2d(i, j).cwiseProduct(last) / (grid - 1);
      Vector2d normalised = *undistorted.NormalisedFromPixel(pixel);
      // The lens has no place beyond its domain: such a corner stands where the domain ends.
      const double radius = normalised.norm(), most = 0.999'999 * real.max_radius();
      if (radius > most) normalised *= most / radius;
      positions.push_back(real.PixelFromNormalised(normalised));
    }
  }
  return positions;
}

// One byte a place of the undistorted picture.
struct Coverage {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

core::SoftMask SoftMaskOf(const Coverage& coverage) {
  core::SoftMask soft{core::BitMask(static_cast<int>(coverage.width), static_cast<int>(coverage.height)), {}};
  const std::size_t words = soft.mask.words_per_row();
  for (std::size_t y = 0; y < coverage.height; ++y) {
    const std::uint8_t* row = coverage.bytes.data() + y * coverage.width;
    for (std::size_t word = 0; word < words; ++word) {
      std::uint64_t bits = 0;
      for (std::size_t x = 64 * word; x < std::min(64 * word + 64, coverage.width); ++x) {
        bits |= std::uint64_t{row[x]} >> 7U << (x & 63U);
      }
      soft.mask.words()[y * words + word] = bits;
    }
  }
  const core::BitMask boundary = core::BoundaryPixels(soft.mask);
  for (std::size_t i = 0; i < boundary.words().size(); ++i) {
    const std::uint8_t* bytes = coverage.bytes.data() + i / words * coverage.width + i % words * 64;
    for (std::uint64_t bits = boundary.words()[i]; bits != 0; bits &= bits - 1) {
      soft.levels.push_back(bytes[std::countr_zero(bits)]);
    }
  }
  return soft;
}

// A rounded value is at least 128 exactly if the value reaches the threshold of object.
std::uint8_t ByteOf(double value) {
  return static_cast<std::uint8_t>(value >= kThreshold ? std::max(128.0, std::round(value))
                                                       : std::min(127.0, std::round(value)));
}

// The part of [0, 1] where from + u * (to - from) is in the box, and perhaps a little more.
AlignedBox1d PartWithin(const AlignedBox2d& box, const Vector2d& from, const Vector2d& to) {
  AlignedBox1d part(0.0, 1.0);
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const double step = to[axis] - from[axis];
    if (step == 0.0) continue;
    const double a = (box.min()[axis] - from[axis]) / step, b = (box.max()[axis] - from[axis]) / step;
    part = part.intersection(AlignedBox1d(std::min(a, b), std::max(a, b)));
  }
  return part;
}

// Fills the undistorted picture from the real one, cell by cell of the grid.
class MaskUndistorter {
 public:
  MaskUndistorter(const core::SoftMask& mask, bool exterior_is_object)
      : texture_(MakeCoverageTexture(mask)),
        picture_(Vector2d::Constant(-0.5), Vector2d(mask.mask.width_px() - 0.5, mask.mask.height_px() - 0.5)),
        exterior_is_object_(exterior_is_object) {}

  [[nodiscard]] Coverage Fill(const std::vector<Vector2d>& positions, int grid, int width_px,
                              int height_px) const {
    Coverage coverage{static_cast<std::size_t>(width_px), static_cast<std::size_t>(height_px), {}};
    coverage.bytes.resize(coverage.width * coverage.height);
    const double cells_a_row = static_cast<double>(grid - 1) / (height_px - 1),
                 cells_a_column = static_cast<double>(grid - 1) / (width_px - 1);
    for (int y = 0; y < height_px; ++y) {
      const int j = std::min(static_cast<int>(y * cells_a_row), grid - 2);
      const double v = y * cells_a_row - j;
      const auto at = [&](int i) -> Vector2d {
        const auto index =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(grid) + static_cast<std::size_t>(i);
        return (1.0 - v) * positions[index] + v * positions[index + static_cast<std::size_t>(grid)];
      };
      std::uint8_t* row = coverage.bytes.data() + static_cast<std::size_t>(y) * coverage.width;
      for (int i = 0; i + 1 < grid; ++i) FillCell(at(i), at(i + 1), i, cells_a_column, width_px, row);
    }
    return coverage;
  }

 private:
  // A row's places in cell `i` lie on the line from one position to the next.
  void FillCell(const Vector2d& from, const Vector2d& to, int i, double cells_a_column, int width_px,
                std::uint8_t* row) const {
    const AlignedBox1d part =
        exterior_is_object_ ? AlignedBox1d(0.0, 1.0) : PartWithin(texture_.valid_px, from, to);
    if (part.isEmpty()) return;
    const int begin = std::max(static_cast<int>((i + part.min()[0]) / cells_a_column), 0),
              end = std::min(static_cast<int>((i + part.max()[0]) / cells_a_column) + 2, width_px);
    for (int x = begin; x < end; ++x) {
      const double u = x * cells_a_column - i;
      // A place on the border of two cells has the same position in both.
      if (u < 0.0 || u > 1.0) continue;
      const Vector2d position_px = from + u * (to - from);
      const bool is_seen = !exterior_is_object_ || picture_.contains(position_px);
      row[x] = is_seen ? ByteOf(CoverageAt(texture_, position_px)) : std::uint8_t{255};
    }
  }

  CoverageTexture texture_;
  AlignedBox2d picture_;
  bool exterior_is_object_;
};

}  // namespace

UndistortedMask Undistort(const core::CameraModel& camera, const core::SoftMask& mask, int grid,
                          bool exterior_is_object) {
  core::Require(grid >= 2, "an undistortion grid has at least 2 positions a side");
  core::CameraModel undistorted = CameraWithoutLens(camera);
  const Coverage coverage = MaskUndistorter(mask, exterior_is_object)
                                .Fill(GridPositions(camera, undistorted, grid), grid, undistorted.width_px(),
                                      undistorted.height_px());
  return {std::move(undistorted), SoftMaskOf(coverage)};
}

}  // namespace elbowroom::recon
