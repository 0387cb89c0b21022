#include "recon/gauge/rod_search.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// How far from the true diameter a rod is still looked for.
constexpr double kLeastShare = 0.5, kMostShare = 2.0;
constexpr std::size_t kMostStrips = 16;  // of a camera: the longest

// A strip in space: the planes through the camera's centre that it spans.
struct Wedge {
  Strip strip;
  Vector3d middle_normal;  // of the plane halfway between both edges: the axis is in it
  Vector3d inward[2];      // of the edges' planes, unit, in world
};

Vector3d InwardNormal(const RodView& view, const StraightRun& run) {
  const double focal_px = view.plane->focal_px();
  const Vector2d end = run.middle + run.along;
  const Vector3d in_cam =
      Vector3d(run.middle.x(), run.middle.y(), focal_px).cross(Vector3d(end.x(), end.y(), focal_px));
  return (view.camera().cam_from_world().rotation.transpose() * in_cam).normalized();
}

Wedge WedgeOf(const RodView& view, const Strip& strip) {
  const Vector3d one = InwardNormal(view, strip.first), other = InwardNormal(view, strip.second);
  return {strip, (one - other).normalized(), {one, other}};
}

// The range of a rod's widths in a picture, over the workspace.
std::pair<double, double> WidthsIn(const RodView& view, const Eigen::AlignedBox3d& workspace_mm,
                                   double diameter_mm) {
  double nearest_mm = std::numeric_limits<double>::infinity(), farthest_mm = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
    const double distance_mm = (workspace_mm.corner(type) - view.camera().center_in_world()).norm();
    farthest_mm = std::max(farthest_mm, distance_mm);
  }
  nearest_mm = std::max(workspace_mm.exteriorDistance(view.camera().center_in_world()), 2.0 * diameter_mm);
  const double scale = view.plane->focal_px() * diameter_mm;
  // The picture's corners are farther from the camera than their depth: twice for a very wide lens.
  return {kLeastShare * scale / farthest_mm, 2.0 * kMostShare * scale / nearest_mm};
}

std::optional<Cylinder> Meet(const RodView& a, const Wedge& wedge_a, const RodView& b, const Wedge& wedge_b,
                             const Vector3d& near) {
  constexpr double kLeastSine = 0.02;  // between the two planes
  const Vector3d axis = wedge_a.middle_normal.cross(wedge_b.middle_normal);
  if (axis.norm() < kLeastSine) return std::nullopt;
  Eigen::Matrix3d planes;
  planes << wedge_a.middle_normal.transpose(), wedge_b.middle_normal.transpose(),
      axis.normalized().transpose();
  const Vector3d right(wedge_a.middle_normal.dot(a.camera().center_in_world()),
                       wedge_b.middle_normal.dot(b.camera().center_in_world()), axis.normalized().dot(near));
  return Cylinder{planes.inverse() * right, axis.normalized(), 0.0};
}

struct Stretch {
  double from_mm = 0.0;
  double to_mm = 0.0;
  [[nodiscard]] double length() const { return to_mm - from_mm; }
};

Stretch StretchOf(const Cylinder& cylinder, const RodView& view, const Strip& strip) {
  const double one = AlongAxis(cylinder, view, strip.middle + strip.from * strip.along);
  const double other = AlongAxis(cylinder, view, strip.middle + strip.to * strip.along);
  return {std::min(one, other), std::max(one, other)};
}

Stretch Common(const Stretch& a, const Stretch& b) {
  return {std::max(a.from_mm, b.from_mm), std::min(a.to_mm, b.to_mm)};
}

double RadiusIn(const Cylinder& cylinder, const RodView& view, const Wedge& wedge, double along_mm) {
  const Vector3d to_axis =
      cylinder.point_in_world + along_mm * cylinder.axis_in_world - view.camera().center_in_world();
  return 0.5 * (wedge.inward[0] + wedge.inward[1]).dot(to_axis);
}

bool IsOfDiameter(double radius_mm, double diameter_mm) {
  return radius_mm >= 0.5 * kLeastShare * diameter_mm && radius_mm <= 0.5 * kMostShare * diameter_mm;
}

// How a strip lies to the axis, over what both have in common.
struct Fit {
  double offset_mm = 0.0;  // the larger of both ends'
  double length_mm = 0.0;
  double tilt = 0.0;  // mm per mm
};

