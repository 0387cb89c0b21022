#include "tests/accuracy/collision_comparison.h"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>

#include "core/bvh.h"
#include "core/error.h"
#include "recon/coverage_hull.h"
#include "recon/gl/triangle_viewports_gl.h"
#include "recon/visual_hull.h"
#include "review/contacts.h"
#include "review/two_triangle_response.h"
#include "tests/recon/random_scene.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kTruthMm = 0.1;            // resolution of what counts as a contact
constexpr double kReferenceAwayMm = 200.0;  // RP_obj stands off the curtain, where it comes from

// A scene's masks, and both hulls of them.
struct Sight {
  std::shared_ptr<const core::Rig> rig;
  recon::PicturePlanes planes;
  std::vector<core::SoftMask> masks;
  recon::VisualHull hull;
  recon::CoverageHull textures;
};

Sight SightOf(const core::Rig& rig, const std::vector<recon::SyntheticObject>& objects) {
  const auto shared = std::make_shared<const core::Rig>(rig);
  recon::PicturePlanes planes = recon::MakePicturePlanes(rig);
  std::vector<core::SoftMask> masks = recon::TrueMasks(rig, objects);
  recon::VisualHull hull = recon::MakeVisualHull(shared, planes, masks);
  recon::CoverageHull textures(rig, masks);
  return {shared, std::move(planes), std::move(masks), std::move(hull), std::move(textures)};
}

review::ContactOptions OptionsOf(CollisionMethod method) {
  review::ContactOptions options;
  if (method == CollisionMethod::kExactAtTwoMm) options.resolution_mm = 2.0;
  options.recovery.reference_in_part_mm = Vector3d(-kReferenceAwayMm, 0.0, 0.0);
  return options;
}

bool IsTouching(const recon::VisualHull& hull, const core::TriangleTree& part,
                const core::RigidTransform& world_from_part, double resolution_mm) {
  review::ContactOptions options;
  options.resolution_mm = resolution_mm;
  return !review::FindContacts(hull, part, world_from_part, 0, options).points.empty();
}

// The curtain in front of `center`, coming along its x axis, `depth_mm` farther than where it first touches.
core::RigidTransform Pushed(const recon::VisualHull& hull, const core::TriangleTree& part,
                            const Eigen::Matrix3d& world_from_part, const Vector3d& center, double depth_mm) {
  const auto at = [&](double x_mm) {
    return core::RigidTransform{world_from_part, center + x_mm * world_from_part.col(0)};
  };
  double clear_mm = -600.0, touching_mm = 0.0;
  // Roughly the first touch of all, then to a hundredth of a millimetre.
  constexpr double kRoughMm = 1.0;
  core::Require(IsTouching(hull, part, at(touching_mm), kRoughMm), "a curtain through the hand touches it");
  for (double x_mm = clear_mm; x_mm < touching_mm; x_mm += 5.0) {
    if (IsTouching(hull, part, at(x_mm), kRoughMm)) {
      touching_mm = x_mm;
      break;
    }
    clear_mm = x_mm;
  }
  while (touching_mm - clear_mm > 0.01) {
    const double middle_mm = 0.5 * (clear_mm + touching_mm);
    (IsTouching(hull, part, at(middle_mm), kTruthMm) ? touching_mm : clear_mm) = middle_mm;
  }
  return at(touching_mm + depth_mm);
}

std::vector<Vector3d> PositionsOf(const recon::SampledContacts& sampled) {
  std::vector<Vector3d> positions;
  for (const recon::ViewportContact& contact : sampled.contacts)
    positions.push_back(contact.position_in_world_mm);
  return positions;
}

core::TriangleTree CurtainTree() {
  return core::TriangleTree(std::make_shared<const core::TriangleMesh>(Curtain()));
}

// A point of the demo's hand, between palm and fingertips.
const Vector3d kHandMm(140.0, 10.0, 200.0);

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

core::TriangleMesh Curtain() {
  constexpr int kAcross = 18, kUp = 20;
  constexpr double kCellMm = 20.0;
  core::TriangleMesh mesh;
  for (int j = 0; j <= kUp; ++j)
    for (int i = 0; i <= kAcross; ++i)
      mesh.vertices_mm.emplace_back(0.0, kCellMm * (i - 0.5 * kAcross), kCellMm * (j - 0.5 * kUp));
  for (int j = 0; j < kUp; ++j) {
    for (int i = 0; i < kAcross; ++i) {
      const int a = j * (kAcross + 1) + i, b = a + 1, c = a + kAcross + 1, d = c + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({b, d, c});
    }
  }
  return mesh;
}

std::vector<CollisionCost> TimeCollisions(recon::ViewSceneRig rig, const TimingEffort& effort) {
  constexpr double kThroughMm = 10.0;
  const recon::ViewScene scene = recon::MakeViewScene(rig);
  const Sight sight = SightOf(scene.rig, scene.objects);
  const core::TriangleTree part = CurtainTree();
  const core::RigidTransform world_from_part =
      Pushed(sight.hull, part, Eigen::Matrix3d::Identity(), kHandMm, kThroughMm);
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

std::vector<SmallContacts> CountMissed(recon::ViewSceneRig rig, int trials, std::uint64_t seed) {
  constexpr double kMostPushedMm = 1.5, kAsideMm = 60.0;
  const recon::ViewScene scene = recon::MakeViewScene(rig);
  const Sight sight = SightOf(scene.rig, scene.objects);
  const core::TriangleTree part = CurtainTree();
  recon::gl::TriangleViewportsGl gl;
  recon::Random random(seed);
  std::vector<SmallContacts> sizes;
  for (const auto& [from_mm, to_mm] : {std::pair{0.0, 1.0}, {1.0, 2.0}, {2.0, 3.0}, {3.0, 5.0}, {5.0, 1e9}})
    sizes.push_back({from_mm, to_mm, 0, std::vector<int>(std::size(kCollisionMethods), 0)});
  for (int trial = 0; trial < trials; ++trial) {
    const core::RigidTransform world_from_part =
        Pushed(sight.hull, part, random.Rotation(), kHandMm, random.Uniform(0.0, kMostPushedMm));
    // Not always the same place of the curtain: turned about its axis above, moved along its plane here.
    const Vector3d aside = world_from_part.rotation * Vector3d(0.0, random.Uniform(-kAsideMm, kAsideMm),
                                                               random.Uniform(-kAsideMm, kAsideMm));
    const core::RigidTransform moved{world_from_part.rotation, world_from_part.translation_mm + aside};
    review::ContactOptions fine;
    fine.resolution_mm = kTruthMm;
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
