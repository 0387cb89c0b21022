#include "tests/accuracy/shape_costs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "core/bvh.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "recon/synthetic/view_scene.h"
#include "review/clearance.h"
#include "tests/accuracy/hard/hard_errors.h"
#include "tests/support/hard_parts.h"
#include "tests/support/panel_mesh.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kSphereMm = 60.0, kSphereGapMm = 52.0, kFlatGapMm = 30.0, kAroundMm = 40.0;

// The demo's hand, and where its hull's surface is.
struct Hand {
  recon::VisualHull hull;
  std::vector<Vector3d> surface_mm;
  Eigen::AlignedBox3d box_mm;

  // The vertex farthest in that direction.
  [[nodiscard]] Vector3d Farthest(const Vector3d& direction) const {
    return *std::ranges::max_element(surface_mm, {}, [&](const Vector3d& x) { return x.dot(direction); });
  }
};

Hand MakeHand() {
  const recon::ViewScene scene = recon::MakeViewScene(recon::ViewSceneRig::kThree);
  Hand hand{recon::MakeVisualHull(std::make_shared<const core::Rig>(scene.rig),
                                  recon::TrueMasks(scene.rig, scene.objects)),
            {},
            {}};
  hand.surface_mm = recon::MeshHull(hand.hull, 2.0).mesh.vertices_mm;
  for (const Vector3d& x : hand.surface_mm) hand.box_mm.extend(x);
  return hand;
}

struct Placed {
  std::string shape;
  core::TriangleMesh mesh;
  Vector3d at_mm;
};

std::vector<Placed> PartsAround(const Hand& hand, int triangles) {
  const Vector3d down(0.0, 0.0, -1.0), aside = Vector3d(1.0, 0.3, 0.5).normalized();
  const Vector3d lowest = hand.Farthest(down), center = hand.box_mm.center();
  double ball_mm = 0.0, around_x_mm = 0.0;
  for (const Vector3d& x : hand.surface_mm) {
    ball_mm = std::max(ball_mm, (x - center).norm());
    around_x_mm = std::max(around_x_mm, (x - center).tail<2>().norm());
  }
  const int squares = static_cast<int>(std::lround(std::sqrt(triangles / 2)));
  return {
      {"flat: a panel",
       test_support::PanelMesh(squares, squares, {-200.0, -180.0, 0.0}, {400.0, 0.0, 0.0}, {0.0, 360.0, 0.0}),
       lowest + kFlatGapMm * down},
      {"convex: a sphere below", test_support::SphereMesh(kSphereMm, triangles),
       lowest + (kSphereGapMm + kSphereMm) * down},
      {"convex: a sphere beside", test_support::SphereMesh(kSphereMm, triangles),
       hand.Farthest(aside) + (kSphereGapMm + kSphereMm) * aside},
      {"concave: a bore around the arm",
       test_support::BoreMesh(around_x_mm + kAroundMm, 1.2 * hand.box_mm.sizes().x(), triangles), center},
      {"equidistant: a shell around the hand", test_support::ShellMesh(ball_mm + kAroundMm, triangles),
       center},
      {"needles: a forest below", test_support::NeedleForestMesh(400.0, 60.0, triangles),
       lowest + (kFlatGapMm + 60.0) * down}};
}

}  // namespace

std::vector<ShapeCost> MeasureShapeCosts(std::span<const int> triangles, const TimingEffort& effort) {
  const Hand hand = MakeHand();
  std::vector<ShapeCost> costs;
  for (const int wanted : triangles) {
    for (Placed& placed : PartsAround(hand, wanted)) {
      const core::TriangleTree part(std::make_shared<const core::TriangleMesh>(std::move(placed.mesh)));
      const core::RigidTransform pose{Eigen::Matrix3d::Identity(), placed.at_mm};
      const review::Clearance found = review::FindClearance(hand.hull, part, pose);
      const ClearanceErrors errors = ErrorsOf(found.interval, hand.hull, part, pose);
      ShapeCost cost;
      cost.shape = placed.shape;
      cost.triangles = part.mesh().triangles.size();
      cost.error_mm = errors.upper_mm;
      cost.promised_mm = found.interval.upper_mm - found.interval.lower_mm;
      cost.is_certified = errors.bounds_hold;
      cost.queries = found.queries;
      cost.distances = found.distances;
      const std::vector<std::function<void()>> job = {
          [&] { (void)review::FindClearance(hand.hull, part, pose); }};
      cost.clearance = TimeInTurns(job, 1, effort).front();
      costs.push_back(std::move(cost));
    }
  }
  std::ranges::stable_sort(costs, {}, &ShapeCost::shape);
  return costs;
}

}  // namespace elbowroom::accuracy
