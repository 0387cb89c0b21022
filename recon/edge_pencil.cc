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
// An epipole within this angle of the contour is on it: rounding would decide, edge by edge, on which side
// the rays start. The camera is turned then, by an angle that is nothing to a pixel.
constexpr double kOnContourRad = 1e-11;
constexpr double kTurnRad = 1e-10;
constexpr int kMostTurns = 8;

// Grows with the angle from the x axis, 0 to 4 for a turn. NaN at the origin.
double PseudoAngle(double x, double y) {
  const double share = y / (std::abs(x) + std::abs(y));
  if (x < 0.0) return 2.0 - share;
  return share < 0.0 ? 4.0 + share : share;
}

// b - a as the shorter way round, -2 to 2.
double Turn(double a, double b) {
  const double turn = b - a;
  return turn > 2.0 ? turn - 4.0 : turn < -2.0 ? turn + 4.0 : turn;
}

constexpr EdgePencil::BinRange kAllBins{0, EdgePencil::kBins};

// The bins from `start` on along `turn` >= 0, and one more on both sides for the rounding.
EdgePencil::BinRange BinsAlong(double start, double turn) {
  constexpr double kPerUnit = EdgePencil::kBins / 4.0;
  // Written so that a NaN takes all bins.
  if (!(turn < 1.9)) return kAllBins;
  const int first = static_cast<int>(std::floor(start * kPerUnit)) - 1;
  const int last = static_cast<int>(std::floor((start + turn) * kPerUnit)) + 1;
  constexpr int kCount = EdgePencil::kBins;
  return {static_cast<std::uint32_t>((first + 2 * kCount) % kCount),
          static_cast<std::uint32_t>(last - first + 1)};
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
  TurnOffContour(start_in_view);
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
  MakeEdges(labels.contour(), cam_from_view_.transpose());
  SortIntoBins(labels.contour(), cam_from_view_.transpose());
}

void EdgePencil::TurnOffContour(const Vector3d& start_in_view) {
  const auto is_on_contour = [&] {
    const Vector3d x = cam_from_view_ * start_in_view;
    const Eigen::Vector2d epipole = x.head<2>() * (focal_px_ / x.z());
    if (!(x.z() > 0.0) || !epipole.allFinite()) return false;
    const double near_px = kOnContourRad * (focal_px_ + epipole.squaredNorm() / focal_px_);
    const Contour& contour = labels_.contour();
    for (std::uint32_t i = 0; i < contour.edges.size(); ++i)
      if (DistanceToEdge(contour, i, epipole) <= near_px) return true;
    return false;
  };
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(kTurnRad, Vector3d(0.8, 0.53, 0.29).normalized()).toRotationMatrix();
  for (int i = 0; i < kMostTurns && is_on_contour(); ++i) cam_from_view_ = turn * cam_from_view_;
}

void EdgePencil::MakeEdges(const Contour& contour, const Eigen::Matrix3d& view_from_cam) {
  const Vector3d& c = centre_in_view_;
  const bool is_perspective = projection_ == Projection::kPerspective;
  std::vector<AffineForm> sides(contour.vertices.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Vector3d q = InView(view_from_cam, contour.vertices[i]);
    if (is_perspective) {
      const Vector3d side = c.cross(q);  // det(d, c, q) with d = (u, v, 1)
      sides[i] = {side.x(), side.y(), side.z()};
    } else {
      // det(z, c - o, q) with o = (u, v, 0)
      sides[i] = {-q.y(), q.x(), c.x() * q.y() - c.y() * q.x()};
    }
  }
  edges_.resize(contour.edges.size());
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const ContourEdge& ends = contour.edges[i];
    const Eigen::Vector2d along = contour.vertices[ends.to] - contour.vertices[ends.from];
    const Vector3d q = InView(view_from_cam, contour.vertices[ends.from]);
    const Vector3d normal = q.cross(view_from_cam.leftCols<2>() * along);
    PencilEdge& edge = edges_[i];
    edge.from = sides[ends.from], edge.to = sides[ends.to];
    if (is_perspective) {
      const double height = AwayFromZero(
          normal.dot(c), kLeastHeight * normal.norm() * c.norm() + std::numeric_limits<double>::min());
      edge.key = {-normal.x() / height, -normal.y() / height, -normal.z() / height};
      edge.enters = height > 0.0;
    } else {
      const double rise =
          AwayFromZero(normal.z(), kLeastHeight * normal.norm() + std::numeric_limits<double>::min());
      edge.key = {-normal.x() / rise, -normal.y() / rise, normal.dot(c) / rise};
      edge.enters = rise > 0.0;
    }
  }
}

