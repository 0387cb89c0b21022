// The stated error of skew against hulls of the same moving object that are seen at one instant.
#include "recon/error_budget/skew_errors.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/error_budget.h"
#include "core/spread.h"
#include "recon/error_budget/motion_history.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/actors.h"
#include "recon/synthetic/solids.h"
#include "review/clearance.h"
#include "tests/core/solids.h"
#include "tests/oracles/coverage_mask.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;
const Vector3d kSkin = Vector3d::Constant(180.0);
constexpr double kPartMm = 10.0;
constexpr double kRequiredMm = 10.0;
constexpr double kDistanceToleranceMm = 0.1;

// `count` cameras of 160 x 120 around the origin, 870 to 970 mm away: a pixel is 6 mm wide there.
std::shared_ptr<const core::Rig> RigOf(int count) {
  core::Rig rig;
  rig.workspace_mm = {Vector3d::Constant(-300.0), Vector3d::Constant(300.0)};
  for (int i = 0; i < count; ++i) {
    core::CameraCalibration camera;
    camera.name = "cam" + std::to_string(i + 1);
    camera.image_width_px = 160;
    camera.image_height_px = 120;
    const double focal_px = 150.0 + 5.0 * i;
    camera.camera_matrix << focal_px, 0.0, 79.0, 0.0, 1.002 * focal_px, 60.5, 0.0, 0.0, 1.0;
    const double around = 2.0 * std::numbers::pi * i / count + 0.2;
    const Vector3d eye(800.0 * std::cos(around), 800.0 * std::sin(around), i % 2 == 0 ? 350.0 : 550.0);
    camera.cam_from_world = core::CamFromWorldLookingAt(eye, Vector3d::Zero());
    rig.cameras.emplace_back(camera);
  }
  return std::make_shared<const core::Rig>(std::move(rig));
}

struct Object {
  const char* title;
  std::vector<Solid> solids;  // at the frame's time
};

std::vector<Object> Objects() {
  const auto at = [](const Vector3d& x) { return core::RigidTransform{Eigen::Matrix3d::Identity(), x}; };
  const core::RigidTransform turned = core::FromPositionAndRollPitchYaw({10.0, -20.0, 5.0}, {0.3, 0.5, 0.2});
  std::vector<Object> objects = {
      {"ball, 60 mm", {{Sphere{30.0}, at({5.0, 10.0, -15.0}), kSkin}}},
      {"rod, 24 mm", {CapsuleBetween({-60.0, -50.0, -30.0}, {70.0, 40.0, 60.0}, 12.0, kSkin)}},
      {"box", {{Box{{90.0, 50.0, 50.0}}, turned, kSkin}}},
  };
  // A hand and a second one across it, with fingers beside fingers.
  const SyntheticObject hand =
      Hand(core::FromPositionAndRollPitchYaw({-80.0, -30.0, 0.0}, {}), OpenHand(), {-300.0, -30.0, 60.0});
  const SyntheticObject other = Hand(core::FromPositionAndRollPitchYaw({60.0, 60.0, 45.0}, {0.0, 0.0, -2.4}),
                                     TongsPinch(), {250.0, 200.0, 90.0});
  objects.push_back({"hand", hand.solids});
  objects.push_back({"crowded hands", hand.solids});
  std::ranges::copy(other.solids, std::back_inserter(objects.back().solids));
  return objects;
}

// Where the object is, from where it is at the frame's time 0.
using Path = std::function<Vector3d(double time_s)>;

std::vector<Solid> Moved(std::vector<Solid> solids, const Vector3d& by_mm) {
  for (Solid& solid : solids) solid.world_from_solid.translation_mm += by_mm;
  return solids;
}

// What each camera sees at its own instant.
VisualHull HullAt(const std::shared_ptr<const core::Rig>& rig, const UndistortedPlanes& planes,
                  const Object& object, const Path& path, const std::vector<double>& at_s) {
  std::vector<core::SoftMask> masks(at_s.size());
  tbb::parallel_for(std::size_t{0}, at_s.size(), [&](std::size_t i) {
    masks[i] = oracles::CoverageMask(rig->cameras[i], Moved(object.solids, path(at_s[i])), 2.0);
  });
  return MakeVisualHull(rig, planes, masks);
}

