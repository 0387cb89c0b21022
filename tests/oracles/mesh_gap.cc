#include "tests/oracles/mesh_gap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/error.h"

namespace elbowroom::oracles {
namespace {

using LongMatrix = Eigen::Matrix<long double, 3, 3>;
using LongBox = Eigen::AlignedBox<long double, 3>;

void Offer(const LongVector& on_a, const LongVector& on_b, Gap& gap) {
  const long double distance_mm = (on_a - on_b).norm();
  if (distance_mm < gap.distance_mm) gap = {distance_mm, on_a, on_b};
}

// The point of the segment p..q nearest to x.
LongVector OnSegment(const LongVector& p, const LongVector& q, const LongVector& x) {
  const LongVector along = q - p;
  const long double square = along.squaredNorm();
  if (square == 0.0L) return p;
  return p + std::clamp((x - p).dot(along) / square, 0.0L, 1.0L) * along;
}

// Ends against the other segment, and the place where the lines are nearest if both reach it. Whatever
// rounding does to that place, points offered lie on the segments.
void OfferSegments(const LongVector& p, const LongVector& q, const LongVector& r, const LongVector& s,
                   Gap& gap) {
  for (const LongVector& end : {p, q}) Offer(end, OnSegment(r, s, end), gap);
  for (const LongVector& end : {r, s}) Offer(OnSegment(p, q, end), end, gap);
  const LongVector u = q - p, v = s - r, w = r - p;
  const long double denominator = u.squaredNorm() * v.squaredNorm() - u.dot(v) * u.dot(v);
  if (denominator <= 0.0L) return;
  const long double t = (u.dot(w) * v.squaredNorm() - u.dot(v) * v.dot(w)) / denominator;
  const LongVector on_first = p + std::clamp(t, 0.0L, 1.0L) * u;
  Offer(on_first, OnSegment(r, s, on_first), gap);
}

// Thinner than this part of its length a triangle has no face that its edges don't show as well.
constexpr long double kThinnest = 1e-16L;

bool IsThin(const LongTriangle& face, const LongVector& normal) {
  const long double square = std::max((face[1] - face[0]).squaredNorm(), (face[2] - face[0]).squaredNorm());
  return normal.norm() <= kThinnest * square;
}

// Where the plane of `face` meets the line through x along `direction`, if that is on the face.
bool MeetsFace(const LongTriangle& face, const LongVector& x, const LongVector& direction, LongVector& met) {
  const LongVector normal = (face[1] - face[0]).cross(face[2] - face[0]);
  const long double slope = normal.dot(direction);
  if (slope == 0.0L || IsThin(face, normal)) return false;
  met = x + normal.dot(face[0] - x) / slope * direction;
  for (int i = 0; i < 3; ++i) {
    const LongVector& corner = face[i];
    if (normal.dot((face[(i + 1) % 3] - corner).cross(met - corner)) < 0.0L) return false;
  }
  return true;
}

void OfferCornersAndFace(const LongTriangle& corners, const LongTriangle& face, bool swapped, Gap& gap) {
  const LongVector normal = (face[1] - face[0]).cross(face[2] - face[0]);
  LongVector met;
  for (int i = 0; i < 3; ++i) {
    const LongVector &corner = corners[i], edge = corners[(i + 1) % 3] - corner;
    if (MeetsFace(face, corner, normal, met)) swapped ? Offer(met, corner, gap) : Offer(corner, met, gap);
    const bool reaches = MeetsFace(face, corner, edge, met) && (met - corner).dot(edge) >= 0.0L &&
                         (met - corner).squaredNorm() <= edge.squaredNorm();
    if (reaches) Offer(met, met, gap);
  }
}

std::vector<LongTriangle> TrianglesOf(const core::TriangleMesh& mesh, const LongMatrix& rotation,
                                      const LongVector& offset_mm) {
  std::vector<LongTriangle> triangles;
  for (const auto& corners : mesh.triangles) {
    LongTriangle& triangle = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d& vertex = mesh.vertices_mm[static_cast<std::size_t>(corners[i])];
      triangle[i] = rotation * vertex.cast<long double>() + offset_mm;
    }
  }
  return triangles;
}

std::vector<LongBox> BoxesOf(const std::vector<LongTriangle>& triangles) {
  std::vector<LongBox> boxes;
  for (const LongTriangle& triangle : triangles) {
    LongBox& box = boxes.emplace_back();
    for (const LongVector& corner : triangle) box.extend(corner);
  }
  return boxes;
}

}  // namespace

