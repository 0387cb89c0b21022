#include "core/part_distance.h"

#include <algorithm>
#include <cmath>

namespace elbowroom::core {
namespace {

using Eigen::Vector3d;

// Triangles with a smaller squared sine at corner a are treated as needles.
constexpr double kNeedle = 1e-6;
// A node whose radius is no larger than this share of half the box's diagonal isn't opened for a bound.
constexpr double kSmallNode = 0.5;
// With an allowance, a stretch may be longer than it must be by this share of the half edge.
constexpr double kLonger = 0.05;

Vector3d NearestOnSegment(const Vector3d& x, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp(ab.dot(x - a) / length2, 0.0, 1.0) : 0.0;
  return a + share * ab;
}

Vector3d Nearer(const Vector3d& x, const Vector3d& p, const Vector3d& q) {
  return (q - x).squaredNorm() < (p - x).squaredNorm() ? q : p;
}

Vector3d NearestOnNeedle(const Vector3d& x, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  const auto is_left_of = [&](const Vector3d& from, const Vector3d& to) {
    return normal.dot((to - from).cross(x - from)) >= 0.0;
  };
  const double length2 = normal.squaredNorm();
  if (length2 > 0.0 && is_left_of(a, b) && is_left_of(b, c) && is_left_of(c, a)) {
    Vector3d foot = x - (normal.dot(x - a) / length2) * normal;
    if (foot.allFinite()) return foot;
  }
  return Nearer(x, Nearer(x, NearestOnSegment(x, a, b), NearestOnSegment(x, b, c)),
                NearestOnSegment(x, c, a));
}

// Goes down the tree, nearer child first, and skips branches whose box or disc is too far.
class Search {
 public:
  Search(const TriangleTree& part, const BoxInPart& box)
      : part_(part),
        x_(box.center),
        edges_(box.half_edges.transpose()),
        allowance_mm_(box.allowance_mm),
        longer_(box.allowance_mm > 0.0 ? kLonger : 0.0) {}

  void FindNearest(std::uint32_t likely) {
    TryNearest(likely);
    VisitNearest(0, SquaredFromBox(0));
  }

  // After FindNearest: the box's bound by the triangle found alone. The bound over all triangles is no
  // larger.
  [[nodiscard]] double MostOfBox() const {
    return nearest_.distance_mm - Reach(x_ - nearest_.position_in_part);
  }

  void BoundBox() {
    least_mm_ = MostOfBox();
    nearest_.box_lower_mm = least_mm_;
    VisitBound(0);
  }

  [[nodiscard]] const NearestOnPart& nearest() const { return nearest_; }

  NearStretch FindNearStretch(Eigen::Index axis, double within_mm, std::uint32_t likely, double longest) {
    longest_ = longest;
    NearStretch stretch = NearTo(x_ - NearestOn(likely), axis, within_mm);
    if (!stretch.is_empty())
      stretch = {std::max(stretch.from - longer_, -1.0), std::min(stretch.to + longer_, 1.0)};
    VisitNear(0, axis, within_mm, &stretch);
    if (stretch.length() > longest_) return {-1.0, 1.0};
    return stretch;
  }

 private:
  [[nodiscard]] Vector3d NearestOn(std::uint32_t triangle) const {
    const auto& [a, b, c] = part_.mesh().triangles[triangle];
    const auto vertex = [&](std::int32_t i) -> const Vector3d& {
      return part_.mesh().vertices_mm[static_cast<std::size_t>(i)];
    };
    return NearestOnTriangle(x_, vertex(a), vertex(b), vertex(c));
  }

  [[nodiscard]] double SquaredFromBox(std::uint32_t index) const {
    return part_.nodes()[index].box.squaredExteriorDistance(x_);
  }

  // How much nearer a point of the box can be than its centre to a plane across `away`: with n = away /
  // |away|, the sum of |n . e_i| over the half edges e_i. If `away` is 0, half of the diagonal.
  [[nodiscard]] double Reach(const Vector3d& away) const {
    const double length = away.norm();
    return length > 0.0 ? (edges_ * away).lpNorm<1>() / length : edges_.norm();
  }

