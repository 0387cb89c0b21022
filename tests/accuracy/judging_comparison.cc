#include "tests/accuracy/judging_comparison.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <type_traits>
#include <variant>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "recon/paper_methods/triangle_viewports.h"
#include "review/clearance.h"
#include "review/contacts.h"
#include "tests/accuracy/curtain_scene.h"
#include "tests/oracles/mask_hull_oracle.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

// A method's answer to one pose, as the error is taken from it, and what it promises.
struct Answer {
  double value = 0.0;
  double promised = 0.0;
  bool is_missed = false;
};

struct Asked {
  std::string family, setting;
  std::function<Answer(const core::RigidTransform&)> ask;
};

// Times every method at every pose, in turns, and holds what it answers to the truth.
std::vector<JudgingMethod> Compare(const std::vector<Asked>& methods,
                                   const std::vector<core::RigidTransform>& poses,
                                   const std::function<double(const Answer&, std::size_t)>& error_of,
                                   const TimingEffort& effort) {
  std::vector<JudgingMethod> compared;
  for (const Asked& method : methods) compared.push_back({method.family, method.setting});
  for (std::size_t pose = 0; pose < poses.size(); ++pose) {
    std::vector<std::function<void()>> jobs;
    for (const Asked& method : methods) jobs.emplace_back([&, pose] { (void)method.ask(poses[pose]); });
    const std::vector<Timing> timings = TimeInTurns(jobs, 1, effort);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const Answer answer = methods[i].ask(poses[pose]);
      const double error = std::abs(error_of(answer, pose));
      JudgingMethod& method = compared[i];
      method.time_ms += timings[i].median_ms / static_cast<double>(poses.size());
      method.rms_error += error * error / static_cast<double>(poses.size());
      method.worst_error = std::max(method.worst_error, error);
      method.promised = std::max(method.promised, answer.promised);
      method.missed += answer.is_missed ? 1 : 0;
    }
  }
  for (JudgingMethod& method : compared) method.rms_error = std::sqrt(method.rms_error);
  return compared;
}

HandSight HandBefore(recon::ViewSceneRig rig) {
  const recon::ViewScene scene = recon::MakeViewScene(rig);
  return HandSightOf(scene.rig, scene.objects);
}

std::vector<core::RigidTransform> RandomPoses(const HandSight& sight, const core::TriangleTree& part,
                                              int count, double from_mm, double to_mm, std::uint64_t seed) {
  recon::Random random(seed);
  std::vector<core::RigidTransform> poses;
  for (int i = 0; i < count; ++i)
    poses.push_back(PushedIn(sight.hull, part, random.Rotation(), kHandMm, random.Uniform(from_mm, to_mm)));
  return poses;
}

// Of the panel's points, each standing for a square of kSampleMm a side, those that are in the hull.
double SampledAreaMm2(const oracles::MaskHullOracle& oracle, const core::RigidTransform& world_from_part) {
  constexpr double kSampleMm = 0.1, kHalfAcrossMm = 180.0, kHalfUpMm = 200.0;
  const auto is_inside = [&](double y_mm, double z_mm) {
    return oracle.Contains((world_from_part * Vector3d(0.0, y_mm, z_mm)).cast<long double>());
  };
  // Whatever of the hull is near one of the points 2 mm apart that are in it; slivers away from all of them
  // are left out.
  constexpr int kCoarse = 20;
  const int across = static_cast<int>(2.0 * kHalfAcrossMm / kSampleMm) / kCoarse;
  const int up = static_cast<int>(2.0 * kHalfUpMm / kSampleMm) / kCoarse;
  const auto at = [&](double cell, double half_mm) { return (cell + 0.5) * kCoarse * kSampleMm - half_mm; };
  std::vector<std::uint8_t> is_hull(static_cast<std::size_t>(across) * up);
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < across; ++i)
      is_hull[static_cast<std::size_t>(j) * across + i] = is_inside(at(i, kHalfAcrossMm), at(j, kHalfUpMm));
  const auto hull_at = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < across && j < up && is_hull[static_cast<std::size_t>(j) * across + i] != 0;
  };
  std::int64_t inside = 0;
  for (int j = 0; j < up; ++j) {
    for (int i = 0; i < across; ++i) {
      int near = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) near += hull_at(i + dx, j + dy) ? 1 : 0;
      if (near == 0) continue;
      for (int b = 0; b < kCoarse; ++b)
        for (int a = 0; a < kCoarse; ++a)
          inside += is_inside(at(i + (a + 0.5) / kCoarse - 0.5, kHalfAcrossMm),
                              at(j + (b + 0.5) / kCoarse - 0.5, kHalfUpMm))
                        ? 1
                        : 0;
    }
  }
  return static_cast<double>(inside) * kSampleMm * kSampleMm;
}

