#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/bvh.h"
#include "core/units.h"
#include "recon/hull/visual_hull.h"
#include "recon/paper_methods/coverage_hull.h"
#include "review/contacts.h"
#include "review/paper_methods/two_triangle_response.h"
#include "tests/accuracy/collision_comparison.h"
#include "tests/oracles/analytic_hull.h"
#include "tests/oracles/coverage_mask.h"
#include "tests/oracles/mask_hull_oracle.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kBallMm = 40.0, kBarMm = 20.0, kBarLengthMm = 150.0;
constexpr double kSharpPicturePx = 2.0;  // a lens as sharp as its sensor (tests/oracles/coverage_mask.h)
constexpr double kReferenceOffMm = 200.0;
constexpr double kEdgeMm = 3.0;  // nearer to another camera's bound the hull has an edge, not a normal

// All points within `radius_mm` of a segment; of no length: a ball.
struct Round {
  Vector3d a, b;
  double radius_mm;
};

// Where a line comes nearest to the segment, as seen from there: the way from the segment to the line.
Vector3d FromAxis(const Round& round, const recon::Ray& line) {
  const Vector3d along = round.b - round.a, between = round.a - line.origin_in_world;
  const Vector3d& d = line.direction_in_world;
  const double ad = along.dot(d), across = along.squaredNorm() - ad * ad;
  const double share = across > 0.0 ? (ad * between.dot(d) - along.dot(between)) / across : 0.0;
  const Vector3d foot = round.a + std::clamp(share, 0.0, 1.0) * along - line.origin_in_world;
  return foot.dot(d) * d - foot;
}

// Out of the hull of perfect cameras at a point of its surface; nothing where not one camera alone bounds it.
std::optional<Vector3d> NormalAt(const core::Rig& rig, const Round& round, const Vector3d& x_in_world) {
  std::optional<Vector3d> normal;
  double largest_mm = -HUGE_VAL, second_mm = -HUGE_VAL;
  for (const core::CameraModel& camera : rig.cameras) {
    const Vector3d& eye = camera.center_in_world();
    const Vector3d out = FromAxis(round, {eye, (x_in_world - eye).normalized()});
    const double margin_mm = out.norm() - round.radius_mm;
    second_mm = std::max(second_mm, std::min(margin_mm, largest_mm));
    if (margin_mm > largest_mm) {
      largest_mm = margin_mm;
      normal = out.normalized();
    }
  }
  if (second_mm > largest_mm - kEdgeMm) return std::nullopt;
  return normal;
}

ErrorShare ShareOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.5), at(0.95)};
}

struct Errors {
  std::vector<double> to_masks_mm, to_analytic_mm, normal_deg;
  int without_normal = 0;

  void Append(const Errors& other) {
    to_masks_mm.insert(to_masks_mm.end(), other.to_masks_mm.begin(), other.to_masks_mm.end());
    to_analytic_mm.insert(to_analytic_mm.end(), other.to_analytic_mm.begin(), other.to_analytic_mm.end());
    normal_deg.insert(normal_deg.end(), other.normal_deg.begin(), other.normal_deg.end());
    without_normal += other.without_normal;
  }
  [[nodiscard]] ResponseErrors::OfMethod Summary() const {
    return {ShareOf(to_masks_mm), ShareOf(to_analytic_mm), ShareOf(normal_deg), without_normal};
  }
};

struct Depths {
  double from_mm, to_mm;
  int responses = 0;
  Errors two_triangles = {}, exact = {};
};

// One ray's truth.
struct Truth {
  double to_masks_mm, to_analytic_mm;  // from RP_obj to the hulls
  std::optional<Vector3d> normal;
};

void Add(const core::Recovery& recovery, const Vector3d& rp_obj, const Truth& truth, Errors* errors) {
  const double found_mm = (recovery.cp_hull_in_world_mm - rp_obj).norm();
  errors->to_masks_mm.push_back(std::abs(found_mm - truth.to_masks_mm));
  errors->to_analytic_mm.push_back(std::abs(found_mm - truth.to_analytic_mm));
  errors->without_normal += recovery.n_hull_in_world ? 0 : 1;
  if (!truth.normal || !recovery.n_hull_in_world) return;
  const Vector3d& n = *recovery.n_hull_in_world;
  errors->normal_deg.push_back(
      core::DegreesFromRadians(std::atan2(n.cross(*truth.normal).norm(), n.dot(*truth.normal))));
}

Round RandomRound(recon::Random* random, bool is_bar) {
  constexpr double kAsideMm = 150.0, kLowMm = 150.0, kHighMm = 350.0;
  const Vector3d center(random->Uniform(-kAsideMm, kAsideMm), random->Uniform(-kAsideMm, kAsideMm),
                        random->Uniform(kLowMm, kHighMm));
  const Vector3d half = is_bar ? Vector3d(0.5 * kBarLengthMm * random->Direction()) : Vector3d::Zero();
  return {center - half, center + half, is_bar ? kBarMm : kBallMm};
}

