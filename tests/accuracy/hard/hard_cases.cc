#include "tests/accuracy/hard/hard_cases.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/heat_map.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "review/clearance.h"
#include "tests/support/hard_parts.h"
#include "tests/support/panel_mesh.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPanelMm = 400.0, kSphereMm = 60.0, kForestMm = 200.0, kNeedleMm = 60.0, kScanMm = 300.0;
constexpr double kTouchMm = 0.02;  // nearer than this is a touch

HardPart Part(std::string name, core::TriangleMesh mesh, bool encloses = false) {
  const auto shared = std::make_shared<const core::TriangleMesh>(std::move(mesh));
  return {std::move(name), std::make_shared<const core::TriangleTree>(shared),
          std::make_shared<const core::SurfacePatches>(shared, core::kHeatPatchMm), encloses};
}

core::TriangleMesh Moved(const core::TriangleMesh& mesh, const Vector3d& by_mm) {
  return core::Transformed(mesh, {Matrix3d::Identity(), by_mm});
}

// The hull's object, thicker all over, as the same cameras see it in a larger workspace; open at the end from
// which the arm comes, for what is in a closed surface counts as inside the part.
core::TriangleMesh Sleeve(const SeenHull& seen, int triangles) {
  constexpr double kTrialMm = 16.0;
  core::Rig rig = seen.hull->rig();
  const Vector3d more = Vector3d::Constant(2.0 * kAroundMm);
  rig.workspace_mm = {rig.workspace_mm.min() - more, rig.workspace_mm.max() + more};
  const auto shared = std::make_shared<const core::Rig>(std::move(rig));
  const recon::VisualHull thick =
      recon::MakeVisualHull(shared, recon::TrueMasks(*shared, {ObjectOf(seen.which, kAroundMm)}));
  // The number of triangles goes with the inverse square of the edges.
  const auto at_trial = static_cast<double>(recon::MeshHull(thick, kTrialMm).mesh.triangles.size());
  core::TriangleMesh mesh = recon::MeshHull(thick, kTrialMm * std::sqrt(at_trial / triangles)).mesh;
  const double end_mm = core::BoundsOf(mesh).max().x() - 0.1 * kAroundMm;
  std::erase_if(mesh.triangles, [&](const auto& triangle) {
    return std::ranges::all_of(triangle, [&](std::int32_t vertex) {
      return mesh.vertices_mm[static_cast<std::size_t>(vertex)].x() > end_mm;
    });
  });
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

// Moves along a line until the clearance is `gap_mm`, and never past that: the clearance changes by no more
// than the part moves. Bounds are as narrow as is needed to move on. Nothing if it isn't reached on the way.
std::optional<double> MovedUntil(const SeenHull& seen, const core::TriangleTree& tree,
                                 const core::RigidTransform& from, const Vector3d& direction, double gap_mm) {
  constexpr int kMostSteps = 200;
  constexpr double kNarrower = 0.1;
  const double farthest_mm = 2.0 * seen.hull->rig().workspace_mm.diagonal().norm();
  double moved_mm = 0.0, tolerance_mm = 1.0;
  for (int i = 0; i < kMostSteps && moved_mm < farthest_mm; ++i) {
    const core::RigidTransform at{from.rotation, from.translation_mm + moved_mm * direction};
    const core::ClearanceInterval away =
        review::FindClearance(*seen.hull, tree, at, {.tolerance_mm = tolerance_mm}).interval;
    if (away.upper_mm <= gap_mm + kTouchMm) return moved_mm;
    if (away.lower_mm - gap_mm > tolerance_mm) {
      moved_mm += away.lower_mm - gap_mm;
    } else if (tolerance_mm > 0.5 * kTouchMm) {
      tolerance_mm = std::max(kNarrower * tolerance_mm, 0.5 * kTouchMm);
    } else {
      return moved_mm;
    }
  }
  return std::nullopt;
}

// Where the part comes from, and towards where.
struct WayIn {
  core::RigidTransform from;
  Vector3d direction;
};

WayIn RandomWay(const SeenHull& seen, const HardPart& part, recon::Random* random) {
  const Vector3d direction = random->Direction();
  if (part.encloses) return {{}, direction};
  const Vector3d center_in_part = part.tree->bounds().center();
  const Vector3d& target = seen.surface_mm[static_cast<std::size_t>(
      random->Whole(0, static_cast<int>(seen.surface_mm.size()) - 1))];
  const double back_mm = seen.box_mm.diagonal().norm() + part.tree->bounds().diagonal().norm();
  const Matrix3d rotation = random->Rotation();
  return {{rotation, target - back_mm * direction - rotation * center_in_part}, direction};
}

double GapOf(HardPlace place, recon::Random* random) {
  switch (place) {
    case HardPlace::kTouching:
      return 0.0;
    case HardPlace::kClose:
      return random->Uniform(1.0, 5.0);
    case HardPlace::kFar:
      return random->Uniform(30.0, kAroundMm);
    case HardPlace::kAmid:
      break;
  }
  throw core::PreconditionError("a place at a distance");
}

}  // namespace

