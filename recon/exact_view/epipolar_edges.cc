#include "recon/exact_view/epipolar_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "recon/hull/camera_query.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// A key is divided by the height of the view's centre over the plane of an edge. If the centre is in that
// plane, it is taken to be this share of the distances beside it.
constexpr double kLeastHeight = 1e-14;
// An epipole within this angle of the contour counts as on it: rounding would decide, edge by edge, on which
// side the rays start. The camera is then turned by kTurnRad, which is far less than a pixel.
constexpr double kOnContourRad = 1e-11;
constexpr double kTurnRad = 1e-10;
constexpr int kMostTurns = 8;

// b - a as the shorter way round, -2 to 2.
double Turn(double a, double b) {
  const double turn = b - a;
  return turn > 2.0 ? turn - 4.0 : turn < -2.0 ? turn + 4.0 : turn;
}

Vector3d Across(const Vector3d& axis, const Vector3d& toward) {
  const Vector3d across = toward - axis.dot(toward) * axis;
  return across.norm() > 1e-6 * toward.norm() ? Vector3d(across.normalized())
                                              : Vector3d(axis.unitOrthogonal());
}

}  // namespace

EpipolarEdges::EpipolarEdges(const ContourMap& labels, double focal_px, const core::CameraModel& camera,
                             const ViewRays& rays)
    : labels_(labels), focal_px_(focal_px), projection_(rays.projection()) {
  const core::RigidTransform view_from_cam = rays.view_from_world() * camera.cam_from_world().Inverse();
  cam_from_view_ = view_from_cam.rotation.transpose();
  centre_in_view_ = view_from_cam.translation_mm;
  const bool is_perspective = projection_ == Projection::kPerspective;
  is_concentric_ = is_perspective && centre_in_view_.isZero();
  if (is_concentric_) return;
  reach_ = is_perspective ? centre_in_view_.norm() : 1.0;
  // Where the rays come from: the view's centre, or infinitely far behind the picture.
  const Vector3d start_in_view = is_perspective ? Vector3d(-centre_in_view_) : Vector3d(0.0, 0.0, -1.0);
  TurnOffContour(start_in_view);
  cast_.starts_inside = LabelInCam(labels, focal_px, cam_from_view_ * start_in_view);
  ChooseAxes(rays.BoundsOf(0, 0, rays.width_px(), rays.height_px()));
  AddEdges(labels.contour(), cam_from_view_.transpose());
}

void EpipolarEdges::ChooseAxes(const Eigen::AlignedBox2d& view_box) {
  const Vector3d& c = centre_in_view_;
  const Eigen::Vector2d middle = view_box.center();
  const bool is_perspective = projection_ == Projection::kPerspective;
  const Vector3d axis = is_perspective ? Vector3d(c.normalized()) : Vector3d::UnitZ();
  const Vector3d toward = is_perspective ? Vector3d(middle.x(), middle.y(), 1.0)
                                         : Vector3d(middle.x() - c.x(), middle.y() - c.y(), 0.0);
  across_axes_[0] = Across(axis, toward);
  across_axes_[1] = axis.cross(across_axes_[0]);
  for (int i = 0; i < 2; ++i) {
    const Vector3d& a = across_axes_[i];
    across_[i] = {a.x(), a.y(), is_perspective ? a.z() : -a.dot(c)};
  }
  axis_uv_ = is_perspective ? Eigen::Vector2d(c.head<2>() / c.z()) : Eigen::Vector2d(c.head<2>());
  view_angles_ = AnglesOf(view_box);
  cast_.x = across_[0].Narrow();
  cast_.y = across_[1].Narrow();
}