std::optional<Fit> FitOf(const Cylinder& cylinder, const Stretch& stretch, const RodView& view,
                         const Wedge& wedge, double diameter_mm) {
  const Stretch common = Common(stretch, StretchOf(cylinder, view, wedge.strip));
  if (!(common.length() > diameter_mm)) return std::nullopt;
  const auto offset_at = [&](double along_mm) {
    return wedge.middle_normal.dot(cylinder.point_in_world + along_mm * cylinder.axis_in_world -
                                   view.camera().center_in_world());
  };
  if (!IsOfDiameter(RadiusIn(cylinder, view, wedge, 0.5 * (common.from_mm + common.to_mm)), diameter_mm))
    return std::nullopt;
  const double from_mm = offset_at(common.from_mm), to_mm = offset_at(common.to_mm);
  return Fit{std::max(std::abs(from_mm), std::abs(to_mm)), common.length(),
             std::abs(to_mm - from_mm) / common.length()};
}

class Search {
 public:
  Search(std::span<const RodView> views, const Eigen::AlignedBox3d& workspace_mm, double diameter_mm)
      : views_(views), workspace_mm_(workspace_mm), diameter_mm_(diameter_mm) {
    for (const RodView& view : views) {
      const auto [least, most] = WidthsIn(view, workspace_mm, diameter_mm);
      std::vector<Strip> strips = FindStrips(view, least, most);
      if (strips.size() > kMostStrips) strips.resize(kMostStrips);
      wedges_.emplace_back();
      for (const Strip& strip : strips) wedges_.back().push_back(WedgeOf(view, strip));
    }
  }

  RodSearch Run() {
    for (std::size_t a = 0; a < views_.size(); ++a)
      for (std::size_t b = a + 1; b < views_.size(); ++b)
        for (const Wedge& one : wedges_[a])
          for (const Wedge& other : wedges_[b]) Try(a, one, b, other);
    if (!best_) return {std::nullopt, Reason()};
    return {Assemble()};
  }

 private:
  struct Candidate {
    Cylinder cylinder;
    Stretch stretch;
    double score_mm = 0.0;
  };

  void Try(std::size_t a, const Wedge& one, std::size_t b, const Wedge& other) {
    const auto cylinder = Meet(views_[a], one, views_[b], other, workspace_mm_.center());
    if (!cylinder) return;
    const Stretch stretch =
        Common(StretchOf(*cylinder, views_[a], one.strip), StretchOf(*cylinder, views_[b], other.strip));
    if (!(stretch.length() > diameter_mm_)) return;
    const double middle_mm = 0.5 * (stretch.from_mm + stretch.to_mm);
    const Vector3d middle = cylinder->point_in_world + middle_mm * cylinder->axis_in_world;
    // A rod may stand out of the workspace; one that is far from it is a chance meeting.
    if (workspace_mm_.exteriorDistance(middle) > 0.25 * workspace_mm_.diagonal().norm()) return;
    const double radius_a = RadiusIn(*cylinder, views_[a], one, middle_mm);
    const double radius_b = RadiusIn(*cylinder, views_[b], other, middle_mm);
    if (!IsOfDiameter(radius_a, diameter_mm_) || !IsOfDiameter(radius_b, diameter_mm_)) return;
    Candidate candidate{*cylinder, stretch, 0.0};
    for (std::size_t c = 0; c < views_.size(); ++c)
      if (const auto* found = Nearest(candidate, c, AgreeingMm(candidate, c)))
        candidate.score_mm += FitOf(candidate.cylinder, stretch, views_[c], *found, diameter_mm_)->length_mm;
    if (!best_ || candidate.score_mm > best_->score_mm) best_ = candidate;
  }

  // Strips within it are taken for the same rod: as far apart as the rod is wide, and two pixels.
  [[nodiscard]] double AgreeingMm(const Candidate& candidate, std::size_t camera) const {
    const Vector3d middle =
        candidate.cylinder.point_in_world +
        0.5 * (candidate.stretch.from_mm + candidate.stretch.to_mm) * candidate.cylinder.axis_in_world;
    const double distance_mm = (middle - views_[camera].camera().center_in_world()).norm();
    return 0.6 * diameter_mm_ + 2.0 * distance_mm / views_[camera].plane->focal_px();
  }

