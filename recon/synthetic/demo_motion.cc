#include "recon/synthetic/demo_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "recon/synthetic/actors.h"
#include "recon/synthetic/ease.h"

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
constexpr double kHandGoneS = kCableBeginsS;
constexpr double kFeedBeginsS = 10.2;
constexpr double kFeedEndsS = 14.2;
constexpr double kFedMm = 168.0;  // how far the plug goes down, in all strokes

// Heights of the pipe's lower end and of the tongs' tips.
constexpr double kPipeOverReceptacleZMm = 133.0;
constexpr double kTipsLowZMm = kPipeStandsAtZMm + kPipeLengthMm - 4.0;
constexpr double kFingersOverTipsMm = 30.0;  // where the bare hand pinches the cable: over the pipe's mouth

// In the wrist frame: a point of the pinched pipe's axis 45 mm below its upper end is (kPipeXMm, 0, kPipeTopZ
// - 45).
constexpr double kPipeInWristXMm = 79.0;
constexpr double kPipeTopInWristZMm = -44.0;
const Vector3d kTongsGripInWrist(86.0, 29.0, -82.0);
constexpr double kTongsClosedDeg = 4.0;
constexpr double kTongsOpenDeg = 11.0;

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

RigidTransform WorldFromPipe(const PayloadManner& manner, double time_s) {
  const double arrive = Ease(time_s, 0.0, kPipeArrivesS);
  const double stand_up = Ease(time_s, 1.6, kPipeArrivesS);
  const double lower = Ease(time_s, kLowerBeginsS, kLowerEndsS);
  const double tilt_rad = RadiansFromDegrees(50.0) * (1.0 - stand_up);
  const double over_z_mm = kPipeOverReceptacleZMm + manner.lift_mm;
  const double z_mm = over_z_mm + kPipeRadiusMm * std::sin(tilt_rad) - lower * (over_z_mm - kPipeStandsAtZMm);
  // The pipe leans towards the hand, so that the forearm comes from below.
  return {AngleAxisd(tilt_rad, Vector3d::UnitY()).toRotationMatrix(),
          {(1.0 - arrive) * 520.0, (1.0 - arrive) * -60.0, z_mm}};
}

SyntheticObject HandAtPipe(const PayloadManner& manner, double time_s) {
  const RigidTransform world_from_pipe = WorldFromPipe(manner, time_s);
  const Eigen::Matrix3d pipe_from_wrist = WristAxes(-Vector3d::UnitX(), -Vector3d::UnitY());
  const Vector3d wrist_in_pipe =
      Vector3d(0.0, 0.0, kPipeLengthMm) -
      pipe_from_wrist * (manner.hand_size * Vector3d(kPipeInWristXMm, 0.0, kPipeTopInWristZMm));
  RigidTransform world_from_wrist = world_from_pipe * RigidTransform{pipe_from_wrist, wrist_in_pipe};
  // The hand first moves up off the pipe, then away.
  world_from_wrist.translation_mm +=
      Ease(time_s, kReleaseBeginsS + 0.2, 7.1) * Vector3d(0.0, 0.0, manner.rise_mm) +
      Ease(time_s, 6.9, kHandGoneS) * Vector3d(680.0, 0.0, -60.0);
  const double open = Ease(time_s, kReleaseBeginsS, kReleaseEndsS);
  return Hand(world_from_wrist, Blend(PipePinch(), OpenHand(), 0.5 * open),
              ElbowBehind(world_from_wrist.translation_mm, 140.0), {.size = manner.hand_size});
}

// --- the cable ---

double StrokeMm(const PayloadManner& manner) { return kFedMm / manner.strokes; }

struct Feed {
  Vector3d tips_in_world;
  Vector3d plug_front_in_world;
  double opening_rad = 0.0;
};

// How far the plug has been pushed and how high the tips are, stroke by stroke: push, open, lift, close.
Feed FeedAt(const PayloadManner& manner, double time_s) {
  const double stroke_s = (kFeedEndsS - kFeedBeginsS) / manner.strokes;
  const double stroke_mm = StrokeMm(manner);
  const double plug_below_tips_mm = kTipsLowZMm - kPlugEndsAtZMm - (manner.strokes - 1) * stroke_mm;
  double pushed_mm = 0.0;
  double lifted = 1.0;
  double open = 0.0;
  for (int stroke = 0; stroke < manner.strokes; ++stroke) {
    const double begin_s = kFeedBeginsS + stroke * stroke_s;
    const double push = Ease(time_s, begin_s, begin_s + 0.5 * stroke_s);
    pushed_mm += push * stroke_mm;
    lifted -= push;
    open += Ease(time_s, begin_s + 0.5 * stroke_s, begin_s + 0.6 * stroke_s);
    if (stroke + 1 == manner.strokes) break;  // after the last one the tongs stay low and open
    lifted += Ease(time_s, begin_s + 0.6 * stroke_s, begin_s + 0.9 * stroke_s);
    open -= Ease(time_s, begin_s + 0.9 * stroke_s, begin_s + stroke_s);
  }
  const double arrive = Ease(time_s, kHandGoneS, kFeedBeginsS);
  const Vector3d held(640.0 * (1.0 - arrive), 30.0 * (1.0 - arrive), kTipsLowZMm + lifted * stroke_mm);
  const double leave = Ease(time_s, kFeedEndsS, kTaskSeconds);
  const Vector3d gone(620.0 * leave, 20.0 * leave, 40.0 * Ease(time_s, kFeedEndsS, kFeedEndsS + 0.5));
  return {held + gone,
          {held.x(), held.y(), kTipsLowZMm + stroke_mm - plug_below_tips_mm - pushed_mm},
          RadiansFromDegrees(kTongsClosedDeg + open * (kTongsOpenDeg - kTongsClosedDeg))};
}