Gap GapOfTriangles(const LongTriangle& a, const LongTriangle& b) {
  Gap gap;
  gap.distance_mm = std::numeric_limits<long double>::infinity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) OfferSegments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3], gap);
  }
  OfferCornersAndFace(a, b, false, gap);
  OfferCornersAndFace(b, a, true, gap);
  return gap;
}

Gap GapOfMeshes(const core::TriangleMesh& a, const core::RigidTransform& world_from_a,
                const core::TriangleMesh& b, const core::RigidTransform& world_from_b) {
  core::Require(!a.triangles.empty() && !b.triangles.empty(), "a gap is between two surfaces");
  const LongVector origin_mm = world_from_a.translation_mm.cast<long double>();
  const LongMatrix rotation_a = world_from_a.rotation.cast<long double>();
  const LongMatrix rotation_b = world_from_b.rotation.cast<long double>();
  const auto of_a = TrianglesOf(a, rotation_a, LongVector::Zero());
  const auto of_b = TrianglesOf(b, rotation_b, world_from_b.translation_mm.cast<long double>() - origin_mm);
  const auto boxes_a = BoxesOf(of_a), boxes_b = BoxesOf(of_b);
  LongBox around_b;
  for (const LongBox& box : boxes_b) around_b.extend(box);
  Gap least;
  least.distance_mm = std::numeric_limits<long double>::infinity();
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    if (boxes_a[i].squaredExteriorDistance(around_b) > least.distance_mm * least.distance_mm) continue;
    for (std::size_t j = 0; j < of_b.size(); ++j) {
      const long double square = least.distance_mm * least.distance_mm;
      if (boxes_a[i].squaredExteriorDistance(boxes_b[j]) > square) continue;
      const Gap gap = GapOfTriangles(of_a[i], of_b[j]);
      if (gap.distance_mm < least.distance_mm) least = gap;
    }
  }
  least.on_a += origin_mm;
  least.on_b += origin_mm;
  return least;
}

long double WindingNumber(const core::TriangleMesh& mesh, const LongVector& x_in_mesh) {
  long double angle = 0.0L;
  for (const LongTriangle& triangle : TrianglesOf(mesh, LongMatrix::Identity(), -x_in_mesh)) {
    const auto& [p, q, r] = triangle;
    const long double np = p.norm(), nq = q.norm(), nr = r.norm();
    const long double below = np * nq * nr + p.dot(q) * nr + q.dot(r) * np + r.dot(p) * nq;
    angle += 2.0L * std::atan2(p.dot(q.cross(r)), below);
  }
  return angle / (4.0L * std::numbers::pi_v<long double>);
}

bool HasVertexInside(const core::TriangleMesh& whole, const core::RigidTransform& world_from_whole,
                     const core::TriangleMesh& piece, const core::RigidTransform& world_from_piece) {
  if (!core::IsWatertight(whole)) return false;
  const Eigen::AlignedBox3d bounds = core::BoundsOf(whole);
  const core::RigidTransform whole_from_piece = world_from_whole.Inverse() * world_from_piece;
  return std::any_of(piece.vertices_mm.begin(), piece.vertices_mm.end(), [&](const Eigen::Vector3d& vertex) {
    const Eigen::Vector3d x_in_whole = whole_from_piece * vertex;
    return bounds.contains(x_in_whole) && WindingNumber(whole, x_in_whole.cast<long double>()) > 0.5L;
  });
}

}  // namespace elbowroom::oracles