  void TryNearest(std::uint32_t triangle) {
    const Vector3d p = NearestOn(triangle);
    const double squared = (p - x_).squaredNorm();
    if (squared >= squared_) return;
    squared_ = squared;
    nearest_ = {std::sqrt(squared), p, triangle};
  }

  // The way from the nearest point of the disc.
  [[nodiscard]] Vector3d FromDisc(const Disc& disc) const {
    const Vector3d from_center = x_ - disc.center;
    const double height = disc.normal.dot(from_center);
    const double above = height - std::clamp(height, -disc.half_height_mm, disc.half_height_mm);
    const Vector3d aside = from_center - height * disc.normal;
    const double length = aside.norm();
    const double beside = std::max(length - disc.radius_mm, 0.0);
    return above * disc.normal + (length > 0.0 ? beside / length : 0.0) * aside;
  }

  void VisitNearest(std::uint32_t index, double squared_bound) {
    const double worthwhile_mm = nearest_.distance_mm - allowance_mm_;
    const double squared_mm2 = worthwhile_mm * worthwhile_mm;
    if (worthwhile_mm <= 0.0 || squared_bound >= squared_mm2) return;
    const TriangleTree::Node& node = part_.nodes()[index];
    if (FromDisc(node.disc).squaredNorm() >= squared_mm2) return;
    if (node.left == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) TryNearest(part_.order()[i]);
      return;
    }
    const double left = SquaredFromBox(node.left), right = SquaredFromBox(node.left + 1);
    const std::uint32_t nearer = left <= right ? 0 : 1;
    VisitNearest(node.left + nearer, std::min(left, right));
    VisitNearest(node.left + 1 - nearer, std::max(left, right));
  }

  // The node is small compared with the box: then the bound by the node's own box is taken. It holds for all
  // triangles in the node, and costs no more work.
  [[nodiscard]] bool IsSmall(const TriangleTree::Node& node) const {
    return node.ball.radius_mm <= kSmallNode * edges_.norm();
  }

  void VisitBound(std::uint32_t index) {
    const TriangleTree::Node& node = part_.nodes()[index];
    const Vector3d away = x_ - node.box.min().cwiseMax(x_.cwiseMin(node.box.max()));
    double lower_mm = away.norm() - Reach(away);
    if (lower_mm >= nearest_.box_lower_mm) return;
    const Vector3d from_disc = FromDisc(node.disc);
    lower_mm = std::max(lower_mm, from_disc.norm() - Reach(from_disc));
    if (lower_mm >= least_mm_ - allowance_mm_ || IsSmall(node)) {
      nearest_.box_lower_mm = std::min(nearest_.box_lower_mm, lower_mm);
      return;
    }
    if (node.left != 0) {
      VisitBound(node.left);
      VisitBound(node.left + 1);
      return;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const Vector3d from_triangle = x_ - NearestOn(part_.order()[i]);
      least_mm_ = std::min(least_mm_, from_triangle.norm() - Reach(from_triangle));
      nearest_.box_lower_mm = std::min(nearest_.box_lower_mm, least_mm_);
    }
  }

  // The stretch of a_axis for which points center + sum a_i e_i of the box may be nearer than `within_mm` to
  // what lies beyond the plane across `away`. The least distance to the plane at a given a_axis, over the
  // other a_i, is |away| - sum_(i != axis) |n . e_i| + a_axis n . e_axis, which must be below within_mm. All
  // of it is multiplied by |away|, which saves divisions.
  [[nodiscard]] NearStretch NearTo(const Vector3d& away, Eigen::Index axis, double within_mm) const {
    const double squared = away.squaredNorm();
    if (!(squared > 0.0)) return {-1.0, 1.0};
    const Vector3d climbs = edges_ * away;
    const double along = climbs[axis];
    const double room = within_mm * std::sqrt(squared) - squared + climbs.lpNorm<1>() - std::abs(along);
    if (room + std::abs(along) <= 0.0) return {};
    if (room >= std::abs(along)) return {-1.0, 1.0};
    return along > 0.0 ? NearStretch{-1.0, room / along} : NearStretch{room / along, 1.0};
  }

