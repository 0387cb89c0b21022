#include "tests/accuracy/collision_comparison.h"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>

#include "core/bvh.h"
#include "core/error.h"
#include "recon/gl/paper_methods/triangle_viewports_gl.h"
#include "recon/hull/visual_hull.h"
#include "recon/paper_methods/coverage_hull.h"
#include "review/contacts.h"
#include "review/paper_methods/two_triangle_response.h"
#include "tests/accuracy/curtain_scene.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kReferenceAwayMm = 200.0;  // RP_obj stands off the part, where it comes from

core::SharedMesh MeshOf(CollisionPart part) {
  return part == CollisionPart::kCurtain ? MakeCurtain() : MakeTabletopPanel();
}

review::ContactOptions OptionsOf(CollisionMethod method) {
  review::ContactOptions options;
  if (method == CollisionMethod::kExactAtTwoMm) options.resolution_mm = 2.0;
  options.recovery.reference_in_part_mm = Vector3d(-kReferenceAwayMm, 0.0, 0.0);
  return options;
}

std::vector<Vector3d> PositionsOf(const recon::SampledContacts& sampled) {
  std::vector<Vector3d> positions;
  for (const recon::ViewportContact& contact : sampled.contacts)
    positions.push_back(contact.position_in_world_mm);
  return positions;
}

}  // namespace

std::string NameOf(CollisionMethod method) {
  switch (method) {
    case CollisionMethod::kViewportsGl:
      return "the paper's viewports, GL";
    case CollisionMethod::kViewportsCpu:
      return "the paper's viewports, CPU";
    case CollisionMethod::kExact:
      return "exact";
    case CollisionMethod::kExactAtTwoMm:
      break;
  }
  return "exact, contacts to 2 mm";
}

std::string NameOf(CollisionPart part) {
  return part == CollisionPart::kCurtain ? "curtain, 7.5 x 3 mm" : "tabletop, 2 x 2 mm";
}

std::vector<CollisionCost> TimeCollisions(recon::ViewSceneRig rig, CollisionPart touched,
                                          const TimingEffort& effort) {
  constexpr double kThroughMm = 10.0;
  const recon::ViewScene scene = recon::MakeViewScene(rig);
  const HandSight sight = HandSightOf(scene.rig, scene.objects);
  const core::TriangleTree part(MeshOf(touched));
  const core::RigidTransform world_from_part =
      PushedIn(sight.hull, part, Eigen::Matrix3d::Identity(), kHandMm, kThroughMm);
  const Vector3d rp_obj = world_from_part * *OptionsOf(CollisionMethod::kExact).recovery.reference_in_part_mm;
  recon::gl::TriangleViewportsGl gl;
  const auto sample = [&](CollisionMethod method, const recon::CoverageHull& textures) {
    return method == CollisionMethod::kViewportsGl
               ? gl.Sample(textures, part.mesh(), world_from_part)
               : recon::SampleTriangles(textures, part.mesh(), world_from_part);
  };
  std::vector<CollisionCost> costs;
  std::vector<std::function<void()>> jobs;  // three a method
  std::vector<std::vector<Vector3d>> contacts(std::size(kCollisionMethods));
  for (const CollisionMethod method : kCollisionMethods) {
    CollisionCost& cost = costs.emplace_back();
    std::vector<Vector3d>& points = contacts[costs.size() - 1];
    if (method == CollisionMethod::kExact || method == CollisionMethod::kExactAtTwoMm) {
      const auto find = [&, options = OptionsOf(method)](const recon::VisualHull& hull) {
        return review::FindContacts(hull, part, world_from_part, 0, options);
      };
      cost.contact_points = find(sight.hull).contact_point_count;
      jobs.emplace_back(
          [&, find] { (void)find(recon::MakeVisualHull(sight.rig, sight.planes, sight.masks)); });
      jobs.emplace_back([&, find] { (void)find(sight.hull); });
      jobs.emplace_back([] {});
      continue;
    }
    const recon::SampledContacts sampled = sample(method, sight.textures);
    points = PositionsOf(sampled);
    cost.contact_points = static_cast<std::int64_t>(points.size());
    cost.work = sampled.work;
    cost.coarsest_step_mm = sampled.coarsest_step_mm;
    jobs.emplace_back([&, method] {
      const recon::CoverageHull textures(*sight.rig, sight.masks);
      (void)review::RespondByTwoTriangles(textures, PositionsOf(sample(method, textures)), rp_obj);
    });
    jobs.emplace_back([&, method] { (void)sample(method, sight.textures); });
    jobs.emplace_back([&] { (void)review::RespondByTwoTriangles(sight.textures, points, rp_obj); });
  }
  const std::vector<Timing> timings = TimeInTurns(jobs, 1, effort);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    costs[i].frame = timings[3 * i];
    costs[i].contacts = timings[3 * i + 1];
    costs[i].response = timings[3 * i + 2];
  }
  return costs;
}

std::vector<SmallContacts> CountMissed(recon::ViewSceneRig rig, CollisionPart touched, int trials,
                                       std::uint64_t seed) {
  constexpr double kMostPushedMm = 1.5, kAsideMm = 60.0;
  const recon::ViewScene scene = recon::MakeViewScene(rig);
  const HandSight sight = HandSightOf(scene.rig, scene.objects);
  const core::TriangleTree part(MeshOf(touched));
  recon::gl::TriangleViewportsGl gl;
  recon::Random random(seed);
  std::vector<SmallContacts> sizes;
  for (const auto& [from_mm, to_mm] :
       {std::pair{0.0, 1.0}, {1.0, 2.0}, {2.0, 3.0}, {3.0, 5.0}, {5.0, 7.5}, {7.5, 15.0}, {15.0, 1e9}})
    sizes.push_back({from_mm, to_mm, 0, std::vector<int>(std::size(kCollisionMethods), 0)});
  for (int trial = 0; trial < trials; ++trial) {
    const core::RigidTransform world_from_part =
        PushedIn(sight.hull, part, random.Rotation(), kHandMm, random.Uniform(0.0, kMostPushedMm));
    // Not always the same place of the part: turned about its axis above, moved along its plane here.
    const Vector3d aside = world_from_part.rotation * Vector3d(0.0, random.Uniform(-kAsideMm, kAsideMm),
                                                               random.Uniform(-kAsideMm, kAsideMm));
    const core::RigidTransform moved{world_from_part.rotation, world_from_part.translation_mm + aside};
    review::ContactOptions fine;
    fine.resolution_mm = kTouchResolutionMm;
    const double area_mm2 = review::FindContacts(sight.hull, part, moved, 0, fine).contact_area_mm2;
    if (!(area_mm2 > 0.0)) continue;
    const double across_mm = 2.0 * std::sqrt(area_mm2 / std::numbers::pi);
    for (SmallContacts& size : sizes) {
      if (across_mm < size.from_mm || across_mm >= size.to_mm) continue;
      ++size.contacts;
      size.missed[0] += gl.Sample(sight.textures, part.mesh(), moved).contacts.empty() ? 1 : 0;
      size.missed[1] += recon::SampleTriangles(sight.textures, part.mesh(), moved).contacts.empty() ? 1 : 0;
      for (std::size_t i = 2; i < size.missed.size(); ++i) {
        const auto contact =
            review::FindContacts(sight.hull, part, moved, 0, OptionsOf(kCollisionMethods[i]));
        size.missed[i] += contact.verdict == core::Verdict::kContact ? 0 : 1;
      }
    }
  }
  return sizes;
}

}  // namespace elbowroom::accuracy