double DistanceFrom(const std::vector<Solid>& solids, const Vector3d& x) {
  double nearest_mm = 1e9;
  for (const Solid& solid : solids) nearest_mm = std::min(nearest_mm, SignedDistanceMm(solid, x));
  return nearest_mm;
}

// The middle of a cube that is about `gap_mm` away from the object in a direction.
Vector3d PartBeside(const Object& object, const Vector3d& direction, double gap_mm) {
  Vector3d x = object.solids[object.solids.size() / 2].world_from_solid.translation_mm;
  const double wanted_mm = gap_mm + 0.5 * std::sqrt(3.0) * kPartMm;
  for (int i = 0; i < 200 && DistanceFrom(object.solids, x) < wanted_mm; ++i) x += direction;
  return x;
}

core::TriangleTree CubeAt(const Vector3d& x) {
  const Vector3d size_mm = Vector3d::Constant(kPartMm);
  return core::TriangleTree(std::make_shared<const core::TriangleMesh>(
      core::Transformed(core::testing::Box(size_mm), {Eigen::Matrix3d::Identity(), x - 0.5 * size_mm})));
}

review::Clearance SearchedDistance(const VisualHull& hull, const core::TriangleTree& part) {
  review::ClearanceOptions options;
  options.tolerance_mm = kDistanceToleranceMm;
  return review::FindClearance(hull, part, {}, options);
}

std::vector<std::optional<core::CameraStamp>> StampsAt(const std::vector<double>& at_s) {
  std::vector<std::optional<core::CameraStamp>> stamps;
  for (const double s : at_s) stamps.emplace_back(core::CameraStamp{0, s});
  return stamps;
}

struct Trial {
  double error_mm = 0.0;
  double stated_mm = 0.0;
  bool is_judged = false;  // both hulls have a nearest point
  bool is_clear = false;   // by the first order and by StaysFarther
  bool is_clear_to_first_order = false;
  bool is_truly_clear = false;
};

// Cameras look within `skew_s` of each other around the frame's time, and did so one and two periods before.
Trial Try(const std::shared_ptr<const core::Rig>& rig, const UndistortedPlanes& planes, const Object& object,
          const Path& path, double skew_s, double period_s, Random* random) {
  std::vector<double> now_s, before_s, first_s;
  for (std::size_t i = 0; i < rig->cameras.size(); ++i) {
    now_s.push_back(random->Uniform(-0.5 * skew_s, 0.5 * skew_s));
    before_s.push_back(now_s.back() - period_s);
    first_s.push_back(before_s.back() - period_s);
  }
  const core::TriangleTree part = CubeAt(PartBeside(object, random->Direction(), random->Uniform(2.0, 60.0)));
  const VisualHull first = HullAt(rig, planes, object, path, first_s);
  const VisualHull before = HullAt(rig, planes, object, path, before_s);
  const VisualHull seen = HullAt(rig, planes, object, path, now_s);
  const VisualHull at_once = HullAt(rig, planes, object, path, std::vector<double>(now_s.size(), 0.0));
  MotionHistory history;
  (void)history.Next(first, StampsAt(first_s), -2.0 * period_s);
  (void)history.Next(before, StampsAt(before_s), -period_s);
  const auto errors = history.Next(seen, StampsAt(now_s), 0.0);
  const review::Clearance found = SearchedDistance(seen, part), truth = SearchedDistance(at_once, part);
  Trial trial;
  trial.is_truly_clear = truth.interval.upper_mm >= kRequiredMm;
  trial.stated_mm = found.has_witnesses && !found.meets
                        ? errors->AtMm(seen, found.interval.witness_hull_in_world_mm,
                                       found.interval.witness_part_in_world_mm)
                        : 0.0;
  trial.is_clear_to_first_order =
      !found.meets && found.interval.lower_mm - core::kCoverageFactor * trial.stated_mm >= kRequiredMm;
  trial.is_clear = trial.is_clear_to_first_order &&
                   errors->StaysFarther(seen, part, {}, kRequiredMm, kDistanceToleranceMm);
  trial.is_judged = found.has_witnesses && !found.meets && truth.has_witnesses && !truth.meets;
  trial.error_mm = std::abs(found.interval.upper_mm - truth.interval.upper_mm);
  return trial;
}

