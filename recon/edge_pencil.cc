#include "recon/edge_pencil.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "recon/camera_query.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// A view centre in the plane of an edge meets it at the start of its rays: as near as this share of the
// distances it is taken to be beside it.
constexpr double kLeastHeight = 1e-14;

// Grows with the angle from the x axis, -2 to 2 for a turn. NaN at the origin.
double PseudoAngle(double x, double y) { return std::copysign(1.0 - x / (std::abs(x) + std::abs(y)), y); }

// b - a as the shorter way round, -2 to 2.
double Turn(double a, double b) {
  const double turn = b - a;
  return turn > 2.0 ? turn - 4.0 : turn < -2.0 ? turn + 4.0 : turn;
}

// Float32 sides may put a ray on the other side of an end that is nearer than this to its plane, in bins.
constexpr double kBinSlack = 1e-2;
constexpr EdgePencil::BinRange kAllBins{0, EdgePencil::kBins};

// The bins from `start` on along `turn` >= 0, with room for the rounding of angles.
EdgePencil::BinRange BinsAlong(double start, double turn) {
  constexpr double kPerUnit = EdgePencil::kBins / 4.0;
  // Written so that a NaN takes all bins.
  if (!(turn < 1.9)) return kAllBins;
  // Angles from -4 on, so that truncation is rounding down.
  const int first = static_cast<int>((start + 4.0) * kPerUnit - kBinSlack);
  const int last = static_cast<int>((start + 4.0 + turn) * kPerUnit + kBinSlack);
  constexpr int kCount = EdgePencil::kBins;
  return {static_cast<std::uint32_t>(first % kCount), static_cast<std::uint32_t>(last - first + 1)};
}

CastForm Narrow(const AffineForm& form) {
  return {static_cast<float>(form.du), static_cast<float>(form.dv), static_cast<float>(form.at_origin)};
}

double AwayFromZero(double height, double least) {
  if (std::abs(height) >= least) return height;
  return std::signbit(height) ? -least : least;
}

}  // namespace

EdgePencil::EdgePencil(const ContourMap& labels, double focal_px, const core::CameraModel& camera,
                       const ViewRays& rays)
    : labels_(labels), focal_px_(focal_px), projection_(rays.projection()) {
  const core::RigidTransform view_from_cam = rays.view_from_world() * camera.cam_from_world().Inverse();
  cam_from_view_ = view_from_cam.rotation.transpose();
  centre_in_view_ = view_from_cam.translation_mm;
  const bool is_perspective = projection_ == Projection::kPerspective;
  is_concentric_ = is_perspective && centre_in_view_.isZero();
  if (is_concentric_) return;
  // Where the rays come from: the view's centre, or infinitely far behind the picture.
  const Vector3d start_in_view = is_perspective ? Vector3d(-centre_in_view_) : Vector3d(0.0, 0.0, -1.0);
  starts_inside_ = LabelInCam(labels, focal_px, cam_from_view_ * start_in_view);
  const Vector3d axis = is_perspective ? centre_in_view_.normalized() : Vector3d::UnitZ();
  across_axes_[0] = axis.unitOrthogonal();
  across_axes_[1] = axis.cross(across_axes_[0]);
  for (int i = 0; i < 2; ++i) {
    const Vector3d& a = across_axes_[i];
    across_[i] = {a.x(), a.y(), is_perspective ? a.z() : -a.dot(centre_in_view_)};
  }
  axis_uv_ = is_perspective ? Eigen::Vector2d(centre_in_view_.head<2>() / centre_in_view_.z())
                            : Eigen::Vector2d(centre_in_view_.head<2>());
  SortEdges(labels.contour(), view_from_cam.rotation);
}

// Works out where rays meet the plane of an edge from `from` along `along`; returns whether they enter there.
bool EdgePencil::MakeEdge(const Vector3d& from, const Vector3d& along, CastForm* key) const {
  const Vector3d normal = from.cross(along);
  const double least = kLeastHeight * normal.norm() + std::numeric_limits<double>::min();
  if (projection_ == Projection::kPerspective) {
    const double height = AwayFromZero(normal.dot(centre_in_view_), least * centre_in_view_.norm());
    *key = Narrow({-normal.x() / height, -normal.y() / height, -normal.z() / height});
    return height > 0.0;
  }
  const double rise = AwayFromZero(normal.z(), least);
  *key = Narrow({-normal.x() / rise, -normal.y() / rise, normal.dot(centre_in_view_) / rise});
  return rise > 0.0;
}