void EdgePencil::SortIntoBins(const Contour& contour, const Eigen::Matrix3d& view_from_cam) {
  std::vector<double> angles(contour.vertices.size());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const Vector3d q = InView(view_from_cam, contour.vertices[i]);
    angles[i] = PseudoAngle(across_axes_[0].dot(q), across_axes_[1].dot(q));
  }
  std::vector<BinRange> ranges(contour.edges.size());
  first_.assign(kBins + 1, 0);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double from = angles[contour.edges[i].from], to = angles[contour.edges[i].to];
    const double turn = Turn(from, to);
    ranges[i] = BinsAlong(turn < 0.0 ? to : from, std::abs(turn));
    for (std::uint32_t k = 0; k < ranges[i].count; ++k) ++first_[(ranges[i].first + k) % kBins + 1];
  }
  for (std::uint32_t bin = 0; bin < kBins; ++bin) first_[bin + 1] += first_[bin];
  entries_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < ranges.size(); ++i) {
    for (std::uint32_t k = 0; k < ranges[i].count; ++k)
      entries_[next[(ranges[i].first + k) % kBins]++] = {i & 0x7FFFFFFFU, k == 0 ? 1U : 0U};
  }
}

bool EdgePencil::IsObjectAlong(const Eigen::Vector2d& uv) const {
  const Vector3d x_in_cam = cam_from_view_ * Vector3d(uv.x(), uv.y(), 1.0);
  const Eigen::Vector2d position = x_in_cam.head<2>() * (focal_px_ / x_in_cam.z());
  if (!(x_in_cam.z() > 0.0) || !position.allFinite()) return labels_.exterior_is_object();
  return labels_.IsObject(position);
}

EdgePencil::BinRange EdgePencil::BinsOf(const Eigen::AlignedBox2d& uv_box) const {
  // Angles on both sides of the axis itself go all the way round.
  const Eigen::Vector2d slack = 1e-9 * (uv_box.sizes() + uv_box.min().cwiseAbs() + uv_box.max().cwiseAbs());
  const Eigen::AlignedBox2d grown(uv_box.min() - slack, uv_box.max() + slack);
  if (axis_uv_.allFinite() && grown.contains(axis_uv_)) return kAllBins;
  double start = 0.0, least = 0.0, most = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    const Eigen::Vector2d uv((corner & 1) != 0 ? uv_box.max().x() : uv_box.min().x(),
                             (corner & 2) != 0 ? uv_box.max().y() : uv_box.min().y());
    const double angle = PseudoAngle(across_[0].At(uv), across_[1].At(uv));
    if (corner == 0) start = angle;
    const double turn = Turn(start, angle);
    if (std::isnan(turn)) return kAllBins;
    least = std::min(least, turn), most = std::max(most, turn);
  }
  double first = start + least;
  if (first < 0.0) first += 4.0;
  return BinsAlong(first, most - least);
}

bool EdgePencil::HasEdges(const BinRange& range) const {
  if (first_.empty()) return false;
  const std::uint32_t end = range.first + range.count;
  if (range.count >= kBins) return first_.back() > 0;
  if (end <= kBins) return first_[end] > first_[range.first];
  return first_[kBins] > first_[range.first] || first_[end - kBins] > 0;
}

}  // namespace elbowroom::recon