struct Tally {
  int trials = 0, judged = 0, within_1 = 0, within_2 = 0, clear = 0, false_clear = 0,
      false_to_first_order = 0, truly_clear = 0;
  std::vector<double> errors_mm, stated_mm;

  void Add(const Trial& trial) {
    ++trials;
    truly_clear += trial.is_truly_clear ? 1 : 0;
    clear += trial.is_clear ? 1 : 0;
    false_clear += trial.is_clear && !trial.is_truly_clear ? 1 : 0;
    false_to_first_order += trial.is_clear_to_first_order && !trial.is_truly_clear ? 1 : 0;
    if (!trial.is_judged) return;
    ++judged;
    // Two searches, each to its tolerance.
    const double rest_mm = trial.error_mm - 2.0 * kDistanceToleranceMm;
    within_1 += rest_mm <= trial.stated_mm ? 1 : 0;
    within_2 += rest_mm <= 2.0 * trial.stated_mm ? 1 : 0;
    errors_mm.push_back(trial.error_mm);
    stated_mm.push_back(trial.stated_mm);
  }

  void Print(const std::string& title) const {
    const auto error_mm = core::SpreadOf(errors_mm), stated = core::SpreadOf(stated_mm);
    if (!error_mm) return;
    std::printf(
        "%-26s %4d of %4d judged, within 1 sigma %5.1f %%, 2 sigma %5.1f %%; error median %5.2f p95 %6.2f "
        "worst %6.2f mm; stated median %5.2f p95 %6.2f mm; clear %d of %d, false %d (%d without margins)\n",
        title.c_str(), judged, trials, 100.0 * within_1 / judged, 100.0 * within_2 / judged, error_mm->median,
        error_mm->p95, error_mm->max, stated->median, stated->p95, clear, truly_clear, false_clear,
        false_to_first_order);
  }
};

constexpr std::array kSpeedsMmPerS = {100.0, 300.0, 600.0, 1000.0};
constexpr std::array kSkewsS = {0.010, 0.023, 0.046};

// Free-running cameras are half a period from a set's time at most.
double PeriodOf(double skew_s) { return std::max(skew_s, 1.0 / 30.0); }

// At this velocity at the frame's time.
Path Straight(const Vector3d& velocity_mm_per_s) {
  return [=](double time_s) -> Vector3d { return velocity_mm_per_s * time_s; };
}
// The same, but at rest until a period before, and evenly accelerated since: the hardest case, as the
// contours moved half as far as they now would.
Path FromRest(const Vector3d& velocity_mm_per_s, double period_s) {
  return [=](double time_s) -> Vector3d {
    const double since_s = std::max(time_s + period_s, 0.0);
    return velocity_mm_per_s * (0.5 * since_s * since_s / period_s - 0.5 * period_s);
  };
}

TEST(SkewErrors, AreThoseOfMovingObjects) {
  const int draws = 2 * test_support::SoakScale();
  Random random(9001);
  const std::vector<Object> objects = Objects();
  std::vector<Tally> by_speed(kSpeedsMmPerS.size()), by_skew(kSkewsS.size()), by_object(objects.size());
  Tally all, straight, from_rest;
  for (const int cameras : {3, 4, 8}) {
    const auto rig = RigOf(cameras);
    const UndistortedPlanes planes = MakeUndistortedPlanes(*rig);
    Tally by_rig;
    for (std::size_t o = 0; o < objects.size(); ++o) {
      for (int draw = 0; draw < draws; ++draw) {
        const auto v = static_cast<std::size_t>(random.Whole(0, static_cast<int>(kSpeedsMmPerS.size()) - 1));
        const auto s = static_cast<std::size_t>(random.Whole(0, static_cast<int>(kSkewsS.size()) - 1));
        const Vector3d velocity = kSpeedsMmPerS[v] * random.Direction();
        const double period_s = PeriodOf(kSkewsS[s]);
        const bool is_straight = draw % 2 == 0;
        const Path path = is_straight ? Straight(velocity) : FromRest(velocity, period_s);
        const Trial trial = Try(rig, planes, objects[o], path, kSkewsS[s], period_s, &random);
        Tally& by_path = is_straight ? straight : from_rest;
        for (Tally* tally : {&all, &by_speed[v], &by_skew[s], &by_object[o], &by_rig, &by_path})
          tally->Add(trial);
      }
    }
    by_rig.Print(std::to_string(cameras) + " cameras");
  }
  for (std::size_t i = 0; i < by_object.size(); ++i) by_object[i].Print(objects[i].title);
  for (std::size_t i = 0; i < by_speed.size(); ++i)
    by_speed[i].Print(std::to_string(static_cast<int>(kSpeedsMmPerS[i])) + " mm/s");
  for (std::size_t i = 0; i < by_skew.size(); ++i)
    by_skew[i].Print(std::to_string(static_cast<int>(1e3 * kSkewsS[i])) + " ms");
  straight.Print("even speed");
  from_rest.Print("from rest");
  all.Print("all");
  EXPECT_EQ(all.false_clear, 0);
  EXPECT_GT(all.clear, 0);
  EXPECT_GE(all.within_1, 0.68 * all.judged);
  EXPECT_GE(all.within_2, 0.95 * all.judged);
}