  [[nodiscard]] const Wedge* Nearest(const Candidate& candidate, std::size_t camera, double within_mm) const {
    const Wedge* nearest = nullptr;
    double least_mm = within_mm;
    for (const Wedge& wedge : wedges_[camera]) {
      constexpr double kMostTilt = 0.15;
      const auto fit = FitOf(candidate.cylinder, candidate.stretch, views_[camera], wedge, diameter_mm_);
      if (!fit || fit->tilt > kMostTilt || fit->offset_mm > least_mm) continue;
      // Of strips on one line, the longest is the first.
      if (nearest != nullptr && fit->offset_mm > 0.8 * least_mm) continue;
      least_mm = fit->offset_mm;
      nearest = &wedge;
    }
    return nearest;
  }

  [[nodiscard]] FoundRod Assemble() const {
    constexpr double kAstrayMm = 200.0;
    FoundRod rod;
    rod.cylinder = best_->cylinder;
    const double middle_mm = 0.5 * (best_->stretch.from_mm + best_->stretch.to_mm);
    for (std::size_t c = 0; c < views_.size(); ++c) {
      const Wedge* found = Nearest(*best_, c, AgreeingMm(*best_, c));
      const bool agrees = found != nullptr;
      if (!agrees) found = Nearest(*best_, c, kAstrayMm);
      if (found == nullptr) continue;
      const double offset_mm = found->middle_normal.dot(best_->cylinder.point_in_world +
                                                        middle_mm * best_->cylinder.axis_in_world -
                                                        views_[c].camera().center_in_world());
      (agrees ? rod.agreeing : rod.astray).push_back({static_cast<int>(c), found->strip, offset_mm});
    }
    rod.cylinder.radius_mm = 0.5 * diameter_mm_;
    rod.cylinder.point_in_world += middle_mm * rod.cylinder.axis_in_world;
    rod.from_mm = best_->stretch.from_mm - middle_mm;
    rod.to_mm = best_->stretch.to_mm - middle_mm;
    return rod;
  }

  [[nodiscard]] std::string Reason() const {
    std::string seeing, with_strip;
    int strips = 0;
    for (std::size_t c = 0; c < views_.size(); ++c) {
      const std::string name = fmt::format("'{}'", views_[c].camera().name());
      if (!views_[c].points.empty()) seeing += (seeing.empty() ? "" : ", ") + name;
      if (wedges_[c].empty()) continue;
      ++strips;
      with_strip += (with_strip.empty() ? "" : ", ") + name;
    }
    if (seeing.empty()) return "no camera sees anything; hold the rod into the workspace";
    const std::string asked = fmt::format("two straight edges that face each other {:.3g} to {:.3g} mm apart",
                                          kLeastShare * diameter_mm_, kMostShare * diameter_mm_);
    if (strips == 0)
      return fmt::format(
          "{} see something, but none sees {}; hold the rod across their view, and check --rod", seeing,
          asked);
    if (strips == 1)
      return fmt::format("only {} sees {}; hold the rod so that a second camera sees it from the side",
                         with_strip, asked);
    return fmt::format(
        "{} see {}, but these don't meet in one rod in the workspace; check --rod, and that RIG.yml "
        "is of these cameras as they stand",
        with_strip, asked);
  }

  std::span<const RodView> views_;
  Eigen::AlignedBox3d workspace_mm_;
  double diameter_mm_;
  std::vector<std::vector<Wedge>> wedges_;  // by camera
  std::optional<Candidate> best_;
};

}  // namespace

double AlongAxis(const Cylinder& cylinder, const RodView& view, const Vector2d& position) {
  const Vector3d sight = view.SightInWorld(position);
  const Vector3d& axis = cylinder.axis_in_world;
  const Vector3d to_eye = view.camera().center_in_world() - cylinder.point_in_world;
  // The nearest point of the axis to the sight.
  const double cosine = axis.dot(sight), sine_squared = std::max(1.0 - cosine * cosine, 1e-12);
  return (axis.dot(to_eye) - cosine * sight.dot(to_eye)) / sine_squared;
}

RodSearch FindRod(std::span<const RodView> views, const Eigen::AlignedBox3d& workspace_mm,
                  double diameter_mm) {
  return Search(views, workspace_mm, diameter_mm).Run();
}

}  // namespace elbowroom::recon