Asked ContactsAt(const HandSight& sight, const core::TriangleTree& part, double resolution_mm) {
  review::ContactOptions options;
  options.resolution_mm = resolution_mm;
  return {"exact contacts", resolution_mm > 0.0 ? fmt::format("{} mm", resolution_mm) : "half a pixel",
          [&, options](const core::RigidTransform& pose) {
            const core::PartContact contact = review::FindContacts(sight.hull, part, pose, 0, options);
            return Answer{contact.contact_area_mm2, 0.0, contact.verdict != core::Verdict::kContact};
          }};
}

Asked ViewportsOf(const HandSight& sight, const core::TriangleTree& part, int side_px) {
  // A triangle fills half of its viewport, and all of the panel's are as large.
  const double pixel_mm2 = 2.0 * core::AreaMm2(part.mesh()) /
                           (static_cast<double>(part.mesh().triangles.size()) * side_px * side_px);
  return {"the paper's viewports, CPU", fmt::format("{} x {}", side_px, side_px),
          [&, pixel_mm2,
           options = recon::TriangleViewportOptions{side_px, side_px}](const core::RigidTransform& pose) {
            const recon::SampledContacts sampled =
                recon::SampleTriangles(sight.textures, part.mesh(), pose, options);
            return Answer{pixel_mm2 * static_cast<double>(sampled.contacts.size()), 0.0,
                          sampled.contacts.empty()};
          }};
}

Asked ClearanceTo(const HandSight& sight, const core::TriangleTree& part, double tolerance_mm) {
  return {"certified clearance", fmt::format("{} mm", tolerance_mm),
          [&, tolerance_mm](const core::RigidTransform& pose) {
            const core::ClearanceInterval interval =
                review::FindClearance(sight.hull, part, pose, {.tolerance_mm = tolerance_mm}).interval;
            return Answer{interval.upper_mm, interval.upper_mm - interval.lower_mm};
          }};
}

using FclMesh = fcl::BVHModel<fcl::OBBRSSd>;

std::unique_ptr<FclMesh> ToFcl(const core::TriangleMesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.emplace_back(static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                           static_cast<std::size_t>(c));
  auto built = std::make_unique<FclMesh>();
  built->beginModel();
  built->addSubModel(mesh.vertices_mm, triangles);
  core::Require(built->endModel() == fcl::BVH_OK, "FCL takes any triangles");
  return built;
}

Asked MeshDistance(const HandSight& sight, const FclMesh& panel, double edge_mm) {
  return {"hull mesh and FCL", fmt::format("edges of {} mm", edge_mm),
          [&, edge_mm](const core::RigidTransform& pose) {
            const std::unique_ptr<FclMesh> hull = ToFcl(recon::MeshHull(sight.hull, edge_mm).mesh);
            fcl::Transform3d world_from_panel = fcl::Transform3d::Identity();
            world_from_panel.linear() = pose.rotation;
            world_from_panel.translation() = pose.translation_mm;
            fcl::DistanceResultd result;
            return Answer{fcl::distance(hull.get(), fcl::Transform3d::Identity(), &panel, world_from_panel,
                                        fcl::DistanceRequestd(), result)};
          }};
}

