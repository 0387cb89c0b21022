#include "tests/accuracy/hull_section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "tests/oracles/first_along.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSeedStepMm = 1.0;
// Rays from the seed: at first this many all round, then halved where the outline's points are far apart.
constexpr int kFirstRays = 64;
constexpr int kMostHalvings = 7;
constexpr double kOutlineStepMm = 0.2;
constexpr int kDirections = 720;  // a quarter of a degree: 0.2 % of the length where a section is long

// A section in coordinates of its own: x along `across`, y away from the viewer.
class Section {
 public:
  Section(const SectionQueries& hull, const SectionPlane& plane)
      : hull_(hull), plane_(plane), depth_in_world_(plane.across_in_world.cross(plane.axis_in_world)) {}

  // The point inside that is nearest to the centre of all those inside.
  [[nodiscard]] std::optional<Vector2d> Seed() const {
    std::vector<Vector2d> inside;
    Vector2d sum = Vector2d::Zero();
    for (double y = -kNearMm; y <= kNearMm; y += kSeedStepMm) {
      for (double x = -kNearMm; x <= kNearMm; x += kSeedStepMm) {
        const Vector2d at(x, y);
        if (at.norm() > kNearMm || !hull_.contains(InWorld(at))) continue;
        inside.push_back(at);
        sum += at;
      }
    }
    if (inside.empty()) return std::nullopt;
    const Vector2d center = sum / static_cast<double>(inside.size());
    return *std::ranges::min_element(inside, {}, [&](const Vector2d& at) { return (at - center).norm(); });
  }

  [[nodiscard]] std::vector<Vector2d> OutlineAround(const Vector2d& seed) const {
    std::vector<Vector2d> outline;
    Vector2d from = EdgeAt(seed, 0.0);
    for (int i = 0; i < kFirstRays; ++i) {
      const double begin_rad = AngleOf(i), end_rad = AngleOf(i + 1);
      const Vector2d to = EdgeAt(seed, end_rad);
      AddBetween(seed, {begin_rad, from}, {end_rad, to}, kMostHalvings, &outline);
      from = to;
    }
    return outline;
  }

 private:
  struct Edge {
    double angle_rad = 0.0;
    Vector2d at;
  };

  static double AngleOf(int i) { return 2.0 * std::numbers::pi * i / kFirstRays; }

  [[nodiscard]] Vector3d DirectionInWorld(const Vector2d& direction) const {
    return direction.x() * plane_.across_in_world + direction.y() * depth_in_world_;
  }
  [[nodiscard]] Vector3d InWorld(const Vector2d& at) const {
    return plane_.middle_in_world + DirectionInWorld(at);
  }
  [[nodiscard]] Vector2d EdgeAt(const Vector2d& seed, double angle_rad) const {
    const Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
    return seed + hull_.way_out_mm({InWorld(seed), DirectionInWorld(direction)}, kFarthestMm) * direction;
  }

  void AddBetween(const Vector2d& seed, const Edge& from, const Edge& to, int halvings,
                  std::vector<Vector2d>* outline) const {
    if (halvings == 0 || (to.at - from.at).norm() <= kOutlineStepMm) {
      outline->push_back(to.at);
      return;
    }
    const double angle_rad = 0.5 * (from.angle_rad + to.angle_rad);
    const Edge middle{angle_rad, EdgeAt(seed, angle_rad)};
    AddBetween(seed, from, middle, halvings - 1, outline);
    AddBetween(seed, middle, to, halvings - 1, outline);
  }

  const SectionQueries& hull_;
  const SectionPlane& plane_;
  Vector3d depth_in_world_;
};

double ExtentAlong(const std::vector<Vector2d>& points, const Vector2d& direction) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector2d& point : points) {
    low = std::min(low, point.dot(direction));
    high = std::max(high, point.dot(direction));
  }
  return high - low;
}

}  // namespace

SectionQueries QueriesOf(const recon::VisualHull& hull) {
  return {[=](const Vector3d& x_in_world) { return hull.Contains(x_in_world); },
          [=](const recon::Ray& ray, double most_mm) {
            return recon::FirstOutside(hull, ray, {0.0, most_mm}).value_or(most_mm);
          }};
}

