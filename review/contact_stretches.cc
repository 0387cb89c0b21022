#include "review/contact_stretches.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kStretchesInLeaf = 2;
// Balls grow by this share, so that rounding never leaves a corner outside.
constexpr double kOutwards = 1e-12;

// Calls visit(point, radius_mm) for balls that together enclose the stretch's convex hull.
template <typename Visit>
void VisitBalls(const ContactStretch& stretch, const Visit& visit) {
  if (stretch.node) return visit(stretch.ball.center, stretch.ball.radius_mm);
  for (const Vector3d& corner : {stretch.corners.a, stretch.corners.b, stretch.corners.c}) visit(corner, 0.0);
}

}  // namespace

std::unique_ptr<const ContactStretches> ContactStretches::Make(const core::TriangleTree& part,
                                                               double point_spacing_mm) {
  std::unique_ptr<ContactStretches> made(new ContactStretches(part, point_spacing_mm));
  if (part.nodes().empty() || !made->CutNode(0)) return nullptr;
  const auto count = static_cast<std::uint32_t>(made->stretches_.size());
  made->places_.resize(count);
  std::iota(made->places_.begin(), made->places_.end(), 0U);
  made->nodes_.push_back({{}, {}, 0, count, 0, 0});
  made->Build(0);
  std::vector<ContactStretch> in_tree;
  in_tree.reserve(count);
  for (const std::uint32_t place : made->places_) in_tree.push_back(made->stretches_[place]);
  made->stretches_ = std::move(in_tree);
  return made;
}

bool ContactStretches::Add(const ContactStretch& stretch, std::uint32_t triangles) {
  if (stretches_.size() == kMost) return false;
  stretches_.push_back(stretch);
  triangles_.push_back(triangles);
  return true;
}

bool ContactStretches::CutNode(std::uint32_t index) {
  const core::TriangleTree::Node& node = part_.nodes()[index];
  if (2.0 * node.ball.radius_mm <= point_spacing_mm_)
    return Add({{}, node.ball, index}, node.end - node.begin);
  if (node.left != 0) return CutNode(node.left) && CutNode(node.left + 1);
  const core::TriangleMesh& mesh = part_.mesh();
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    const auto& [a, b, c] = mesh.triangles[part_.order()[i]];
    const auto vertex = [&](std::int32_t at) { return mesh.vertices_mm[static_cast<std::size_t>(at)]; };
    const std::size_t first = stretches_.size();
    if (!CutTriangle({vertex(a), vertex(b), vertex(c)})) return false;
    triangles_[first] = 1;
  }
  return true;
}

bool ContactStretches::CutTriangle(const Corners& triangle) {
  const core::Ball ball = core::BallOf(triangle.a, triangle.b, triangle.c);
  if (2.0 * ball.radius_mm <= point_spacing_mm_) return Add({triangle, ball, {}}, 0);
  const auto halves = Bisect(triangle);
  return CutTriangle(halves.first) && CutTriangle(halves.second);
}

// Until the tree stands, stretches_ and triangles_ are by place, and places_ is the tree's order.
void ContactStretches::Build(std::uint32_t index) {
  const std::uint32_t begin = nodes_[index].begin, end = nodes_[index].end;
  const std::span<std::uint32_t> places(places_.data() + begin, end - begin);
  Node& node = nodes_[index];
  Eigen::AlignedBox3d centers;
  for (const std::uint32_t place : places) {
    VisitBalls(stretches_[place], [&](const Vector3d& x, double radius_mm) {
      const Vector3d reach = Vector3d::Constant(radius_mm);
      node.box.extend(Eigen::AlignedBox3d(x - reach, x + reach));
    });
    centers.extend(stretches_[place].ball.center);
    node.triangles += triangles_[place];
  }
  node.ball.center = node.box.center();
  for (const std::uint32_t place : places)
    VisitBalls(stretches_[place], [&](const Vector3d& x, double radius_mm) {
      node.ball.radius_mm = std::max(node.ball.radius_mm, (x - node.ball.center).norm() + radius_mm);
    });
  node.ball.radius_mm *= 1.0 + kOutwards;
  if (end - begin <= kStretchesInLeaf) return;
  Eigen::Index axis = 0;
  centers.sizes().maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(
      places.begin(), places.begin() + (middle - begin), places.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double at_a = stretches_[a].ball.center[axis], at_b = stretches_[b].ball.center[axis];
        return at_a != at_b ? at_a < at_b : a < b;
      });
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  node.left = left;
  nodes_.push_back({{}, {}, begin, middle, 0, 0});  // `node` isn't valid any more
  nodes_.push_back({{}, {}, middle, end, 0, 0});
  Build(left);
  Build(left + 1);
}

}  // namespace elbowroom::review
