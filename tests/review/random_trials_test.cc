// Contacts and clearance of random hulls, parts and poses, each answer held to a hull that is projected in
// long double and read straight from the masks: nothing missed beyond the resolution, nothing found that
// isn't there, no bound violated. `./dev soak` asks two million times.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/part_distance.h"
#include "recon/hull/visual_hull.h"
#include "review/clearance.h"
#include "review/contacts.h"
#include "review/inside_cells.h"
#include "tests/oracles/mask_hull_oracle.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/random_parts.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::Random;

constexpr int kTrialsPerHull = 250, kPosesPerPart = 25;
constexpr int kHulls = 16, kHullsOfSoak = 400;  // the latter times the soak's scale: 2,000,000 trials at 20
constexpr double kRoundingMm = 1e-6;
// The oracle's boundaries are straight in the picture, the hull's in the plane without a lens.
constexpr double kBandPx = 0.02;
constexpr double kReachMm = 130.0;

// What went wrong, from many threads.
class Faults {
 public:
  void Add(std::string fault) {
    const std::lock_guard lock(mutex_);
    constexpr std::size_t kMost = 10;
    if (faults_.size() < kMost) faults_.push_back(std::move(fault));
  }
  [[nodiscard]] std::string Text() const { return fmt::format("{}", fmt::join(faults_, "\n")); }

 private:
  std::mutex mutex_;
  std::vector<std::string> faults_;
};

struct Counts {
  std::atomic<int> trials = 0, touching = 0, contained = 0, apart = 0;
};

// One hull, its oracle, and some of its points.
struct Ground {
  recon::VisualHull hull;
  oracles::MaskHullOracle oracle;
  std::vector<Vector3d> hull_points;

  [[nodiscard]] bool IsSurelyIn(const Vector3d& x) const {
    return oracle.Contains(x.cast<long double>(), -kBandPx);
  }
  [[nodiscard]] bool MayBeIn(const Vector3d& x) const {
    return oracle.Contains(x.cast<long double>(), kBandPx);
  }
};

Ground MakeGround(Random* random) {
  const auto unseen = random->Chance(0.3) ? core::UnseenPolicy::kAbstain : core::UnseenPolicy::kOutside;
  const recon::RandomScene scene = MakeRingScene(random, random->Whole(2, 5), unseen);
  std::vector<core::SoftMask> masks;
  for (const core::BitMask& mask : scene.masks)
    masks.push_back(random->Chance(0.5) ? RandomLevels(random, mask) : core::SoftMask{mask, {}});
  Ground ground{recon::MakeVisualHull(scene.rig, masks),
                oracles::MaskHullOracle(*scene.rig, masks, oracles::BoundaryConvention::kMarchingSquares),
                {}};
  constexpr int kLooked = 4000, kWanted = 60;
  const Eigen::AlignedBox3d around(Vector3d::Constant(-kReachMm), Vector3d::Constant(kReachMm));
  for (int i = 0; i < kLooked && ground.hull_points.size() < kWanted; ++i) {
    const Vector3d x = random->PointIn(around);
    if (ground.IsSurelyIn(x)) ground.hull_points.push_back(x);
  }
  return ground;
}

// One part in one pose before one hull.
class Trial {
 public:
  Trial(const Ground& ground, const core::TriangleTree& part, const core::RigidTransform& world_from_part,
        Random* random, Counts* counts, Faults* faults)
      : ground_(ground),
        part_(part),
        world_from_part_(world_from_part),
        part_from_world_(world_from_part.Inverse()),
        random_(*random),
        counts_(*counts),
        faults_(*faults),
        contact_(FindContacts(ground.hull, part, world_from_part, 0)) {}

  void Check() {
    ++counts_.trials;
    if (contact_.verdict == core::Verdict::kContact) return CheckContact();
    CheckNothingIsMissed();
    CheckClearance();
  }

 private:
  void Expect(bool holds, const char* what) {
    if (!holds) {
      faults_.Add(fmt::format("{}: {} triangles at {:.9g}, {:.9g}, {:.9g}; verdict {}", what,
                              part_.mesh().triangles.size(), world_from_part_.translation_mm.x(),
                              world_from_part_.translation_mm.y(), world_from_part_.translation_mm.z(),
                              core::ToString(contact_.verdict)));
    }
  }
  [[nodiscard]] double DistanceMm(const Vector3d& x_in_world) const {
    return FindNearest(part_, {.center = part_from_world_ * x_in_world}).distance_mm;
  }
  [[nodiscard]] bool IsEnclosed(const Vector3d& x_in_world) const {
    return part_.is_closed() && IsInsideClosedMesh(part_, part_from_world_ * x_in_world);
  }
  [[nodiscard]] Vector3d OnSurface() {
    const auto& mesh = part_.mesh();
    const auto& triangle = mesh.triangles[static_cast<std::size_t>(
        random_.Whole(0, static_cast<int>(mesh.triangles.size()) - 1))];
    const auto at = [&](std::size_t i) { return mesh.vertices_mm[static_cast<std::size_t>(triangle[i])]; };
    double u = random_.Uniform(0.0, 1.0), v = random_.Uniform(0.0, 1.0);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    return world_from_part_ * Vector3d(at(0) + u * (at(1) - at(0)) + v * (at(2) - at(0)));
  }

