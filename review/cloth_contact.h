// Moving a cloth's surface out of the hull.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "recon/hull/visual_hull.h"
#include "review/cloth.h"
#include "review/cloth_panel.h"

namespace elbowroom::review {

// One frame's contacts of one cloth with one hull. It keeps, for each triangle, how far its corners may move
// before the hull has to be asked about it again. Thread: one.
class ClothContact {
 public:
  // Panel, hull and state must outlive it. v_rec: unit.
  ClothContact(const ClothPanel& panel, const recon::VisualHull& hull, const Eigen::Vector3d& v_rec_in_world,
               ClothState* state);

  // Moves vertices and triangles' centres that the hull has passed since `last` to its far side. The hull is
  // looked for as far as an object at kFastestHandMmPerS moves in dt_s. `last` must outlive this.
  void CarryAlong(const recon::VisualHull& last, double dt_s);

  // Moves each piece whose centre is in the hull out of it along V_rec, once, to its side. Returns how many
  // pieces were moved. Triangles that certainly stayed out since the last call aren't asked about again.
  std::int64_t MoveOut();

  // From now on a piece that is moved gives its side to its corners, whatever theirs was.
  void AgreeOnSides() { sides_agree_ = true; }
  // From now on every piece leaves to the same side: the one to which the triangles in the hull have the
  // shorter way in all. Then nothing is moved to and fro, and repeated MoveOut() ends with nothing to move.
  void ChooseOneSide();

  // Forgets the sides of vertices that weren't in touch since this was made.
  void ForgetSides();

 private:
  // A piece of a triangle: its corners in barycentric coordinates of the triangle.
  struct Piece {
    std::array<Eigen::Vector3d, 3> weights;
  };
  using Corners = std::array<std::uint32_t, 3>;

  [[nodiscard]] Corners CornersOf(std::size_t triangle) const;
  [[nodiscard]] Eigen::Vector3d At(const Corners& corners, const Eigen::Vector3d& weights) const;
  [[nodiscard]] recon::PointAnswer Ask(const Eigen::Vector3d& x_in_world);
  double MoveTriangleOut(std::size_t triangle);
  double MovePieceOut(const Corners& corners, const Piece& piece);
  void Leave(const Corners& corners, const Eigen::Vector3d& weights);
  bool Push(const Corners& corners, const Eigen::Vector3d& weights, int side, double by_mm);
  [[nodiscard]] int SideOf(const Corners& corners, const Eigen::Vector3d& weights) const;
  [[nodiscard]] int SideAwayFromLast(const Eigen::Vector3d& from) const;
  void NoteSide(const Corners& corners, const Eigen::Vector3d& from);
  void CarryPoint(const Corners& corners, const Eigen::Vector3d& weights);

  const ClothPanel& panel_;
  const recon::VisualHull& hull_;
  Eigen::Vector3d v_rec_;  // in world
  ClothState* state_;
  bool sides_agree_;
  int one_side_;                             // 1 or -1: all leave to this side; 0: each to its own
  const recon::VisualHull* last_ = nullptr;  // the last frame's hull; null: none, or the same as hull_
  double reach_mm_ = 0.0;                    // how far an object may have moved since
  struct Known {
    std::array<Eigen::Vector3d, 3> corners;  // where they were when the hull was asked
    double free_mm = -1.0;  // while no corner has moved farther, the triangle is out of the hull
  };
  std::vector<Known> known_;           // one a triangle
  std::vector<std::uint8_t> touched_;  // one a vertex
};

}  // namespace elbowroom::review