recon::Solid SolidOf(const Round& round) {
  const Vector3d color = Vector3d::Constant(200.0);
  if (round.a != round.b) return recon::CapsuleBetween(round.a, round.b, round.radius_mm, color);
  return {recon::Sphere{round.radius_mm}, {Eigen::Matrix3d::Identity(), round.a}, color};
}

// A part that is one point.
core::TriangleTree PointPart(const Vector3d& x_in_world) {
  return core::TriangleTree(
      std::make_shared<const core::TriangleMesh>(core::TriangleMesh{{x_in_world}, {{0, 0, 0}}}));
}

// One solid and the hulls of it.
struct Sight {
  Sight(const std::shared_ptr<const core::Rig>& shared, const Round& of)
      : rig(*shared),
        round(of),
        masks(MasksOf(rig, of)),
        hull(recon::MakeVisualHull(shared, masks)),
        textures(rig, masks),
        analytic(rig, std::vector{SolidOf(of)}),
        brute_force(rig, masks, oracles::BoundaryConvention::kMarchingSquares) {}

  static std::vector<core::SoftMask> MasksOf(const core::Rig& rig, const Round& round) {
    const std::vector<recon::Solid> solids = {SolidOf(round)};
    std::vector<core::SoftMask> masks;
    for (const core::CameraModel& camera : rig.cameras)
      masks.push_back(oracles::CoverageMask(camera, solids, kSharpPicturePx));
    return masks;
  }

  core::Rig rig;
  Round round;
  std::vector<core::SoftMask> masks;
  recon::VisualHull hull;
  recon::CoverageHull textures;
  oracles::AnalyticHull analytic;
  oracles::MaskHullOracle brute_force;
};

// Backs a point out of the hull towards a random reference, both ways.
void RespondOnce(const Sight& sight, recon::Random* random, Depths* depths) {
  const Vector3d on_axis = sight.round.a + random->Uniform(0.0, 1.0) * (sight.round.b - sight.round.a);
  const Vector3d v_rec = random->Direction(), rp_obj = on_axis + kReferenceOffMm * v_rec;
  const double depth_mm = random->Uniform(depths->from_mm, depths->to_mm);
  const auto to_analytic_mm = sight.analytic.FirstSurface({rp_obj, -v_rec});
  const auto to_masks_mm = sight.brute_force.FirstSurface({rp_obj, -v_rec});
  if (!to_analytic_mm || !to_masks_mm) return;
  const Vector3d cp_obj = rp_obj - (*to_masks_mm + depth_mm) * v_rec;
  if (!sight.textures.Contains(cp_obj)) return;  // through to the other side
  const auto two = review::RespondByTwoTriangles(sight.textures, std::span(&cp_obj, 1), rp_obj);
  review::ContactOptions options;
  options.recovery.reference_in_part_mm = rp_obj;
  const auto exact = review::FindContacts(sight.hull, PointPart(cp_obj), {}, 0, options);
  if (!two.recovery || !exact.recovery) return;
  const Truth truth{*to_masks_mm, *to_analytic_mm,
                    NormalAt(sight.rig, sight.round, rp_obj - *to_analytic_mm * v_rec)};
  ++depths->responses;
  Add(*two.recovery, rp_obj, truth, &depths->two_triangles);
  Add(*exact.recovery, rp_obj, truth, &depths->exact);
}

}  // namespace

std::vector<ResponseErrors> MeasureResponses(recon::ViewSceneRig rig, int solids, int rays,
                                             std::uint64_t seed) {
  const auto shared = std::make_shared<const core::Rig>(recon::MakeViewScene(rig).rig);
  recon::Random random(seed);
  std::vector<Depths> depths = {{1.0, 3.0}, {3.0, 8.0}, {8.0, 20.0}, {20.0, 45.0}};
  for (int i = 0; i < solids; ++i) {
    const Sight sight(shared, RandomRound(&random, i % 2 == 1));
    for (int ray = 0; ray < rays; ++ray)
      RespondOnce(sight, &random, &depths[static_cast<std::size_t>(ray) % depths.size()]);
  }
  Depths all{depths.front().from_mm, depths.back().to_mm};
  for (const Depths& depth : depths) {
    all.responses += depth.responses;
    all.two_triangles.Append(depth.two_triangles);
    all.exact.Append(depth.exact);
  }
  depths.insert(depths.begin(), std::move(all));
  std::vector<ResponseErrors> result;
  for (const Depths& depth : depths)
    result.push_back(
        {depth.from_mm, depth.to_mm, depth.responses, depth.two_triangles.Summary(), depth.exact.Summary()});
  return result;
}

}  // namespace elbowroom::accuracy