// `times` as large about the hand's middle.
std::vector<recon::SyntheticObject> Scaled(std::vector<recon::SyntheticObject> objects, double times) {
  for (recon::SyntheticObject& object : objects) {
    for (recon::Solid& solid : object.solids) {
      Vector3d& at_mm = solid.world_from_solid.translation_mm;
      at_mm = kHandMm + times * (at_mm - kHandMm);
      std::visit(
          [&](auto& shape) {
            using Shape = std::remove_cvref_t<decltype(shape)>;
            if constexpr (std::is_same_v<Shape, recon::Sphere>) shape.radius_mm *= times;
            if constexpr (std::is_same_v<Shape, recon::Box>) shape.size_mm *= times;
            if constexpr (std::is_same_v<Shape, recon::Capsule>) {
              shape.radius_mm *= times;
              shape.length_mm *= times;
            }
            if constexpr (std::is_same_v<Shape, recon::Tube>) {
              shape.outer_radius_mm *= times;
              shape.inner_radius_mm *= times;
              shape.length_mm *= times;
            }
          },
          solid.shape);
    }
  }
  return objects;
}

// A case of the table of costs, kept while all of them are timed in turns.
struct JudgingCase {
  HandSight sight;
  core::TriangleTree part;
  core::RigidTransform in_hull, away;
};

}  // namespace

std::vector<JudgingMethod> CompareContactAreas(int poses, std::uint64_t seed, const TimingEffort& effort) {
  const HandSight sight = HandBefore(recon::ViewSceneRig::kThree);
  const core::TriangleTree part(MakeTabletopPanel());
  const std::vector<core::RigidTransform> at = RandomPoses(sight, part, poses, 2.0, 20.0, seed);
  const oracles::MaskHullOracle oracle(*sight.rig, sight.masks,
                                       oracles::BoundaryConvention::kMarchingSquares);
  std::vector<double> truth_mm2;
  for (const core::RigidTransform& pose : at) truth_mm2.push_back(SampledAreaMm2(oracle, pose));
  std::vector<Asked> methods;
  for (const double resolution_mm : {8.0, 4.0, 2.0, 0.0, 0.25, 0.125})
    methods.push_back(ContactsAt(sight, part, resolution_mm));
  for (const int side_px : {5, 10, 20, 40, 80}) methods.push_back(ViewportsOf(sight, part, side_px));
  return Compare(
      methods, at,
      [&](const Answer& answer, std::size_t pose) {
        return 100.0 * (answer.value - truth_mm2[pose]) / truth_mm2[pose];
      },
      effort);
}

std::vector<JudgingMethod> CompareClearances(int poses, std::uint64_t seed,
                                             std::span<const double> mesh_edges_mm,
                                             const TimingEffort& effort) {
  constexpr double kTruthMm = 1e-3;
  const HandSight sight = HandBefore(recon::ViewSceneRig::kThree);
  const core::TriangleTree part(MakeTabletopPanel());
  const std::unique_ptr<FclMesh> panel = ToFcl(part.mesh());
  const std::vector<core::RigidTransform> at = RandomPoses(sight, part, poses, -60.0, -5.0, seed);
  std::vector<double> truth_mm;
  for (const core::RigidTransform& pose : at) {
    const core::ClearanceInterval interval =
        review::FindClearance(sight.hull, part, pose, {.tolerance_mm = kTruthMm}).interval;
    core::Require(interval.upper_mm - interval.lower_mm <= kTruthMm, "the truth is known");
    truth_mm.push_back(0.5 * (interval.lower_mm + interval.upper_mm));
  }
  std::vector<Asked> methods;
  for (const double tolerance_mm : {10.0, 3.0, 1.0, 0.3, 0.1, 0.03, 0.01})
    methods.push_back(ClearanceTo(sight, part, tolerance_mm));
  for (const double edge_mm : mesh_edges_mm) methods.push_back(MeshDistance(sight, *panel, edge_mm));
  return Compare(
      methods, at, [&](const Answer& answer, std::size_t pose) { return answer.value - truth_mm[pose]; },
      effort);
}

