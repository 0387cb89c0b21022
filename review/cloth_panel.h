// A cloth panel at rest: its vertices' masses, its springs, and what holds it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/bvh.h"
#include "core/layout.h"
#include "core/triangle_mesh.h"

namespace elbowroom::review {

// A spring between two vertices: |x_a - x_b| - rest = -compliance * force.
struct ClothSpring {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double rest_mm = 0.0;
  double compliance_mm_per_mn = 0.0;  // > 0; 1 mN = 1 kg mm/s^2
};

// The solver's data for a part whose layout says `gives_way = "cloth"`. Immutable. Frame: part.
class ClothPanel {
 public:
  // Throws: core::Error{kGeometry} naming the part: a triangle without area, pins that hold every vertex, no
  // axis of recovery and no mean normal (as for a closed surface), a hinge as its recovery.
  explicit ClothPanel(const core::Part& part);

  [[nodiscard]] const core::ClothRule& rule() const { return rule_; }
  [[nodiscard]] const core::TriangleMesh& rest() const { return *rest_; }
  // The tree of the mesh at rest: for questions about many triangles at once.
  [[nodiscard]] const core::TriangleTree& tree() const { return tree_; }
  // Reciprocal of a vertex's mass, 1/kg; 0: pinned.
  [[nodiscard]] const std::vector<double>& inverse_mass_per_kg() const { return inverse_mass_; }
  [[nodiscard]] double mass_kg() const { return mass_kg_; }
  // First the springs along the triangles' edges, then those between the far corners of two triangles that
  // share an edge, which resist bending.
  [[nodiscard]] const std::vector<ClothSpring>& springs() const { return springs_; }
  [[nodiscard]] std::size_t edge_springs() const { return edge_springs_; }
  // The line along which vertices leave the hull (the paper's constrained V_rec), unit; and whether they
  // leave only in its sense.
  [[nodiscard]] const Eigen::Vector3d& v_rec_in_part() const { return v_rec_; }
  [[nodiscard]] bool leaves_one_way() const { return leaves_one_way_; }

 private:
  void Weigh();
  void Pin(const std::string& part);
  void AddSprings();
  void ChooseWayOut(const core::Part& part);

  core::ClothRule rule_;
  core::SharedMesh rest_;
  core::TriangleTree tree_;
  std::vector<double> inverse_mass_;
  double mass_kg_ = 0.0;
  std::vector<ClothSpring> springs_;
  std::size_t edge_springs_ = 0;
  Eigen::Vector3d v_rec_;
  bool leaves_one_way_ = false;
};

}  // namespace elbowroom::review