  void CheckContact() {
    ++counts_.touching;
    if (contact_.points.empty()) {
      ++counts_.contained;
      const bool has_point = contact_.contained_in_world_mm.has_value();
      Expect(has_point, "a contact shows a point");
      if (has_point) Expect(ground_.MayBeIn(*contact_.contained_in_world_mm), "a contained point is hull");
      if (has_point) Expect(IsEnclosed(*contact_.contained_in_world_mm), "a contained point is in the part");
      return;
    }
    constexpr int kAsked = 6;
    for (int i = 0; i < kAsked; ++i) {
      const auto last = static_cast<int>(contact_.points.size()) - 1;
      const core::ContactPoint& point = contact_.points[static_cast<std::size_t>(random_.Whole(0, last))];
      const Vector3d& x = point.position_in_world_mm;
      Expect(ground_.MayBeIn(x), "a contact point is in the hull");
      Expect(DistanceMm(x) <= kRoundingMm, "a contact point is on the part");
      Expect(ground_.MayBeIn(x + point.depth_mm * random_.Direction()), "all within a depth is hull");
    }
  }

  // Surface around which a ball of the resolution is hull is never missed, nor hull inside a closed part.
  void CheckNothingIsMissed() {
    constexpr int kAsked = 16;
    for (int i = 0; i < kAsked; ++i) {
      const Vector3d x = OnSurface();
      if (!ground_.IsSurelyIn(x)) continue;
      Expect(ground_.hull.Probe(x).radius_mm <= contact_.resolution_mm, "no contact is missed");
    }
    for (const Vector3d& x : ground_.hull_points) {
      if (!part_.bounds().contains(part_from_world_ * x) || !IsEnclosed(x)) continue;
      Expect(ground_.hull.Probe(x).radius_mm <= kContainmentCell * contact_.resolution_mm,
             "no hull in a part is missed");
    }
  }

  void CheckClearance() {
    ClearanceOptions options;
    options.tolerance_mm = random_.LogUniform(0.2, 10.0);
    const Clearance clearance = FindClearance(ground_.hull, part_, world_from_part_, options);
    const auto& [lower_mm, upper_mm, on_part, on_hull] = clearance.interval;
    Expect(lower_mm <= upper_mm, "bounds are in order");
    if (clearance.has_witnesses) {
      Expect(ground_.MayBeIn(on_hull), "a witness is hull");
      Expect(std::abs((on_hull - on_part).norm() - upper_mm) <= kRoundingMm,
             "witnesses show the upper bound");
      if (upper_mm > 0.0) Expect(DistanceMm(on_part) <= kRoundingMm, "a witness is on the part");
    }
    if (!(lower_mm > 0.0)) return;
    ++counts_.apart;
    for (const Vector3d& x : ground_.hull_points)
      Expect(DistanceMm(x) >= lower_mm - kRoundingMm, "no hull is nearer than the lower bound");
    constexpr int kAsked = 12;
    for (int i = 0; i < kAsked; ++i) {
      const double way_mm = std::min(lower_mm, 2.0 * kReachMm) * random_.Uniform(0.0, 0.999);
      Expect(!ground_.IsSurelyIn(OnSurface() + way_mm * random_.Direction()),
             "nothing within the lower bound");
    }
    // The nearest hull is where the witness is, if anywhere.
    for (int i = 0; clearance.has_witnesses && i < kAsked; ++i) {
      const Vector3d x = on_hull + random_.LogUniform(1e-3, 5.0) * random_.Direction();
      if (ground_.IsSurelyIn(x))
        Expect(DistanceMm(x) >= lower_mm - kRoundingMm, "no hull about the witness is nearer");
    }
  }

  const Ground& ground_;
  const core::TriangleTree& part_;
  const core::RigidTransform& world_from_part_;
  const core::RigidTransform part_from_world_;
  Random& random_;
  Counts& counts_;
  Faults& faults_;
  const core::PartContact contact_;
};

TEST(RandomTrials, NothingIsMissedNothingIsMadeUpNoBoundIsViolated) {
  const int scale = test_support::SoakScale();
  const int hulls = scale > 1 ? kHullsOfSoak * scale : kHulls;
  Counts counts;
  Faults faults;
  tbb::parallel_for(0, hulls, [&](int number) {
    Random random(static_cast<std::uint64_t>(number) * 7919 + 11);
    std::mt19937_64 of_parts(static_cast<std::uint64_t>(number) * 104729 + 5);
    const Ground ground = MakeGround(&random);
    for (int i = 0; i < kTrialsPerHull / kPosesPerPart; ++i) {
      const auto kind = static_cast<testing::PartKind>(i % testing::kPartKinds);
      // Some are larger than the hull: it may stand in them untouched.
      core::TriangleMesh mesh = testing::MakePart(kind, of_parts);
      const double scale_of_part =
          random.Chance(0.15) ? random.LogUniform(12.0, 80.0) : random.LogUniform(0.5, 12.0);
      for (Vector3d& vertex : mesh.vertices_mm) vertex *= scale_of_part;
      const core::TriangleTree part(std::make_shared<const core::TriangleMesh>(std::move(mesh)));
      for (int k = 0; k < kPosesPerPart; ++k) {
        const core::RigidTransform world_from_part = testing::AnyPose(of_parts, kReachMm);
        Trial(ground, part, world_from_part, &random, &counts, &faults).Check();
      }
    }
  });
  EXPECT_EQ(faults.Text(), "");
  EXPECT_EQ(counts.trials, hulls * kTrialsPerHull);
  EXPECT_GT(counts.touching, counts.trials / 20);
  EXPECT_GT(counts.contained, counts.trials / 400);
  EXPECT_GT(counts.apart, counts.trials / 4);
  RecordProperty("trials", counts.trials);
  RecordProperty("touching", counts.touching);
  RecordProperty("contained", counts.contained);
  RecordProperty("apart", counts.apart);
  fmt::print("{} trials: {} touching, {} of them by containment alone, {} apart\n", counts.trials.load(),
             counts.touching.load(), counts.contained.load(), counts.apart.load());
}

}  // namespace
}  // namespace elbowroom::review