void EpipolarEdges::TurnOffContour(const Vector3d& start_in_view) {
  const auto is_on_contour = [&] {
    const Vector3d x = cam_from_view_ * start_in_view;
    const Eigen::Vector2d epipole = x.head<2>() * (focal_px_ / x.z());
    if (!(x.z() > 0.0) || !epipole.allFinite()) return false;
    const double near_px = kOnContourRad * (focal_px_ + epipole.squaredNorm() / focal_px_);
    if (labels_.bounds_px().squaredExteriorDistance(epipole) > near_px * near_px) return false;
    const Contour& contour = labels_.contour();
    for (std::uint32_t i = 0; i < contour.edges.size(); ++i)
      if (DistanceToEdge(contour, i, epipole) <= near_px) return true;
    return false;
  };
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(kTurnRad, Vector3d(0.8, 0.53, 0.29).normalized()).toRotationMatrix();
  for (int i = 0; i < kMostTurns && is_on_contour(); ++i) cam_from_view_ = turn * cam_from_view_;
}

EpipolarEdges::AngleRange EpipolarEdges::AnglesOf(const Eigen::AlignedBox2d& uv_box) const {
  constexpr AngleRange kAll{-2.0, 2.0};
  // Around the axis itself, angles go all the way round.
  const Eigen::Vector2d slack = 1e-9 * (uv_box.min().cwiseAbs() + uv_box.max().cwiseAbs());
  const Eigen::AlignedBox2d grown(uv_box.min() - slack, uv_box.max() + slack);
  if (grown.contains(axis_uv_)) return kAll;
  AngleRange range{2.0, -2.0};
  for (int corner = 0; corner < 4; ++corner) {
    const Eigen::Vector2d uv((corner & 1) != 0 ? uv_box.max().x() : uv_box.min().x(),
                             (corner & 2) != 0 ? uv_box.max().y() : uv_box.min().y());
    const double angle = PencilAngle(across_[0].At(uv), across_[1].At(uv));
    if (std::isnan(angle)) return kAll;
    range = {std::min(range.least, angle), std::max(range.most, angle)};
  }
  // Corners on both sides of the negative x axis.
  if (range.most - range.least > 2.0) return kAll;
  return {range.least - kAngleSlack, range.most + kAngleSlack};
}

// The key at which rays meet the plane of the camera's centre and the edge from `from` along `along`, and the
// edge's order: the crossing's direction from the camera is order * axis + (x, y) across it.
EpipolarEdges::EdgePlane EpipolarEdges::PlaneAlong(const Vector3d& from, const Vector3d& along,
                                                   bool enters) const {
  const Vector3d normal = from.cross(along);
  const bool is_perspective = projection_ == Projection::kPerspective;
  const double rise = is_perspective ? normal.dot(centre_in_view_) : normal.z();
  const double sign = enters ? 1.0 : -1.0;
  const double least = kLeastHeight * reach_ * normal.lpNorm<1>() + std::numeric_limits<double>::min();
  const double per_height = -sign / std::max(sign * rise, least);
  const double at_origin = is_perspective ? normal.z() : -normal.dot(centre_in_view_);
  return {AffineForm{normal.x() * per_height, normal.y() * per_height, at_origin * per_height}.Narrow(),
          {normal.dot(across_axes_[0]) * per_height, normal.dot(across_axes_[1]) * per_height}};
}

