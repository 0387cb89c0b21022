// The points of a board that may be bent.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/rigid_transform.h"
#include "recon/boards/board.h"

namespace elbowroom::recon {

inline constexpr int kFlatnessTerms = 3;

// The board's points on its best plane, and how the flatness moves each of them along z.
//
// x^2, xy and y^2 are taken without their parts that a plane has, so that bending doesn't move or tilt the
// board: its frame stays the best plane through the printed points, which is what lies on the table.
class BoardSurface {
 public:
  explicit BoardSurface(const Board& board);

  [[nodiscard]] int points() const { return static_cast<int>(flat_.size()); }
  [[nodiscard]] const Eigen::Vector3d& Flat(int i) const { return flat_[static_cast<std::size_t>(i)]; }
  // z of the point for terms (1, 0, 0), (0, 1, 0) and (0, 0, 1) in mm; each is 1 at most.
  [[nodiscard]] const Eigen::Vector3d& Bending(int i) const { return bending_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] Eigen::Vector3d Bent(int i, const Eigen::Vector3d& terms_mm) const {
    return Flat(i) + Eigen::Vector3d(0.0, 0.0, Bending(i).dot(terms_mm));
  }
  // A board of one row or column bends in no way that can be told.
  [[nodiscard]] bool can_bend() const { return can_bend_; }
  // PointAfterHalfTurn; empty for boards whose points can be told apart.
  [[nodiscard]] const std::vector<int>& half_turn() const { return half_turn_; }
  // Turns the board by half a turn about its middle: each point goes where half_turn() says.
  [[nodiscard]] core::RigidTransform HalfTurn() const;
  // In the picture of a camera, the first corner is the one with the smaller x + y: the end by which a board
  // that looks the same after half a turn is told, where it is the world.
  [[nodiscard]] bool HasFirstCornerFirst(const core::RigidTransform& cam_from_board) const;
  [[nodiscard]] double diagonal_mm() const { return diagonal_mm_; }
  [[nodiscard]] const Eigen::Vector3d& center() const { return center_; }

 private:
  std::vector<Eigen::Vector3d> flat_;
  std::vector<Eigen::Vector3d> bending_;
  std::vector<int> half_turn_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double diagonal_mm_ = 0.0;
  bool can_bend_ = false;
};

}  // namespace elbowroom::recon