// Three frames of one object along a path; camera i looks offsets_s[i] from the frames' times.
struct ThreeFrames {
  ThreeFrames(const std::shared_ptr<const core::Rig>& rig, const Object& object, const Path& path,
              const std::vector<double>& offsets_s)
      : planes(MakeUndistortedPlanes(*rig)), offsets(offsets_s) {
    const auto at = [&](double frame_s) {
      std::vector<double> at_s = offsets_s;
      for (double& s : at_s) s += frame_s;
      return at_s;
    };
    earlier.emplace(HullAt(rig, planes, object, path, at(-2.0 * kPeriodS)));
    before.emplace(HullAt(rig, planes, object, path, at(-kPeriodS)));
    now.emplace(HullAt(rig, planes, object, path, at(0.0)));
    first = history.Next(*earlier, StampsAt(at(-2.0 * kPeriodS)), -2.0 * kPeriodS);
    (void)history.Next(*before, StampsAt(at(-kPeriodS)), -kPeriodS);
    third = history.Next(*now, StampsAt(at(0.0)), 0.0);
  }

  static constexpr double kPeriodS = 1.0 / 30.0;
  UndistortedPlanes planes;
  std::vector<double> offsets;
  std::optional<VisualHull> earlier, before, now;
  MotionHistory history;
  std::shared_ptr<const SkewErrors> first, third;
};

const std::vector<double> kOffsetsS = {-0.016, 0.0, 0.016};

TEST(SkewErrors, TheHullOfAThinRodThatMovesFastIsLostAndNothingNearItIsClear) {
  const auto rig = RigOf(3);
  const Object rod{"rod, 10 mm", {CapsuleBetween({0.0, 0.0, -60.0}, {0.0, 0.0, 60.0}, 5.0, kSkin)}};
  const Vector3d velocity(600.0, 800.0, 0.0);
  const ThreeFrames frames(rig, rod, Straight(velocity), kOffsetsS);
  const core::TriangleTree near = CubeAt({0.0, 15.0, 0.0}), far = CubeAt({0.0, 0.0, 280.0});
  const review::Clearance seen = SearchedDistance(*frames.now, near);
  ASSERT_GT(seen.interval.lower_mm, 10.0) << "the hull holds nothing where the rod is";
  EXPECT_FALSE(frames.third->StaysFarther(*frames.now, near, {}, kRequiredMm, kDistanceToleranceMm));
  EXPECT_TRUE(frames.third->StaysFarther(*frames.now, far, {}, kRequiredMm, kDistanceToleranceMm));
}

