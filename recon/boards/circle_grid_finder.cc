#include "recon/boards/circle_grid_finder.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "recon/boards/circle_blobs.h"
#include "recon/boards/lattice_sighting.h"
#include "recon/boards/point_lattice.h"
#include "recon/boards/seen_plane.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMostBlobs = 3000;
constexpr std::size_t kNearest = 8;
constexpr int kMostGrownSeeds = 60;
constexpr double kFurthestInCells = 0.3;
constexpr double kMostAreaRatio = 1.7;
constexpr double kLeastShare = 0.8;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Steps from one blob to two neighbours, where a blob's own shape says which directions are square and alike.
std::optional<LocalLattice> SeedAtBlob(const std::vector<CircleBlob>& blobs, std::size_t i) {
  struct Step {
    double length;  // in radii
    Vector2d in_radii;
    Vector2d in_pixels;
  };
  const CircleBlob& here = blobs[i];
  std::vector<Step> steps;
  for (std::size_t j = 0; j < blobs.size(); ++j) {
    const double ratio = blobs[j].area_px2 / here.area_px2;
    if (j == i || ratio > kMostAreaRatio || ratio < 1.0 / kMostAreaRatio) continue;
    const Vector2d offset = blobs[j].pixel - here.pixel;
    const Vector2d in_radii = here.unit_from_pixel * offset;
    if (in_radii.norm() > 2.0 && in_radii.norm() < 20.0) steps.push_back({in_radii.norm(), in_radii, offset});
  }
  const std::size_t count = std::min(kNearest, steps.size());
  std::partial_sort(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(count), steps.end(),
                    [](const Step& a, const Step& b) { return a.length < b.length; });
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      const double sine = Cross(steps[a].in_radii, steps[b].in_radii) / (steps[a].length * steps[b].length);
      if (sine < 0.9 || std::abs(std::log(steps[a].length / steps[b].length)) > 0.25) continue;
      LocalLattice local;
      local.pixel = here.pixel;
      local.pixel_from_squares << steps[a].in_pixels, steps[b].in_pixels;
      return local;
    }
  }
  return std::nullopt;
}

// The nearest blob to where a cell is expected, if it is near.
CellTrial BlobTrial(const std::vector<CircleBlob>& blobs, double area_px2_at_seed) {
  return [&blobs, area_px2_at_seed](LatticeCell, const LocalLattice& local) -> std::optional<LatticePoint> {
    const Eigen::Matrix2d cells_from_pixel = local.pixel_from_squares.inverse();
    const CircleBlob* nearest = nullptr;
    double least = kFurthestInCells;
    for (const CircleBlob& blob : blobs) {
      const double distance = (cells_from_pixel * (blob.pixel - local.pixel)).norm();
      const double ratio = blob.area_px2 / area_px2_at_seed;
      if (!(distance < least) || ratio > 20.0 || ratio < 0.05) continue;
      nearest = &blob;
      least = distance;
    }
    if (nearest == nullptr) return std::nullopt;
    return LatticePoint{nearest->pixel, 0.5, static_cast<std::size_t>(nearest - blobs.data())};
  };
}

// Cells of the whole board, one step of `square_mm` each.
std::vector<LatticeCell> CircleCells(const Board& board) {
  std::vector<LatticeCell> cells;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      cells.push_back({board.kind == BoardKind::kCircles ? column : 2 * column + row % 2, row});
  return cells;
}

// The nearest circles of an asymmetric grid are on diagonals; its cells are counted along the axes.
PointLattice AlongAxes(const PointLattice& diagonal) {
  PointLattice lattice;
  for (const auto& [cell, point] : diagonal)
    lattice[{cell.column - cell.row, cell.column + cell.row}] = point;
  return lattice;
}

// How far the centre of a circle's image is from the image of its centre.
Vector2d OffsetOfImage(const SeenPlane& plane, const Vector2d& center_in_board, double radius_mm) {
  constexpr int kCorners = 48;
  const Vector2d middle = plane.Project(center_in_board);
  const auto rim = [&](int k) -> Vector2d {
    const double angle = 2.0 * std::numbers::pi * k / kCorners;
    return plane.Project(center_in_board + radius_mm * Vector2d(std::cos(angle), std::sin(angle))) - middle;
  };
  Vector2d moment = Vector2d::Zero();
  double area2 = 0.0;
  for (int k = 0; k < kCorners; ++k) {
    const Vector2d a = rim(k), b = rim(k + 1);
    area2 += Cross(a, b);
    moment += Cross(a, b) * (a + b) / 3.0;
  }
  return area2 == 0.0 ? Vector2d::Zero() : Vector2d(moment / area2);
}