SectionQueries QueriesOf(const oracles::AnalyticHull& hull) {
  const auto shared = std::make_shared<const oracles::AnalyticHull>(hull);
  const auto is_out = [=](const recon::Ray& ray, long double t_mm) {
    return !shared->Contains(oracles::PointAt(ray, t_mm).cast<double>());
  };
  return {[=](const Vector3d& x_in_world) { return shared->Contains(x_in_world); },
          [=](const recon::Ray& ray, double most_mm) {
            const auto out_mm = oracles::FirstAlong(
                0.0L, most_mm, kWayOutStepMm, [&](long double t_mm) { return is_out(ray, t_mm); },
                [](long double, long double) { return false; });
            return out_mm.value_or(most_mm);
          }};
}

SectionPlane SectionSeenFrom(const Vector3d& eye_in_world, const Vector3d& middle_in_world,
                             const Vector3d& axis_in_world) {
  const Vector3d across = axis_in_world.cross((middle_in_world - eye_in_world).normalized());
  core::Require(across.norm() > 1e-3, "a finger isn't seen end-on");
  return {middle_in_world, axis_in_world, across.normalized()};
}

std::optional<SectionWidths> MeasureSection(const SectionQueries& hull, const SectionPlane& plane) {
  const Section section(hull, plane);
  const std::optional<Vector2d> seed = section.Seed();
  if (!seed) return std::nullopt;
  const std::vector<Vector2d> outline = section.OutlineAround(*seed);
  SectionWidths widths;
  for (const Vector2d& point : outline) widths.bounds_mm.extend(point);
  widths.seen_mm = widths.bounds_mm.sizes().x();
  widths.smallest_mm = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const double angle_rad = std::numbers::pi * i / kDirections;
    const double extent_mm = ExtentAlong(outline, {std::cos(angle_rad), std::sin(angle_rad)});
    widths.smallest_mm = std::min(widths.smallest_mm, extent_mm);
    widths.largest_mm = std::max(widths.largest_mm, extent_mm);
  }
  return widths;
}

std::optional<double> WidthOnPlanes(const recon::VisualHull& hull, const SectionPlane& plane,
                                    const SectionWidths& section, const Vector3d& eye_in_world,
                                    double spacing_mm) {
  const double distance_mm = (plane.middle_in_world - eye_in_world).norm();
  const Vector3d sight = (plane.middle_in_world - eye_in_world) / distance_mm;
  // Along the line of sight, from the middle: one step further is `across_axis` deeper in the section and
  // `along_axis` further along the finger.
  const double along_axis = std::abs(sight.dot(plane.axis_in_world));
  const double across_axis = std::sqrt(1.0 - along_axis * along_axis);
  const double reach_mm = kStretchMm / std::max(along_axis, 1e-9);
  const double from_mm = std::max(section.bounds_mm.min().y() / across_axis, -reach_mm);
  const double to_mm = std::min(section.bounds_mm.max().y() / across_axis, reach_mm);
  Eigen::AlignedBox1d seen_mm;
  for (double i = std::ceil((distance_mm + from_mm) / spacing_mm); i * spacing_mm <= distance_mm + to_mm;
       i += 1.0) {
    const recon::Ray line{eye_in_world + i * spacing_mm * sight - kFarthestMm * plane.across_in_world,
                          plane.across_in_world};
    for (const recon::HullInterval& interval : recon::IntervalsInHull(hull, line, {0.0, 2.0 * kFarthestMm})) {
      const double low_mm = interval.from_mm - kFarthestMm, high_mm = interval.to_mm - kFarthestMm;
      if (low_mm > section.bounds_mm.max().x() || high_mm < section.bounds_mm.min().x()) continue;
      seen_mm.extend(Eigen::Matrix<double, 1, 1>(low_mm));
      seen_mm.extend(Eigen::Matrix<double, 1, 1>(high_mm));
    }
  }
  if (seen_mm.isEmpty()) return std::nullopt;
  return seen_mm.sizes().x();
}

}  // namespace elbowroom::accuracy
