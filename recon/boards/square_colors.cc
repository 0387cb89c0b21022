#include "recon/boards/square_colors.h"

#include <array>
#include <cmath>
#include <set>

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

constexpr std::array<double, 3> kPlaces{0.25, 0.5, 0.75};  // in a square, along each axis

// Nothing outside the picture.
std::optional<double> LevelAt(const cv::Mat& grey, const Vector2d& pixel) {
  const Vector2d rounded(std::round(pixel.x()), std::round(pixel.y()));
  if (!(rounded.minCoeff() >= 0.0 && rounded.x() < grey.cols && rounded.y() < grey.rows)) return std::nullopt;
  return grey.at<unsigned char>(static_cast<int>(rounded.y()), static_cast<int>(rounded.x()));
}

// The mean of the levels a quarter of a square away from a point, in all four squares: the middle of light
// and dark.
std::optional<double> MiddleLevel(const cv::Mat& grey, const LocalLattice& local) {
  double sum = 0.0;
  for (const double x : {-0.12, 0.12}) {
    for (const double y : {-0.12, 0.12}) {
      const auto level = LevelAt(grey, local.pixel + local.pixel_from_squares * Vector2d(x, y));
      if (!level) return std::nullopt;
      sum += *level;
    }
  }
  return 0.25 * sum;
}

}  // namespace

double ShareOfRightColors(const cv::Mat& grey, const PointLattice& lattice, int sign, bool empty) {
  std::set<LatticeCell> done;  // a square is named by the cell of its last corner
  int right = 0, all = 0;
  for (const auto& [cell, point] : lattice) {
    const std::optional<LocalLattice> local = PredictCell(lattice, cell);
    if (!local) continue;
    const std::optional<double> middle = MiddleLevel(grey, *local);
    if (!middle) continue;
    for (int side = 0; side < 4; ++side) {
      const int right_of = side % 2, below = side / 2;
      if (!done.insert({cell.column + right_of, cell.row + below}).second) continue;
      // The squares before and after the point on both axes are the light ones where the sign is +1.
      const bool is_light = (right_of == below) == (SignAt(cell, sign) > 0);
      if (is_light && !empty) continue;
      for (const double x : kPlaces) {
        for (const double y : kPlaces) {
          const Vector2d place(x - 1.0 + right_of, y - 1.0 + below);
          const auto level = LevelAt(grey, local->pixel + local->pixel_from_squares * place);
          if (!level) continue;
          ++all;
          if ((*level > *middle) == is_light) ++right;
        }
      }
    }
  }
  return all == 0 ? 0.0 : static_cast<double>(right) / all;
}

}  // namespace elbowroom::recon