std::vector<JudgingCost> MeasureJudgingCosts(const TimingEffort& effort) {
  struct Wanted {
    std::string what;
    recon::ViewSceneRig rig = recon::ViewSceneRig::kThree;
    int across = 18, up = 20;
    double hull_size = 1.0, depth_mm = 10.0;
  };
  const auto three = recon::ViewSceneRig::kThree;
  const std::vector<Wanted> wanted = {{"as it is"},
                                      {"1 000 triangles", three, 25, 20},
                                      {"10 000 triangles", three, 100, 50},
                                      {"100 000 triangles", three, 250, 200},
                                      {"1 000 000 triangles", three, 800, 625},
                                      {"1 mm in the hull", three, 18, 20, 1.0, 1.0},
                                      {"40 mm in the hull", three, 18, 20, 1.0, 40.0},
                                      {"four cameras", recon::ViewSceneRig::kFour},
                                      {"eight cameras", recon::ViewSceneRig::kEight},
                                      {"hull half as large", three, 18, 20, 0.5},
                                      {"hull twice as large", three, 18, 20, 2.0}};
  std::vector<JudgingCost> costs;
  std::vector<std::unique_ptr<JudgingCase>> cases;
  std::vector<std::function<void()>> jobs;  // two a case
  for (const Wanted& one : wanted) {
    const recon::ViewScene scene = recon::MakeViewScene(one.rig);
    HandSight sight = HandSightOf(scene.rig, Scaled(scene.objects, one.hull_size));
    core::TriangleTree part(MakeTabletopPanel(one.across, one.up));
    const core::RigidTransform touching =
        PushedIn(sight.hull, part, Eigen::Matrix3d::Identity(), kHandMm, 0.0);
    const auto moved = [&](double depth_mm) {
      return core::RigidTransform{touching.rotation, touching.translation_mm + depth_mm * Vector3d::UnitX()};
    };
    const JudgingCase& kept = *cases.emplace_back(std::make_unique<JudgingCase>(
        JudgingCase{std::move(sight), std::move(part), moved(one.depth_mm), moved(-30.0)}));
    const core::PartContact contact = review::FindContacts(kept.sight.hull, kept.part, kept.in_hull, 0);
    const review::Clearance clearance = review::FindClearance(kept.sight.hull, kept.part, kept.away);
    JudgingCost& cost = costs.emplace_back();
    cost.what = one.what;
    cost.triangles = kept.part.mesh().triangles.size();
    cost.cameras = kept.sight.rig->cameras.size();
    cost.hull_cm3 = 1e-3 * core::VolumeMm3(recon::MeshHull(kept.sight.hull, 4.0).mesh);
    cost.contact_area_mm2 = contact.contact_area_mm2;
    cost.contact_queries = contact.count.queries;
    cost.skipped_triangles =
        static_cast<double>(contact.count.skipped) / static_cast<double>(contact.count.triangles);
    cost.clearance_queries = clearance.queries;
    jobs.emplace_back([&kept] { (void)review::FindContacts(kept.sight.hull, kept.part, kept.in_hull, 0); });
    jobs.emplace_back([&kept] { (void)review::FindClearance(kept.sight.hull, kept.part, kept.away); });
  }
  const std::vector<Timing> timings = TimeInTurns(jobs, 1, effort);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    costs[i].contacts = timings[2 * i];
    costs[i].clearance = timings[2 * i + 1];
  }
  return costs;
}

}  // namespace elbowroom::accuracy
