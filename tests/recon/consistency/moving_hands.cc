#include "tests/recon/consistency/moving_hands.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/units.h"
#include "recon/synthetic/actors.h"
#include "tests/recon/consistency/capsule_masks.h"

namespace elbowroom::recon::testing {
namespace {

using Eigen::Vector3d;

// A smooth random function of time with about unit size.
double Wander(std::uint64_t seed, std::uint64_t channel, double time_s) {
  constexpr std::array<double, 3> kRatesHz{0.11, 0.31, 0.63};
  constexpr std::array<double, 3> kSizes{0.8, 0.45, 0.2};
  double sum = 0.0;
  for (std::size_t i = 0; i < kRatesHz.size(); ++i) {
    const std::uint64_t number = channel * 16 + i * 2;
    const double rate_hz = kRatesHz[i] * (1.0 + 0.15 * NormalFrom(seed, number));
    const double phase = 10.0 * NormalFrom(seed, number + 1);
    sum += kSizes[i] * std::sin(2.0 * std::numbers::pi * rate_hz * time_s + phase);
  }
  return sum;
}

core::RigidTransform WanderingPose(const HandMotion& motion, std::uint64_t first_channel, double time_s) {
  const auto wander = [&](std::uint64_t channel) {
    return Wander(motion.seed, first_channel + channel, motion.speed * time_s);
  };
  const Vector3d turn_rad(0.5 * wander(3), 0.5 * wander(4), 0.9 * wander(5));
  return {Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()).toRotationMatrix(),
          motion.middle_in_world + motion.reach_mm * Vector3d(wander(0), wander(1), 0.6 * wander(2))};
}

void AddHand(const HandMotion& motion, std::uint64_t first_channel, const HandShape& from,
             const HandShape& to, double time_s, std::vector<Solid>* solids) {
  core::RigidTransform world_from_wrist = WanderingPose(motion, first_channel, time_s);
  const double share = 0.5 + 0.4 * Wander(motion.seed, first_channel + 6, motion.speed * time_s);
  const Vector3d elbow = world_from_wrist * Vector3d(-motion.forearm_mm, 15.0, -0.2 * motion.forearm_mm);
  const SyntheticObject hand = Hand(world_from_wrist, Blend(from, to, share), elbow);
  solids->insert(solids->end(), hand.solids.begin(), hand.solids.end());
}

void AddBumpyBall(const HandMotion& motion, double time_s, std::vector<Solid>* solids) {
  const core::RigidTransform world_from_ball = PoseAt(motion, time_s);
  for (int i = 0; i < 14; ++i) {
    const auto number = static_cast<std::uint64_t>(1000 + 4 * i);
    const Vector3d away(NormalFrom(motion.seed, number), NormalFrom(motion.seed, number + 1),
                        NormalFrom(motion.seed, number + 2));
    const double radius_mm = 14.0 + 3.0 * std::abs(NormalFrom(motion.seed, number + 3));
    solids->push_back({Sphere{radius_mm},
                       {world_from_ball.rotation, world_from_ball * (45.0 * away.normalized())},
                       Vector3d::Constant(200.0)});
  }
}

}  // namespace

const char* NameOf(MovingShape shape) {
  switch (shape) {
    case MovingShape::kOpenHand:
      return "open hand";
    case MovingShape::kFist:
      return "fist";
    case MovingShape::kTwoHands:
      return "two hands";
    case MovingShape::kTongs:
      return "tongs";
    case MovingShape::kBumpyBall:
      return "bumpy ball";
  }
  return "unknown";
}

core::RigidTransform PoseAt(const HandMotion& motion, double time_s) {
  return WanderingPose(motion, 0, time_s);
}

std::vector<Solid> HandsAt(const HandMotion& motion, double time_s) {
  std::vector<Solid> solids;
  switch (motion.shape) {
    case MovingShape::kOpenHand:
      AddHand(motion, 0, OpenHand(), PipePinch(), time_s, &solids);
      break;
    case MovingShape::kFist:
      AddHand(motion, 0, TongsPinch(), PipePinch(), time_s, &solids);
      break;
    case MovingShape::kTwoHands:
      AddHand(motion, 0, OpenHand(), PipePinch(), time_s, &solids);
      AddHand(motion, 50, TongsPinch(), OpenHand(), time_s, &solids);
      break;
    case MovingShape::kTongs: {
      const double open = 0.5 + 0.4 * Wander(motion.seed, 6, motion.speed * time_s);
      const SyntheticObject tongs = Tongs(PoseAt(motion, time_s), 0.3 * open);
      solids = tongs.solids;
      break;
    }
    case MovingShape::kBumpyBall:
      AddBumpyBall(motion, time_s, &solids);
      break;
  }
  return solids;
}

core::Rig HandRig(int count) {
  constexpr double kDistanceMm = 1200.0;
  constexpr std::array<double, 4> kHeightsMm{150.0, 500.0, 900.0, 350.0};
  const double focal_px = 320.0 / std::tan(core::RadiansFromDegrees(25.0));
  const Vector3d target_in_world(60.0, 0.0, 190.0);
  core::Rig rig;
  rig.name = "hands";
  rig.workspace_mm = {Vector3d(-250.0, -310.0, 0.0), Vector3d(370.0, 310.0, 400.0)};
  for (int i = 0; i < count; ++i) {
    // Not evenly, so that no two cameras look at each other.
    const double around = 2.0 * std::numbers::pi * (i + 0.12 * (i % 3)) / count + 0.3;
    const Vector3d eye = target_in_world + kDistanceMm * Vector3d(std::cos(around), std::sin(around), 0.0) +
                         Vector3d(0.0, 0.0, kHeightsMm[static_cast<std::size_t>(i) % kHeightsMm.size()]);
    core::CameraCalibration camera;
    camera.name = "cam" + std::to_string(i + 1);
    camera.image_width_px = 640, camera.image_height_px = 480;
    camera.camera_matrix << focal_px, 0.0, 319.5, 0.0, focal_px, 239.5, 0.0, 0.0, 1.0;
    camera.distortion_coefficients = {-0.08, 0.02, 0.0005, -0.0004, 0.0};
    camera.cam_from_world = core::CamFromWorldLookingAt(eye, target_in_world);
    rig.cameras.emplace_back(camera);
  }
  rig.Validate();
  return rig;
}

}  // namespace elbowroom::recon::testing