// From the plug up to the tips or the pipe's mouth, over, and down to the table beside the boxes.
SyntheticObject CableAt(const PayloadManner& manner, const Feed& feed, double time_s) {
  const double tips_high_z_mm = kTipsLowZMm + StrokeMm(manner);
  const double fed = Ease(time_s, kFeedBeginsS, kFeedEndsS);
  const Vector3d mouth(feed.plug_front_in_world.x(), feed.plug_front_in_world.y(),
                       std::max(feed.plug_front_in_world.z() + kPlugLengthMm + 20.0, tips_high_z_mm - 24.0));
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

Vector3d UpTheTongs(const PayloadManner& manner) {
  return {std::cos(manner.tongs_elevation_rad), 0.0, std::sin(manner.tongs_elevation_rad)};
}

SyntheticObject TongsAt(const PayloadManner& manner, const Feed& feed) {
  const Vector3d up_the_tongs = UpTheTongs(manner);
  const Vector3d side = Vector3d::UnitY();
  Eigen::Matrix3d rotation;
  rotation << side.cross(up_the_tongs), side, up_the_tongs;
  return Tongs({rotation, feed.tips_in_world}, feed.opening_rad);
}

// With the tongs in it, or with the cable itself.
SyntheticObject HandThatFeeds(const PayloadManner& manner, const Feed& feed) {
  const Vector3d grip_in_world =
      feed.tips_in_world + (manner.takes_tongs ? Vector3d(manner.tongs_grip_mm * UpTheTongs(manner))
                                               : Vector3d(0.0, 0.0, kFingersOverTipsMm));
  const Eigen::Matrix3d axes = WristAxes(-Vector3d::UnitX(), Vector3d::UnitZ());
  const RigidTransform world_from_wrist{axes, grip_in_world - axes * (manner.hand_size * kTongsGripInWrist)};
  return Hand(world_from_wrist, TongsPinch(), ElbowBehind(world_from_wrist.translation_mm, 110.0),
              {.size = manner.hand_size});
}

// Where the person who does it stands, and where the pipe is put.
void Place(const PayloadManner& manner, std::vector<SyntheticObject>* objects) {
  const RigidTransform world_from_task{AngleAxisd(manner.from_rad, Vector3d::UnitZ()).toRotationMatrix(),
                                       {manner.aside_mm.x(), manner.aside_mm.y(), 0.0}};
  for (SyntheticObject& object : *objects)
    for (Solid& solid : object.solids) solid.world_from_solid = world_from_task * solid.world_from_solid;
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

void PayloadManner::Validate() const {
  core::Require(hand_size >= 0.8 && hand_size <= 1.2, "hand_size lies between 0.8 and 1.2");
  core::Require(aside_mm.norm() <= 10.0, "aside_mm is at most 10 mm");
  core::Require(lift_mm >= 0.0 && lift_mm <= 100.0, "lift_mm lies between 0 and 100");
  core::Require(rise_mm >= 0.0 && rise_mm <= 100.0, "rise_mm lies between 0 and 100");
  core::Require(tongs_elevation_rad >= 0.0 && tongs_elevation_rad <= RadiansFromDegrees(80.0),
                "tongs_elevation_rad lies between 0 and 80 degrees");
  core::Require(tongs_grip_mm > 0.0 && tongs_grip_mm <= kTongsLengthMm,
                "the tongs are gripped on their length");
  core::Require(strokes > 0, "the cable is fed in some strokes");
}

DemoScene PayloadSceneAt(const PayloadManner& manner, double task_time_s) {
  core::Require(task_time_s >= 0.0 && task_time_s <= kTaskSeconds, "the time is one of the task's");
  DemoScene scene;
  scene.phase = PhaseAt(task_time_s);
  scene.objects.push_back(Pipe(WorldFromPipe(manner, task_time_s)));
  if (task_time_s < kHandGoneS) {
    scene.objects.push_back(HandAtPipe(manner, task_time_s));
  } else {
    const Feed feed = FeedAt(manner, task_time_s);
    scene.tongs_in_use = manner.takes_tongs;
    scene.objects.push_back(HandThatFeeds(manner, feed));
    if (manner.takes_tongs) scene.objects.push_back(TongsAt(manner, feed));
    scene.objects.push_back(CableAt(manner, feed, task_time_s));
  }
  Place(manner, &scene.objects);
  return scene;
}

DemoScene DemoSceneAt(double time_s) {
  core::Require(time_s >= 0.0, "a demo's time is not negative");
  return PayloadSceneAt({}, std::fmod(time_s, kTaskSeconds));
}

}  // namespace elbowroom::recon