  void VisitNear(std::uint32_t index, Eigen::Index axis, double within_mm, NearStretch* stretch) {
    if (stretch->length() > longest_) return;
    const TriangleTree::Node& node = part_.nodes()[index];
    const Vector3d away = x_ - node.box.min().cwiseMax(x_.cwiseMin(node.box.max()));
    const NearStretch most = NearTo(away, axis, within_mm);
    if (most.is_empty() || (most.from >= stretch->from && most.to <= stretch->to)) return;
    const NearStretch by_disc = NearTo(FromDisc(node.disc), axis, within_mm);
    const NearStretch within{std::max(most.from, by_disc.from), std::min(most.to, by_disc.to)};
    if (within.is_empty()) return;
    const double longer = std::max(stretch->from - within.from, 0.0) + std::max(within.to - stretch->to, 0.0);
    if (longer <= 0.0) return;
    if (longer < longer_ || IsSmall(node)) {
      stretch->from = std::min(stretch->from, within.from);
      stretch->to = std::max(stretch->to, within.to);
      return;
    }
    if (node.left != 0) {
      VisitNear(node.left, axis, within_mm, stretch);
      VisitNear(node.left + 1, axis, within_mm, stretch);
      return;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const NearStretch near = NearTo(x_ - NearestOn(part_.order()[i]), axis, within_mm);
      if (near.is_empty()) continue;
      stretch->from = std::min(stretch->from, near.from);
      stretch->to = std::max(stretch->to, near.to);
    }
  }

  const TriangleTree& part_;
  const Vector3d x_;
  const Eigen::Matrix3d edges_;  // rows: the box's half edges
  NearestOnPart nearest_;
  double squared_ = std::numeric_limits<double>::infinity();  // of the distance found
  const double allowance_mm_;
  const double longer_;
  double longest_ = 2.0;                                       // a longer stretch is of no use
  double least_mm_ = std::numeric_limits<double>::infinity();  // of the triangles asked: the box's bound
};

}  // namespace

// Finds the region (of a corner, a side or the face) in which the point lies: Ericson, Real-Time Collision
// Detection, 5.1.5. Rounding makes the regions of needles unreliable. For them the result is the foot point
// on the plane if that is inside, else the nearest point of the three sides.
Vector3d NearestOnTriangle(const Vector3d& x, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
  const double d1 = ab.dot(ax), d2 = ac.dot(ax), d3 = ab.dot(bx), d4 = ac.dot(bx), d5 = ab.dot(cx),
               d6 = ac.dot(cx);
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  const double sum = va + vb + vc;  // the normal's square
  if (!(sum > kNeedle * ab.squaredNorm() * ac.squaredNorm())) return NearestOnNeedle(x, a, b, c);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  if (d3 >= 0.0 && d4 <= d3) return b;
  if (d6 >= 0.0 && d5 <= d6) return c;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb / sum) * ab + (vc / sum) * ac;
}

NearestOnPart FindNearest(const TriangleTree& part, const BoxInPart& box, std::uint32_t likely) {
  Search search(part, box);
  search.FindNearest(likely);
  NearestOnPart nearest = search.nearest();
  nearest.box_lower_mm = std::max(nearest.distance_mm - box.allowance_mm - box.half_edges.norm(), 0.0);
  if (nearest.box_lower_mm >= box.enough_mm || search.MostOfBox() < box.enough_mm) return nearest;
  search.BoundBox();
  return search.nearest();
}

NearStretch FindNearStretch(const TriangleTree& part, const BoxInPart& box, Eigen::Index axis,
                            double within_mm, std::uint32_t likely, double longest) {
  return Search(part, box).FindNearStretch(axis, within_mm, likely, longest);
}

}  // namespace elbowroom::core
