#include "review/triangle_gap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

// The normal of a triangle that is thinner than this share of its longest side is too inexact to use. Its
// edges alone give its distances to that share of its size.
constexpr double kThinnest = 1e-11;

// A triangle with its edges and its normal.
struct Face {
  explicit Face(const Triangle& triangle) : corners(triangle) {
    double square = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      edges[i] = corners[(i + 1) % 3] - corners[i];
      square = std::max(square, edges[i].squaredNorm());
    }
    normal = edges[0].cross(edges[1]);
    has_face = normal.norm() > kThinnest * square;
  }

  // Whether a point of the triangle's plane is inside the triangle.
  [[nodiscard]] bool Covers(const Vector3d& x) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (normal.dot(edges[i].cross(x - corners[i])) < 0.0) return false;
    }
    return true;
  }

  const Triangle& corners;
  std::array<Vector3d, 3> edges;
  Vector3d normal;
  bool has_face = false;
};

// Keeps the nearest pair of points that it is offered.
class NearestPair {
 public:
  void Offer(const Vector3d& on_a, const Vector3d& on_b) {
    const double square = (on_a - on_b).squaredNorm();
    if (square >= square_) return;
    square_ = square;
    on_a_ = on_a;
    on_b_ = on_b;
  }

  [[nodiscard]] SurfaceGap Gap() const { return {std::sqrt(square_), on_a_, on_b_}; }

 private:
  double square_ = std::numeric_limits<double>::infinity();
  Vector3d on_a_ = Vector3d::Zero();
  Vector3d on_b_ = Vector3d::Zero();
};

Vector3d NearestOnSegment(const Vector3d& from, const Vector3d& edge, const Vector3d& x) {
  const double square = edge.squaredNorm();
  if (square == 0.0) return from;
  return from + std::clamp((x - from).dot(edge) / square, 0.0, 1.0) * edge;
}

// Offers the nearest points of the two edges' lines if both lie between the edges' ends. The cross product
// tells angles of 1e-15 from none, which a determinant of dot products does only to 1e-8. For parallel edges,
// an end of one is among the nearest points, and OfferCorners offers those.
void OfferPassing(const Vector3d& p, const Vector3d& u, const Vector3d& q, const Vector3d& v,
                  NearestPair& nearest) {
  const Vector3d across = u.cross(v), between = q - p;
  const double square = across.squaredNorm();
  if (square == 0.0) return;
  const double s = between.cross(v).dot(across) / square, t = between.cross(u).dot(across) / square;
  if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) nearest.Offer(p + s * u, q + t * v);
}

// Offers each corner of `one` with its nearest points on the edges and the face of `other`, and the points
// where edges of `one` cross that face. `offer(x, y)`: x of `one`, y of `other`.
template <typename Offer>
void OfferCorners(const Face& one, const Face& other, const Offer& offer) {
  std::array<double, 3> heights{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& corner = one.corners[i];
    for (std::size_t j = 0; j < 3; ++j) {
      offer(corner, NearestOnSegment(other.corners[j], other.edges[j], corner));
    }
    if (!other.has_face) continue;
    heights[i] = other.normal.dot(corner - other.corners[0]);
    const Vector3d foot = corner - heights[i] / other.normal.squaredNorm() * other.normal;
    if (other.Covers(foot)) offer(corner, foot);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double from = heights[i], to = heights[(i + 1) % 3];
    if (!((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0))) continue;
    const Vector3d crossing = one.corners[i] + from / (from - to) * one.edges[i];
    if (other.Covers(crossing)) offer(crossing, crossing);
  }
}

}  // namespace

// The least distance is attained between two edges, at a corner of one triangle, or where an edge of one
// crosses the face of the other. All these pairs of points are offered.
SurfaceGap GapBetween(const Triangle& a, const Triangle& b) {
  const Face face_a(a), face_b(b);
  NearestPair nearest;
  OfferCorners(face_a, face_b,
               [&](const Vector3d& on_a, const Vector3d& on_b) { nearest.Offer(on_a, on_b); });
  OfferCorners(face_b, face_a,
               [&](const Vector3d& on_b, const Vector3d& on_a) { nearest.Offer(on_a, on_b); });
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      OfferPassing(a[i], face_a.edges[i], b[j], face_b.edges[j], nearest);
    }
  }
  return nearest.Gap();
}

}  // namespace elbowroom::review
