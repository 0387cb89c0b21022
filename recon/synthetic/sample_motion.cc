#include "recon/synthetic/sample_motion.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "recon/synthetic/actors.h"
#include "recon/synthetic/ease.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::Vector3d;

Eigen::Matrix3d Axes(const Vector3d& x, const Vector3d& y) {
  Eigen::Matrix3d axes;
  axes << x, y, x.cross(y);
  return axes;
}

Eigen::Matrix3d TurnAboutX(double angle_deg) {
  return Eigen::AngleAxisd(core::RadiansFromDegrees(angle_deg), Vector3d::UnitX()).toRotationMatrix();
}

Vector3d Elbow(const Vector3d& wrist_in_world, double side) {
  return wrist_in_world + Vector3d(330.0, 90.0 * side, -90.0);
}

}  // namespace

std::vector<SyntheticObject> HandsAtCurtain(double time_s) {
  core::Require(time_s >= 0.0, "a motion's time is not negative");
  const double t = std::fmod(time_s, kCurtainSeconds);
  constexpr double kAwayMm = 560.0, kThroughMm = 75.0;  // of the wrist, before the curtain
  constexpr double kTogetherMm = 42.0, kApartMm = 150.0, kHeightMm = 250.0;
  if (t < 0.3 || t > kCurtainSeconds - 0.5) return {};
  const double in = Ease(t, 0.3, 2.8) - Ease(t, 7.0, 9.4);
  const double apart = Ease(t, 2.9, 5.2) - 0.4 * Ease(t, 7.0, 9.4);
  std::vector<SyntheticObject> hands;
  for (const double side : {1.0, -1.0}) {  // the right hand, then the left one
    const Vector3d wrist(kCurtainXMm + kAwayMm + in * (kThroughMm - kAwayMm),
                         side * (kTogetherMm + apart * (kApartMm - kTogetherMm)), kHeightMm);
    // Palms outwards, thumbs down, as one parts curtains.
    const RigidTransform world_from_wrist{Axes(-Vector3d::UnitX(), -side * Vector3d::UnitZ()), wrist};
    hands.push_back(side > 0.0 ? Hand(world_from_wrist, OpenHand(), Elbow(wrist, side))
                               : LeftHand({Axes(-Vector3d::UnitX(), Vector3d::UnitZ()), wrist}, OpenHand(),
                                          Elbow(wrist, side)));
  }
  return hands;
}

std::vector<SyntheticObject> HandsAtFaucet(double time_s) {
  core::Require(time_s >= 0.0, "a motion's time is not negative");
  const double t = std::fmod(time_s, kFaucetSeconds);
  constexpr double kAwayMm = 520.0, kBelowMm = 66.0;  // of the wrists, from the stream
  constexpr double kHalfApartMm = 29.0, kHeightMm = 205.0, kBowlDeg = 26.0;
  const double down_rad = core::RadiansFromDegrees(12.0);  // fingers, so that water stays before them
  const Vector3d fingers(-std::cos(down_rad), 0.0, -std::sin(down_rad));
  if (t < 0.8 || t > kFaucetSeconds - 0.4) return {};
  const double in = Ease(t, 0.8, 3.2) - Ease(t, 9.2, 11.4);
  std::vector<SyntheticObject> hands;
  for (const double side : {1.0, -1.0}) {
    const Vector3d wrist(kAwayMm + in * (kBelowMm - kAwayMm), side * kHalfApartMm, kHeightMm);
    // Palms up, the outer edges raised. Both wrist frames have y towards +y: thumb outwards on the right, the
    // little finger inwards on the left.
    const RigidTransform world_from_wrist{Axes(fingers, Vector3d::UnitY()) * TurnAboutX(-side * kBowlDeg),
                                          wrist};
    hands.push_back(side > 0.0 ? Hand(world_from_wrist, CuppedHand(), Elbow(wrist, side))
                               : LeftHand(world_from_wrist, CuppedHand(), Elbow(wrist, side)));
  }
  return hands;
}

}  // namespace elbowroom::recon