// Moves points from the ellipses' centres to the images of the circles' centres. `area_px2`: of each point's
// ellipse.
void CorrectForPerspective(const Board& board, const std::vector<double>& area_px2, const cv::Size& picture,
                           std::vector<SightedPoint>* points) {
  const std::vector<Eigen::Vector3d> points_in_board = PointsOf(board);
  const std::vector<SightedPoint> measured = *points;
  for (int round = 0; round < 2; ++round) {
    std::vector<PointPair> pairs;
    for (const SightedPoint& point : *points)
      pairs.push_back({points_in_board[static_cast<std::size_t>(point.point)].head<2>(), point.pixel});
    const auto plane = FitSeenPlane(pairs, picture.width, picture.height);
    if (!plane) return;
    std::vector<double> radii_mm;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double px2_per_mm2 = std::abs(plane->PixelFromBoard(pairs[i].from).determinant());
      radii_mm.push_back(std::sqrt(area_px2[i] / (std::numbers::pi * px2_per_mm2)));
    }
    std::ranges::nth_element(radii_mm, radii_mm.begin() + static_cast<std::ptrdiff_t>(radii_mm.size() / 2));
    const double radius_mm = radii_mm[radii_mm.size() / 2];
    for (std::size_t i = 0; i < pairs.size(); ++i)
      (*points)[i].pixel = measured[i].pixel - OffsetOfImage(*plane, pairs[i].from, radius_mm);
  }
}

std::optional<BoardSighting> SightingOfCircles(const cv::Mat& grey, const Board& board,
                                               const std::vector<CircleBlob>& blobs,
                                               const PointLattice& lattice) {
  const std::optional<LatticeNumbering> chosen =
      FromUpperLeft(NumberLattice(lattice, CircleCells(board)), lattice);
  if (!chosen) return std::nullopt;
  std::vector<SightedPoint> points;
  std::vector<double> area_px2;
  for (std::size_t i = 0; i < chosen->cells.size(); ++i) {
    if (!chosen->cells[i]) continue;
    const CircleBlob& blob = blobs[lattice.at(*chosen->cells[i]).candidate];
    const auto fit = FitCenter(grey, blob);
    if (!fit) continue;
    points.push_back({static_cast<int>(i), fit->pixel, fit->sigma_px});
    area_px2.push_back(blob.area_px2);
  }
  if (static_cast<double>(points.size()) < kLeastShare * static_cast<double>(chosen->cells.size()) ||
      points.size() < 4)
    return std::nullopt;
  CorrectForPerspective(board, area_px2, grey.size(), &points);
  return AgreeingSighting(std::move(points), board, grey.size(), kLeastShare);
}

}  // namespace

std::optional<BoardSighting> FindCircleGrid(const cv::Mat& grey, const Board& board) {
  const std::vector<CircleBlob> blobs = FindCircleBlobs(grey);
  if (blobs.size() > kMostBlobs) return std::nullopt;
  std::vector<bool> is_taken(blobs.size(), false);
  int seeds = 0;
  for (std::size_t i = 0; i < blobs.size() && seeds < kMostGrownSeeds; ++i) {
    if (is_taken[i]) continue;
    const auto local = SeedAtBlob(blobs, i);
    if (!local) continue;
    ++seeds;
    const CellTrial trial = BlobTrial(blobs, blobs[i].area_px2);
    PointLattice lattice;
    lattice[{0, 0}] = {blobs[i].pixel, 0.5, i};
    for (int axis = 0; axis < 2; ++axis) {
      LocalLattice next = *local;
      next.pixel += local->pixel_from_squares.col(axis);
      const LatticeCell cell = axis == 0 ? LatticeCell{1, 0} : LatticeCell{0, 1};
      if (const auto point = trial(cell, next)) lattice[cell] = *point;
    }
    const int most_across = 2 * std::max(board.columns, board.rows) + 2;
    const bool is_bounded = GrowLattice(lattice, most_across, trial);
    for (const auto& [cell, point] : lattice) is_taken[point.candidate] = true;
    if (!is_bounded) continue;
    const PointLattice by_axes = board.kind == BoardKind::kCircles ? lattice : AlongAxes(lattice);
    if (auto sighting = SightingOfCircles(grey, board, blobs, by_axes)) return sighting;
  }
  return std::nullopt;
}

}  // namespace elbowroom::recon