std::vector<HardPart> PartsForAll(const HardOptions& options) {
  const int squares = static_cast<int>(std::lround(std::sqrt(options.triangles / 2)));
  return {Part("panel", test_support::PanelMesh(squares, squares, {-0.5 * kPanelMm, -0.5 * kPanelMm, 0.0},
                                                {kPanelMm, 0.0, 0.0}, {0.0, kPanelMm, 0.0})),
          Part("sphere", test_support::SphereMesh(kSphereMm, options.triangles)),
          Part("needles", test_support::NeedleForestMesh(kForestMm, kNeedleMm, options.triangles)),
          Part("scan", test_support::ScanMesh(kScanMm, options.scan_triangles, options.seed))};
}

std::vector<HardPart> PartsAround(const SeenHull& seen, const HardOptions& options) {
  const Vector3d center = seen.box_mm.center();
  double ball_mm = 0.0, around_x_mm = 0.0;
  for (const Vector3d& x : seen.surface_mm) {
    ball_mm = std::max(ball_mm, (x - center).norm());
    around_x_mm = std::max(around_x_mm, (x - center).tail<2>().norm());
  }
  const double length_mm = seen.box_mm.sizes().x() + 2.0 * kAroundMm;
  return {Part("bore",
               Moved(test_support::BoreMesh(around_x_mm + kAroundMm, length_mm, options.triangles), center),
               true),
          Part("shell", Moved(test_support::ShellMesh(ball_mm + kAroundMm, options.triangles), center), true),
          Part("sleeve", Sleeve(seen, options.triangles), true)};
}

std::string_view ToString(HardPlace place) {
  switch (place) {
    case HardPlace::kTouching:
      return "touching";
    case HardPlace::kClose:
      return "close";
    case HardPlace::kFar:
      return "far";
    case HardPlace::kAmid:
      return "amid";
  }
  throw core::PreconditionError("a hard place");
}

core::RigidTransform PlaceOf(const SeenHull& seen, const HardPart& part, HardPlace place,
                             recon::Random* random) {
  constexpr int kMostWays = 50;
  if (place == HardPlace::kAmid) {
    if (part.encloses) return {};
    const Matrix3d rotation = random->Rotation();
    return {rotation, seen.middle_mm - rotation * part.tree->bounds().center()};
  }
  for (int i = 0; i < kMostWays; ++i) {
    const WayIn way = RandomWay(seen, part, random);
    const auto moved_mm = MovedUntil(seen, *part.tree, way.from, way.direction, GapOf(place, random));
    if (!moved_mm) continue;
    const double farther_mm = place == HardPlace::kTouching ? random->Uniform(1.0, 5.0) : 0.0;
    return {way.from.rotation, way.from.translation_mm + (*moved_mm + farther_mm) * way.direction};
  }
  throw core::PreconditionError("a part that can be moved to the hull");
}

std::vector<HardCase> CasesOf(const SeenHull& seen, const std::vector<HardPart>& parts,
                              const HardOptions& options) {
  recon::Random random(options.seed);
  std::vector<HardCase> cases;
  for (const HardPart& part : parts) {
    for (const HardPlace place : kHardPlaces) {
      // What encloses the hull has one place around it.
      const int places = place == HardPlace::kAmid && part.encloses ? 1 : options.places_each;
      for (int i = 0; i < places; ++i) cases.push_back({part, place, PlaceOf(seen, part, place, &random)});
    }
  }
  return cases;
}

}  // namespace elbowroom::accuracy
