// A part's surface cut into stretches, and a tree over them that knows which of them are near each other.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/bvh.h"
#include "review/triangle_bisection.h"

namespace elbowroom::review {

// A stretch of surface that becomes at most one contact point: a whole node of the part's tree, or a triangle
// or part of one. Frame: the part's.
struct ContactStretch {
  Corners corners;                    // of a triangle; without meaning for a node
  core::Ball ball;                    // around it
  std::optional<std::uint32_t> node;  // of the part's tree
};

// The stretches into which the search for contacts cuts a part (contact_search.h), in the order in which it
// meets them. The part's own tree puts whole triangles together, so it can't settle the middle of a fan, or
// where long strips lie side by side; this tree puts stretches together. It depends on the part and on the
// spacing of contact points alone. Immutable. Thread: any.
class ContactStretches {
 public:
  // Covers stretches at(begin) .. at(end - 1). Children are `left` and `left + 1`, leaves have left == 0. The
  // ball encloses the stretches, the box as well, in the part's frame.
  struct Node {
    core::Ball ball;
    Eigen::AlignedBox3d box;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t left = 0;
    std::uint32_t triangles = 0;  // a triangle is counted where its first stretch is
  };

  // A part of which there would be more is searched by its own tree. Of a box of 300 mm there are some twenty
  // thousand at the default spacing; each takes some 150 bytes.
  static constexpr std::size_t kMost = 200'000;

  // Null if there were more than kMost, or no triangle. `part` must outlive it.
  [[nodiscard]] static std::unique_ptr<const ContactStretches> Make(const core::TriangleTree& part,
                                                                    double point_spacing_mm);

  [[nodiscard]] bool AreOf(const core::TriangleTree& part, double point_spacing_mm) const {
    return &part == &part_ && point_spacing_mm == point_spacing_mm_;
  }
  [[nodiscard]] std::size_t size() const { return stretches_.size(); }
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  // The stretches in the tree's order, and the place of each in the order of the search.
  [[nodiscard]] const ContactStretch& at(std::uint32_t i) const { return stretches_[i]; }
  [[nodiscard]] std::uint32_t place(std::uint32_t i) const { return places_[i]; }

 private:
  ContactStretches(const core::TriangleTree& part, double point_spacing_mm)
      : part_(part), point_spacing_mm_(point_spacing_mm) {}

  // False if there are too many.
  [[nodiscard]] bool CutNode(std::uint32_t node);
  [[nodiscard]] bool CutTriangle(const Corners& triangle);
  [[nodiscard]] bool Add(const ContactStretch& stretch, std::uint32_t triangles);
  void Build(std::uint32_t node);

  const core::TriangleTree& part_;
  double point_spacing_mm_;
  std::vector<ContactStretch> stretches_;
  std::vector<std::uint32_t> places_;
  std::vector<std::uint32_t> triangles_;  // by place: how many begin with that stretch
  std::vector<Node> nodes_;
};

}  // namespace elbowroom::review
