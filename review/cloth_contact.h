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

// One frame's contacts of one cloth with one hull. Remembers where the hull certainly isn't, so that what
// hardly moves isn't asked about again. Thread: one.
class ClothContact {
 public:
  // All must outlive it. v_rec: unit, in world.
  ClothContact(const ClothPanel& panel, const recon::VisualHull& hull, const Eigen::Vector3d& v_rec_in_world,
               ClothState* state);

  // Takes along what the hull has stepped over since `last`, moving no faster than kFastestHandMmPerS; `last`
  // must outlive this.
  void CarryAlong(const recon::VisualHull& last, double dt_s);

  // Moves what is in the hull out of it along V_rec, once, each piece to its side; how many pieces were
  // moved. What hasn't moved since the last call isn't asked about again.
  std::int64_t MoveOut();

  // From now on a piece's corners leave to its side, whatever theirs was.
  void AgreeOnSides() { sides_agree_ = true; }
  // From now on every piece leaves to one and the same side: the one to which the triangles in the hull have
  // less far to go in all. Then nothing is moved to and fro, and MoveOut() ends up with nothing to move.
  void ChooseOneSide();

  // Vertices that were in touch since this was made; the others' sides are forgotten.
  void ForgetSides();

 private:
  // A piece of a triangle, its corners as weights of the triangle's.
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
  int one_side_;                             // 0: to each its own
  const recon::VisualHull* last_ = nullptr;  // of the frame before; null: none, or the same
  double reach_mm_ = 0.0;                    // how far anything may have come since
  struct Known {
    std::array<Eigen::Vector3d, 3> corners;  // where they were when the hull was asked
    double free_mm = -1.0;                   // while none has moved farther, the triangle is out of the hull
  };
  std::vector<Known> known_;           // one a triangle
  std::vector<std::uint8_t> touched_;  // one a vertex
};

}  // namespace elbowroom::review
