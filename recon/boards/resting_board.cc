#include "recon/boards/resting_board.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

// The same board numbered from its other end.
BoardSighting Turned(const Board& board, const BoardSighting& sighting) {
  BoardSighting turned = sighting;
  for (SightedPoint& point : turned.points) point.point = *PointAfterHalfTurn(board, point.point);
  std::ranges::sort(turned.points, {}, &SightedPoint::point);
  return turned;
}

// Root mean squares of what an affine map explains of points' movements, and of what it leaves.
struct SharedMovement {
  double shared_px = 0.0;
  double left_px = 0.0;
};

// Rows: (1, x, y) of where the points were; their movements.
SharedMovement MovementOf(const Eigen::MatrixX3d& places, const Eigen::MatrixX2d& movements) {
  const Eigen::MatrixX2d shared =
      places * Eigen::Matrix<double, 3, 2>(places.colPivHouseholderQr().solve(movements));
  const auto count = static_cast<double>(places.rows());
  return {std::sqrt(shared.squaredNorm() / count), std::sqrt((movements - shared).squaredNorm() / count)};
}

}  // namespace

RestingBoard::RestingBoard(const Board& board, const BoardSighting& first) : points_(PointsOf(board).size()) {
  if (PointAfterHalfTurn(board, 0)) turning_board_ = board;
  Take(first);
}

bool RestingBoard::Rests(const BoardSighting& sighting) const {
  constexpr Eigen::Index kFewest = 4;
  constexpr double kMostLeftPx = 1.5;  // noise is less; points that took each other's numbers are more
  Eigen::MatrixX3d places(static_cast<Eigen::Index>(sighting.points.size()), 3);
  Eigen::MatrixX2d movements(places.rows(), 2);
  Eigen::Index shared = 0;
  for (const SightedPoint& point : sighting.points) {
    const PointSum& sum = points_[static_cast<std::size_t>(point.point)];
    if (sum.count == 0) continue;
    places.row(shared) << 1.0, sum.first.transpose();
    movements.row(shared++) = (point.pixel - sum.first).transpose();
  }
  if (shared < kFewest) return false;
  const SharedMovement movement = MovementOf(places.topRows(shared), movements.topRows(shared));
  return movement.shared_px <= kMostRestPx && movement.left_px <= kMostLeftPx;
}

bool RestingBoard::Add(const BoardSighting& sighting) {
  if (Rests(sighting)) {
    Take(sighting);
    return true;
  }
  if (!turning_board_) return false;
  const BoardSighting turned = Turned(*turning_board_, sighting);
  if (!Rests(turned)) return false;
  Take(turned);
  return true;
}

void RestingBoard::Take(const BoardSighting& sighting) {
  for (const SightedPoint& point : sighting.points) {
    PointSum& sum = points_[static_cast<std::size_t>(point.point)];
    if (sum.count == 0) sum.first = point.pixel;
    const Vector2d change = point.pixel - sum.first;
    sum.change += change;
    sum.change2 += change.squaredNorm();
    sum.sigma_px += point.sigma_px;
    ++sum.count;
  }
  ++pictures_;
}

// The variance of the changes between pictures over the stated one; 1 unless it is below by three of its
// standard errors: a hundredth below 1, by chance, would be a third of what the mean of 30 pictures leaves.
double RestingBoard::ShareOfChange() const {
  constexpr double kStandardErrors = 3.0;
  double changes = 0.0, stated = 0.0, freedom = 0.0;
  for (const PointSum& sum : points_) {
    if (sum.count < 2) continue;
    changes += 0.5 * (sum.change2 - sum.change.squaredNorm() / sum.count);
    stated += (sum.count - 1) * std::pow(sum.sigma_px / sum.count, 2);
    freedom += 2.0 * (sum.count - 1);
  }
  if (stated <= 0.0) return 0.0;
  const double share = std::max(0.0, changes / stated);
  return share < 1.0 - kStandardErrors * std::sqrt(2.0 / freedom) ? share : 1.0;
}

BoardSighting RestingBoard::Mean() const {
  const double share = ShareOfChange();
  BoardSighting mean;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PointSum& sum = points_[i];
    if (sum.count == 0 || 2 * sum.count < pictures_) continue;
    const double left = 1.0 - share + share / std::min(sum.count, kMostPicturesOfRest);
    mean.points.push_back({static_cast<int>(i), sum.first + sum.change / sum.count,
                           sum.sigma_px / sum.count * std::sqrt(left)});
  }
  return mean;
}

}  // namespace elbowroom::recon
