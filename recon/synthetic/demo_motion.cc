#include "recon/synthetic/demo_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "recon/synthetic/actors.h"

namespace elbowroom::recon {
namespace {

using core::RadiansFromDegrees;
using core::RigidTransform;
using Eigen::AngleAxisd;
using Eigen::Vector3d;

// The script, in seconds from the task's begin.
constexpr double kPipeArrivesS = 3.8;
constexpr double kLowerBeginsS = 4.2;
constexpr double kLowerEndsS = 5.8;
constexpr double kReleaseBeginsS = 6.1;
constexpr double kReleaseEndsS = 6.6;
constexpr double kHandGoneS = 8.2;
constexpr double kFeedBeginsS = 10.2;
constexpr double kFeedEndsS = 14.2;
constexpr int kStrokes = 4;

// Heights of the pipe's lower end and of the tongs' tips.
constexpr double kPipeOverReceptacleZMm = 133.0;
constexpr double kStrokeMm = 42.0;
constexpr double kTipsLowZMm = kPipeStandsAtZMm + kPipeLengthMm - 4.0;
constexpr double kTipsHighZMm = kTipsLowZMm + kStrokeMm;
constexpr double kPlugBelowTipsMm = kTipsLowZMm - kPlugEndsAtZMm - (kStrokes - 1) * kStrokeMm;

// In the wrist frame: a point of the pinched pipe's axis 45 mm below its upper end is (kPipeXMm, 0, kPipeTopZ
// - 45).
constexpr double kPipeInWristXMm = 79.0;
constexpr double kPipeTopInWristZMm = -44.0;
const Vector3d kTongsGripInWrist(86.0, 29.0, -82.0);
constexpr double kTongsGripFromTipsMm = 135.0;
constexpr double kTongsElevationDeg = 30.0;
constexpr double kTongsClosedDeg = 4.0;
constexpr double kTongsOpenDeg = 11.0;

// 0 before `begin_s`, 1 after `end_s`, with continuous speed and acceleration between.
double Ease(double time_s, double begin_s, double end_s) {
  const double t = std::clamp((time_s - begin_s) / (end_s - begin_s), 0.0, 1.0);
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

// Wrist axes in the world: fingers towards `fingers`, thumb's side towards `thumb` (perpendicular, unit).
Eigen::Matrix3d WristAxes(const Vector3d& fingers, const Vector3d& thumb) {
  Eigen::Matrix3d world_from_wrist;
  world_from_wrist << fingers, thumb, fingers.cross(thumb);
  return world_from_wrist;
}

Vector3d ElbowBehind(const Vector3d& wrist_in_world, double drop_mm) {
  return wrist_in_world + Vector3d(380.0, 40.0, -drop_mm);
}

// --- the pipe ---

RigidTransform WorldFromPipe(double time_s) {
  const double arrive = Ease(time_s, 0.0, kPipeArrivesS);
  const double stand_up = Ease(time_s, 1.6, kPipeArrivesS);
  const double lower = Ease(time_s, kLowerBeginsS, kLowerEndsS);
  const double tilt_rad = RadiansFromDegrees(50.0) * (1.0 - stand_up);
  const double z_mm = kPipeOverReceptacleZMm + kPipeRadiusMm * std::sin(tilt_rad) -
                      lower * (kPipeOverReceptacleZMm - kPipeStandsAtZMm);
  // The pipe leans towards the hand, so that the forearm comes from below.
  return {AngleAxisd(tilt_rad, Vector3d::UnitY()).toRotationMatrix(),
          {(1.0 - arrive) * 520.0, (1.0 - arrive) * -60.0, z_mm}};
}

SyntheticObject HandAtPipe(double time_s) {
  const RigidTransform world_from_pipe = WorldFromPipe(time_s);
  const Eigen::Matrix3d pipe_from_wrist = WristAxes(-Vector3d::UnitX(), -Vector3d::UnitY());
  const Vector3d wrist_in_pipe = Vector3d(0.0, 0.0, kPipeLengthMm) -
                                 pipe_from_wrist * Vector3d(kPipeInWristXMm, 0.0, kPipeTopInWristZMm);
  RigidTransform world_from_wrist = world_from_pipe * RigidTransform{pipe_from_wrist, wrist_in_pipe};
  // The hand first moves up off the pipe, then away.
  world_from_wrist.translation_mm += Ease(time_s, kReleaseBeginsS + 0.2, 7.1) * Vector3d(0.0, 0.0, 52.0) +
                                     Ease(time_s, 6.9, kHandGoneS) * Vector3d(680.0, 0.0, -60.0);
  const double open = Ease(time_s, kReleaseBeginsS, kReleaseEndsS);
  return Hand(world_from_wrist, Blend(PipePinch(), OpenHand(), 0.5 * open),
              ElbowBehind(world_from_wrist.translation_mm, 140.0));
}

// --- the cable ---

struct Feed {
  Vector3d tips_in_world;
  Vector3d plug_front_in_world;
  double opening_rad = 0.0;
};

// How far the plug has been pushed and how high the tips are, stroke by stroke: push, open, lift, close.
Feed FeedAt(double time_s) {
  constexpr double kStrokeS = (kFeedEndsS - kFeedBeginsS) / kStrokes;
  double pushed_mm = 0.0;
  double lifted = 1.0;
  double open = 0.0;
  for (int stroke = 0; stroke < kStrokes; ++stroke) {
    const double begin_s = kFeedBeginsS + stroke * kStrokeS;
    const double push = Ease(time_s, begin_s, begin_s + 0.5 * kStrokeS);
    pushed_mm += push * kStrokeMm;
    lifted -= push;
    open += Ease(time_s, begin_s + 0.5 * kStrokeS, begin_s + 0.6 * kStrokeS);
    if (stroke + 1 == kStrokes) break;  // after the last one the tongs stay low and open
    lifted += Ease(time_s, begin_s + 0.6 * kStrokeS, begin_s + 0.9 * kStrokeS);
    open -= Ease(time_s, begin_s + 0.9 * kStrokeS, begin_s + kStrokeS);
  }
  const double arrive = Ease(time_s, kHandGoneS, kFeedBeginsS);
  const Vector3d held(640.0 * (1.0 - arrive), 30.0 * (1.0 - arrive), kTipsLowZMm + lifted * kStrokeMm);
  const double leave = Ease(time_s, kFeedEndsS, kTaskSeconds);
  const Vector3d gone(620.0 * leave, 20.0 * leave, 40.0 * Ease(time_s, kFeedEndsS, kFeedEndsS + 0.5));
  return {held + gone,
          {held.x(), held.y(), kTipsHighZMm - kPlugBelowTipsMm - pushed_mm},
          RadiansFromDegrees(kTongsClosedDeg + open * (kTongsOpenDeg - kTongsClosedDeg))};
}

// From the plug up to the tips or the pipe's mouth, over, and down to the table beside the boxes.
SyntheticObject CableAt(const Feed& feed, double time_s) {
  const double fed = Ease(time_s, kFeedBeginsS, kFeedEndsS);
  const Vector3d mouth(feed.plug_front_in_world.x(), feed.plug_front_in_world.y(),
                       std::max(feed.plug_front_in_world.z() + kPlugLengthMm + 20.0, kTipsHighZMm - 24.0));
  const double slack_mm = 45.0 * (1.0 - fed);
  const Vector3d on_table(60.0, -345.0, kCableRadiusMm);
  const std::array<Vector3d, 6> through{mouth,
                                        mouth + Vector3d(4.0, -60.0, 18.0),
                                        mouth + Vector3d(12.0, -155.0 - 0.3 * slack_mm, -8.0),
                                        Vector3d(0.5 * mouth.x() + 40.0, -250.0 - 0.5 * slack_mm, 110.0),
                                        on_table,
                                        on_table + Vector3d(110.0, -45.0, 0.0)};
  return Cable(feed.plug_front_in_world, through);
}

SyntheticObject TongsAt(const Feed& feed) {
  const double elevation_rad = RadiansFromDegrees(kTongsElevationDeg);
  const Vector3d up_the_tongs(std::cos(elevation_rad), 0.0, std::sin(elevation_rad));
  const Vector3d side = Vector3d::UnitY();
  Eigen::Matrix3d rotation;
  rotation << side.cross(up_the_tongs), side, up_the_tongs;
  return Tongs({rotation, feed.tips_in_world}, feed.opening_rad);
}

SyntheticObject HandAtTongs(const Feed& feed) {
  const double elevation_rad = RadiansFromDegrees(kTongsElevationDeg);
  const Vector3d grip_in_world =
      feed.tips_in_world +
      kTongsGripFromTipsMm * Vector3d(std::cos(elevation_rad), 0.0, std::sin(elevation_rad));
  const Eigen::Matrix3d axes = WristAxes(-Vector3d::UnitX(), Vector3d::UnitZ());
  const RigidTransform world_from_wrist{axes, grip_in_world - axes * kTongsGripInWrist};
  return Hand(world_from_wrist, TongsPinch(), ElbowBehind(world_from_wrist.translation_mm, 110.0));
}

DemoPhase PhaseAt(double time_s) {
  if (time_s < kLowerBeginsS) return DemoPhase::kBringPipe;
  if (time_s < kReleaseBeginsS) return DemoPhase::kLowerPipe;
  if (time_s < kHandGoneS) return DemoPhase::kLeavePipe;
  if (time_s < kFeedBeginsS) return DemoPhase::kBringCable;
  return time_s < kFeedEndsS ? DemoPhase::kFeedCable : DemoPhase::kLeaveCable;
}

}  // namespace

std::string_view ToString(DemoPhase phase) {
  switch (phase) {
    case DemoPhase::kBringPipe:
      return "bring the pipe";
    case DemoPhase::kLowerPipe:
      return "lower the pipe";
    case DemoPhase::kLeavePipe:
      return "leave the pipe";
    case DemoPhase::kBringCable:
      return "bring the cable";
    case DemoPhase::kFeedCable:
      return "feed the cable";
    case DemoPhase::kLeaveCable:
      return "leave the cable";
  }
  return "unknown";
}

DemoScene DemoSceneAt(double time_s) {
  core::Require(time_s >= 0.0, "a demo's time is not negative");
  const double task_time_s = std::fmod(time_s, kTaskSeconds);
  DemoScene scene;
  scene.phase = PhaseAt(task_time_s);
  scene.objects.push_back(Pipe(WorldFromPipe(task_time_s)));
  scene.tongs_in_use = task_time_s >= kHandGoneS;
  if (!scene.tongs_in_use) {
    scene.objects.push_back(HandAtPipe(task_time_s));
    return scene;
  }
  const Feed feed = FeedAt(task_time_s);
  scene.objects.push_back(HandAtTongs(feed));
  scene.objects.push_back(TongsAt(feed));
  scene.objects.push_back(CableAt(feed, task_time_s));
  return scene;
}

}  // namespace elbowroom::recon