TEST(SkewErrors, AreZeroWhereNothingMovesOrAllLookAtTheFramesTime) {
  const auto rig = RigOf(3);
  const Object ball = Objects()[0];
  const Vector3d on_hull(5.0, 10.0, 15.0), part(5.0, 10.0, 60.0);
  const ThreeFrames still(rig, ball, Straight(Vector3d::Zero()), kOffsetsS);
  EXPECT_FALSE(still.first->is_still()) << "the first frame shows no speed";
  EXPECT_LT(still.third->AtMm(*still.now, on_hull, part), 1e-6);
  const ThreeFrames together(rig, ball, Straight({800.0, 0.0, 0.0}), {0.0, 0.0, 0.0});
  EXPECT_TRUE(together.third->is_still());
  EXPECT_EQ(together.third->AtMm(*together.now, on_hull, part), 0.0);
  EXPECT_EQ(together.third->WorstInMm(*together.now, {on_hull, 100.0}), 0.0);
  MotionHistory none;
  EXPECT_EQ(none.Next(*still.now, {}, 0.0), nullptr);
}

TEST(SkewErrors, OfTheFirstFrameAndOfWhatAppearsAreThoseOfTheFastestHand) {
  const auto rig = RigOf(3);
  const Object ball = Objects()[0];
  const ThreeFrames still(rig, ball, Straight(Vector3d::Zero()), kOffsetsS);
  EXPECT_DOUBLE_EQ(still.first->WorstInMm(*still.earlier, {Vector3d::Zero(), 1.0}), kFastestMmPerS * 0.016);
  // It comes into the pictures from far outside of them.
  const Path appears = [](double time_s) -> Vector3d {
    return time_s < -0.025 ? Vector3d(0.0, 0.0, 5000.0) : Vector3d(Vector3d::Zero());
  };
  const ThreeFrames appeared(rig, ball, appears, kOffsetsS);
  EXPECT_DOUBLE_EQ(appeared.third->WorstInMm(*appeared.now, {Vector3d::Zero(), 50.0}),
                   kFastestMmPerS * 0.016);
}

// Camera 1 looks along the motion: its own contour hardly moves, those of the others do.
TEST(SkewErrors, OfAMotionAlongTheLineOfSightAreThoseOfTheOtherCameras) {
  const auto rig = RigOf(4);
  const Object ball{"ball", {{Sphere{30.0}, {}, kSkin}}};
  const Vector3d towards = rig->cameras[0].center_in_world().normalized();
  const ThreeFrames frames(rig, ball, Straight(600.0 * towards), {0.016, 0.0, 0.0, 0.0});
  // Only camera 1 looks at another instant, so that only its cone may be off.
  EXPECT_LT(frames.third->WorstInMm(*frames.now, {Vector3d::Zero(), 100.0}), 0.25 * 600.0 * 0.016 + 1.5);
  const ThreeFrames across(rig, ball, Straight(600.0 * towards.cross(Vector3d::UnitZ()).normalized()),
                           {0.016, 0.0, 0.0, 0.0});
  EXPECT_GT(across.third->WorstInMm(*across.now, {Vector3d::Zero(), 100.0}), 0.9 * 600.0 * 0.016);
}

TEST(MotionHistory, ASamePictureKeepsItsMotionAndAPauseForgetsIt) {
  const auto rig = RigOf(3);
  const Object ball = Objects()[0];
  ThreeFrames frames(rig, ball, Straight({600.0, 0.0, 0.0}), kOffsetsS);
  const Vector3d at(5.0, 10.0, -15.0);
  const double moving_mm = frames.third->WorstInMm(*frames.now, {at, 50.0});
  ASSERT_GT(moving_mm, 0.0);
  const auto again = frames.history.Next(*frames.now, StampsAt(kOffsetsS), 0.0);
  EXPECT_DOUBLE_EQ(again->WorstInMm(*frames.now, {at, 50.0}), moving_mm);
  // A missing camera has no say, and its next picture is compared with its last.
  std::vector<std::optional<core::CameraStamp>> stamps = StampsAt({0.02, 0.03, 0.04});
  stamps[2].reset();
  const auto lacking = frames.history.Next(*frames.now, stamps, 0.03);
  EXPECT_TRUE(lacking->is_still()) << "the silhouettes of the others are the same as before";
  const auto paused = frames.history.Next(*frames.before, StampsAt({1.02, 1.03, 1.04}), 1.03);
  EXPECT_NEAR(paused->WorstInMm(*frames.before, {at, 1.0}), kFastestMmPerS * 0.01, 1e-9);
  EXPECT_THROW((void)frames.history.Next(*frames.now, StampsAt({0.0}), 2.0), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