void EdgePencil::SortEdges(const Contour& contour, const Eigen::Matrix3d& view_from_cam) {
  struct Vertex {
    Vector3d in_view;  // a direction
    CastForm side;
    double angle;
  };
  const Vector3d& c = centre_in_view_;
  const bool is_perspective = projection_ == Projection::kPerspective;
  std::vector<Vertex> vertices(contour.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector2d& at = contour.vertices[i];
    const Vector3d q = view_from_cam * Vector3d(at.x(), at.y(), focal_px_);
    // det(d, c, q) with d = (u, v, 1); det(z, c - o, q) with o = (u, v, 0).
    const Vector3d side =
        is_perspective ? Vector3d(c.cross(q)) : Vector3d(-q.y(), q.x(), c.x() * q.y() - c.y() * q.x());
    vertices[i] = {q, Narrow({side.x(), side.y(), side.z()}),
                   PseudoAngle(across_axes_[0].dot(q), across_axes_[1].dot(q))};
  }
  std::vector<UnsortedEdge> entries, exits;
  entries.reserve(contour.edges.size()), exits.reserve(contour.edges.size());
  for (std::uint32_t i = 0; i < contour.edges.size(); ++i) {
    const ContourEdge& ends = contour.edges[i];
    const Vertex &from = vertices[ends.from], &to = vertices[ends.to];
    const Eigen::Vector2d along = contour.vertices[ends.to] - contour.vertices[ends.from];
    const double turn = Turn(from.angle, to.angle);
    UnsortedEdge edge{{from.side, to.side, {}, i},
                      BinsAlong(turn < 0.0 ? to.angle : from.angle, std::abs(turn))};
    const bool enters = MakeEdge(from.in_view, view_from_cam.leftCols<2>() * along, &edge.edge.key);
    (enters ? entries : exits).push_back(edge);
  }
  entries_ = Sorted(entries);
  exits_ = Sorted(exits);
}

EdgePencil::SortedEdges EdgePencil::Sorted(const std::vector<UnsortedEdge>& edges) {
  SortedEdges sorted;
  sorted.first.assign(kBins + 1, 0);
  sorted.first_carried.assign(kBins + 1, 0);
  for (const UnsortedEdge& edge : edges) {
    ++sorted.first[edge.bins.first + 1];
    for (std::uint32_t k = 1; k < edge.bins.count; ++k)
      ++sorted.first_carried[(edge.bins.first + k) % kBins + 1];
  }
  for (std::uint32_t bin = 0; bin < kBins; ++bin) {
    sorted.first[bin + 1] += sorted.first[bin];
    sorted.first_carried[bin + 1] += sorted.first_carried[bin];
  }
  sorted.edges.resize(edges.size());
  sorted.carried.resize(sorted.first_carried.back());
  std::vector<std::uint32_t> next(sorted.first.begin(), sorted.first.end() - 1);
  std::vector<std::uint32_t> next_carried(sorted.first_carried.begin(), sorted.first_carried.end() - 1);
  for (const UnsortedEdge& edge : edges) {
    const std::uint32_t number = next[edge.bins.first]++;
    sorted.edges[number] = edge.edge;
    for (std::uint32_t k = 1; k < edge.bins.count; ++k)
      sorted.carried[next_carried[(edge.bins.first + k) % kBins]++] = number;
  }
  return sorted;
}

// Those that begin in the bins, and those carried into the first of them.
CastEdges EdgePencil::SortedEdges::In(const BinRange& range) const {
  CastEdges found;
  if (edges.empty()) return found;
  found.all = edges.data();
  if (range.count >= kBins) {
    found.runs[0] = edges;
    return found;
  }
  const std::uint32_t end = range.first + range.count;
  const std::span<const CastEdge> all(edges);
  found.runs[0] = all.subspan(first[range.first], first[std::min(end, kBins)] - first[range.first]);
  if (end > kBins) found.runs[1] = all.first(first[end - kBins]);
  found.singles = std::span<const std::uint32_t>(carried).subspan(
      first_carried[range.first], first_carried[range.first + 1] - first_carried[range.first]);
  return found;
}

bool EdgePencil::IsObjectAlong(const Eigen::Vector2d& uv) const {
  const Vector3d x_in_cam = cam_from_view_ * Vector3d(uv.x(), uv.y(), 1.0);
  const Eigen::Vector2d position = x_in_cam.head<2>() * (focal_px_ / x_in_cam.z());
  if (!(x_in_cam.z() > 0.0) || !position.allFinite()) return labels_.exterior_is_object();
  return labels_.IsObject(position);
}

EdgePencil::BinRange EdgePencil::BinsOf(const Eigen::AlignedBox2d& uv_box) const {
  // Angles on both sides of the axis itself go all the way round.
  const Eigen::Vector2d slack = 1e-9 * (uv_box.min().cwiseAbs() + uv_box.max().cwiseAbs());
  const Eigen::AlignedBox2d grown(uv_box.min() - slack, uv_box.max() + slack);
  if (grown.contains(axis_uv_)) return kAllBins;
  // The four corners at once.
  const Eigen::Array4d u(uv_box.min().x(), uv_box.max().x(), uv_box.min().x(), uv_box.max().x());
  const Eigen::Array4d v(uv_box.min().y(), uv_box.min().y(), uv_box.max().y(), uv_box.max().y());
  const Eigen::Array4d x = u * across_[0].du + v * across_[0].dv + across_[0].at_origin;
  const Eigen::Array4d y = u * across_[1].du + v * across_[1].dv + across_[1].at_origin;
  const Eigen::Array4d turned = 1.0 - x / (x.abs() + y.abs());  // PseudoAngle, but for the sign
  double least = 0.0, most = 0.0, start = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    const double angle = std::copysign(turned[corner], y[corner]);
    if (corner == 0) start = angle;
    const double turn = Turn(start, angle);
    if (std::isnan(turn)) return kAllBins;
    least = std::min(least, turn), most = std::max(most, turn);
  }
  return BinsAlong(start + least, most - least);
}

}  // namespace elbowroom::recon