void EpipolarEdges::AddEdges(const Contour& contour, const Eigen::Matrix3d& view_from_cam) {
  struct Vertex {
    Vector3d in_view;  // a direction
    double angle = 0.0;
  };
  std::vector<Vertex> vertices(contour.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector2d& at = contour.vertices[i];
    const Vector3d q = view_from_cam * Vector3d(at.x(), at.y(), focal_px_);
    const double angle = PencilAngle(across_axes_[0].dot(q), across_axes_[1].dot(q));
    vertices[i] = {q, std::isnan(angle) ? 0.0 : angle};
  }
  std::vector<EdgeOrder> orders;
  orders.reserve(contour.edges.size());
  cast_.edges.reserve(contour.edges.size());
  const auto is_seen = [this](float begin, float end) {
    return begin <= view_angles_.most && end >= view_angles_.least;
  };
  for (std::uint32_t i = 0; i < contour.edges.size(); ++i) {
    const ContourEdge& ends = contour.edges[i];
    const Vertex &from = vertices[ends.from], &to = vertices[ends.to];
    const double turn = Turn(from.angle, to.angle);
    if (turn == 0.0) continue;
    // The object is on the left of an edge. So rays enter it through an edge that runs with growing angle.
    const bool enters = turn > 0.0;
    const auto least = static_cast<float>(enters ? from.angle : to.angle);
    const auto most = static_cast<float>(enters ? to.angle : from.angle);
    if (least == most) continue;
    const bool goes_round = least > most;  // across the negative x axis
    if (!goes_round && !is_seen(least, most)) continue;
    const Eigen::Vector2d along = contour.vertices[ends.to] - contour.vertices[ends.from];
    const EdgePlane plane = PlaneAlong(from.in_view, view_from_cam.leftCols<2>() * along, enters);
    const auto add = [&](float begin, float end) {
      if (!is_seen(begin, end)) return;
      cast_.edges.push_back({begin, end, plane.key, i, enters});
      orders.push_back(plane.order);
    };
    if (!goes_round) {
      add(least, most);
    } else {
      add(least, std::numeric_limits<float>::infinity());
      add(-std::numeric_limits<float>::infinity(), most);
    }
  }
  const std::vector<OrderRange> ranges = FillIntervals(orders, &cast_);
  orders_ = ObjectRangeTable(cast_.intervals.begins, ranges);
}

bool EpipolarEdges::IsObjectAlong(const Eigen::Vector2d& uv) const {
  const Vector3d x_in_cam = cam_from_view_ * Vector3d(uv.x(), uv.y(), 1.0);
  const Eigen::Vector2d position = x_in_cam.head<2>() * (focal_px_ / x_in_cam.z());
  if (!(x_in_cam.z() > 0.0) || !position.allFinite()) return labels_.exterior_is_object();
  return labels_.IsObject(position);
}

// A ray whose direction across the axis is (x, y) is at order t at the key t * (|x| + |y|) - along. In a
// perspective view `along` is the component of (u, v, 1) along the axis, divided by the centre's distance.
// The box bounds both terms, and so the keys.
EpipolarEdges::KeyRange EpipolarEdges::ObjectKeys(const Eigen::AlignedBox2d& uv_box) const {
  constexpr double kRounding = 1e-9;
  if (is_concentric_) return {};
  const AngleRange angles = AnglesOf(uv_box);
  const OrderRange orders = orders_.Over(angles.least, angles.most);
  if (orders.first > orders.last) return kNoKeys;
  const bool is_perspective = projection_ == Projection::kPerspective;
  const Eigen::Vector2d middle = uv_box.center(), half = 0.5 * uv_box.sizes();
  const Vector3d axis = centre_in_view_ / centre_in_view_.squaredNorm();
  const double along = is_perspective ? axis.dot(middle.homogeneous()) : -centre_in_view_.z();
  const double along_half = is_perspective ? axis.head<2>().cwiseAbs().dot(half) : 0.0;
  double across = 0.0, across_half = 0.0;
  for (const AffineForm& form : across_) {
    across += std::abs(form.At(middle));
    across_half += std::abs(form.du) * half.x() + std::abs(form.dv) * half.y();
  }
  const double nearest = std::max(across - across_half, 0.0), farthest = across + across_half;
  const double slack = along_half + kRounding * std::abs(along);
  const auto key = [&](double order, double sign) {
    if (std::isinf(order)) return order;
    const double at_nearest = order * nearest, at_farthest = order * farthest;
    const double extreme = sign < 0.0 ? std::min(at_nearest, at_farthest) : std::max(at_nearest, at_farthest);
    return extreme - along + sign * (slack + kRounding * std::abs(extreme));
  };
  return {key(orders.first, -1.0), key(orders.last, 1.0)};
}

}  // namespace elbowroom::recon
