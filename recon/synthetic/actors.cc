#include "recon/synthetic/actors.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "core/error.h"
#include "core/units.h"

namespace elbowroom::recon {
namespace {

using core::RadiansFromDegrees;
using Eigen::Vector3d;

const Vector3d kSkinBgr(135.0, 165.0, 225.0);
const Vector3d kSleeveBgr(215.0, 160.0, 120.0);
const Vector3d kPvcBgr(235.0, 240.0, 240.0);
const Vector3d kSteelBgr(205.0, 200.0, 195.0);
const Vector3d kCableBgr(60.0, 190.0, 245.0);
const Vector3d kPlugBgr(190.0, 110.0, 225.0);

// One finger in the wrist frame, stretched along x from its knuckle.
struct FingerBuild {
  double knuckle_x_mm, knuckle_y_mm;
  std::array<double, 3> bone_mm;
  std::array<double, 3> radius_mm;
};
constexpr std::array<FingerBuild, 4> kFingers{{
    {95.0, 27.0, {43.0, 26.0, 20.0}, {9.0, 8.5, 7.5}},
    {97.0, 9.0, {47.0, 30.0, 21.0}, {9.0, 8.5, 7.5}},
    {93.0, -9.0, {43.0, 28.0, 20.0}, {8.5, 8.0, 7.0}},
    {86.0, -26.0, {34.0, 21.0, 18.0}, {8.0, 7.0, 6.5}},
}};
const Vector3d kThumbRootInWrist(22.0, 26.0, -8.0);
constexpr std::array<double, 3> kThumbBoneMm{42.0, 33.0, 25.0};
constexpr std::array<double, 3> kThumbRadiusMm{13.0, 10.5, 9.0};
constexpr double kPalmRadiusMm = 12.5;
constexpr double kWristRadiusMm = 24.0;
constexpr double kForearmRadiusMm = 34.0;
const Vector3d kWristJointInWrist(0.0, 0.0, -10.0);  // the arm lies below the back of the hand

FingerBend BendDeg(double base, double middle, double tip) {
  return {RadiansFromDegrees(base), RadiansFromDegrees(middle), RadiansFromDegrees(tip)};
}
ThumbBone BoneDeg(double aside, double down) { return {RadiansFromDegrees(aside), RadiansFromDegrees(down)}; }

// A hand that grows: of whom, where, and the solids so far. Lengths are those of the hand of 190 mm.
class GrowingHand {
 public:
  GrowingHand(const core::RigidTransform& world_from_wrist, const HandBuild& build)
      : world_from_wrist_(world_from_wrist), build_(build) {}

  void AddCapsule(const Vector3d& a_in_wrist, const Vector3d& b_in_wrist, double radius_mm) {
    AddCapsuleInWorld(InWorld(a_in_wrist), InWorld(b_in_wrist), radius_mm,
                      build_.glove_bgr.value_or(kSkinBgr));
  }
  void AddCapsuleInWorld(const Vector3d& a_in_world, const Vector3d& b_in_world, double radius_mm,
                         const Vector3d& color_bgr) {
    solids_.push_back(
        CapsuleBetween(a_in_world, b_in_world, build_.size * radius_mm + build_.glove_mm, color_bgr));
  }
  [[nodiscard]] Vector3d InWorld(const Vector3d& x_in_wrist) const {
    return world_from_wrist_ * (build_.size * x_in_wrist);
  }
  [[nodiscard]] std::vector<Solid> Take() { return std::move(solids_); }

 private:
  const core::RigidTransform& world_from_wrist_;
  const HandBuild& build_;
  std::vector<Solid> solids_;
};

// Adds capsules from `from_in_wrist` on, bone after bone.
class Chain {
 public:
  Chain(const Vector3d& from_in_wrist, GrowingHand& hand) : end_in_wrist_(from_in_wrist), hand_(hand) {}

  void AddBone(const Vector3d& bone_in_wrist, double radius_mm) {
    const Vector3d next_in_wrist = end_in_wrist_ + bone_in_wrist;
    hand_.AddCapsule(end_in_wrist_, next_in_wrist, radius_mm);
    end_in_wrist_ = next_in_wrist;
  }

 private:
  Vector3d end_in_wrist_;
  GrowingHand& hand_;
};

void AddFinger(const FingerBuild& build, const FingerBend& bend, GrowingHand& hand) {
  const Vector3d knuckle(build.knuckle_x_mm, build.knuckle_y_mm, 0.0);
  const Vector3d palm_root(8.0, 0.6 * build.knuckle_y_mm, -6.0);
  Chain chain(palm_root, hand);
  chain.AddBone(knuckle - palm_root, kPalmRadiusMm);
  const std::array<double, 3> turn_rad{bend.base_rad, bend.middle_rad, bend.tip_rad};
  double angle_rad = 0.0;
  for (std::size_t bone = 0; bone < 3; ++bone) {
    angle_rad += turn_rad[bone];
    chain.AddBone(build.bone_mm[bone] * Vector3d(std::cos(angle_rad), 0.0, -std::sin(angle_rad)),
                  build.radius_mm[bone]);
  }
}

void AddThumb(const std::array<ThumbBone, 3>& thumb, GrowingHand& hand) {
  Chain chain(kThumbRootInWrist, hand);
  for (std::size_t bone = 0; bone < 3; ++bone) {
    const double along = std::cos(thumb[bone].down_rad);
    chain.AddBone(kThumbBoneMm[bone] * Vector3d(along * std::cos(thumb[bone].aside_rad),
                                                along * std::sin(thumb[bone].aside_rad),
                                                -std::sin(thumb[bone].down_rad)),
                  kThumbRadiusMm[bone]);
  }
}

void AddForearm(const Vector3d& elbow_in_world, GrowingHand& hand) {
  constexpr double kSleeveStart = 0.3;  // share of the way to the elbow
  const Vector3d wrist_in_world = hand.InWorld(kWristJointInWrist);
  const Vector3d sleeve_in_world = wrist_in_world + kSleeveStart * (elbow_in_world - wrist_in_world);
  hand.AddCapsuleInWorld(wrist_in_world, sleeve_in_world, kWristRadiusMm, kSkinBgr);
  hand.AddCapsuleInWorld(sleeve_in_world, elbow_in_world, kForearmRadiusMm, kSleeveBgr);
}

// Point at `share` between b and c on the Catmull-Rom curve through a, b, c, d.
Vector3d CatmullRom(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d,
                    double share) {
  const double s = share;
  return 0.5 * (2.0 * b + s * (c - a) + s * s * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                s * s * s * (3.0 * (b - c) + d - a));
}

}  // namespace

HandShape OpenHand() {
  return {{BendDeg(10, 15, 10), BendDeg(8, 15, 10), BendDeg(10, 18, 10), BendDeg(14, 20, 12)},
          {BoneDeg(45, 25), BoneDeg(35, 25), BoneDeg(25, 20)}};
}

HandShape PipePinch() {
  return {{BendDeg(60, 35, 15), BendDeg(56, 38, 18), BendDeg(60, 35, 15), BendDeg(62, 35, 15)},
          {BoneDeg(35, 52), BoneDeg(-60, 55), BoneDeg(-85, 30)}};
}

HandShape TongsPinch() {
  return {{BendDeg(60, 60, 20), BendDeg(75, 75, 35), BendDeg(80, 85, 40), BendDeg(80, 85, 40)},
          {BoneDeg(8, 52), BoneDeg(0, 50), BoneDeg(-4, 44)}};
}

HandShape CuppedHand() {
  return {{BendDeg(30, 40, 30), BendDeg(32, 42, 30), BendDeg(32, 42, 30), BendDeg(30, 40, 30)},
          {BoneDeg(20, 20), BoneDeg(10, 25), BoneDeg(5, 30)}};
}

HandShape Blend(const HandShape& from, const HandShape& to, double share) {
  const auto mix = [share](double a, double b) { return a + share * (b - a); };
  HandShape shape;
  for (std::size_t i = 0; i < shape.fingers.size(); ++i) {
    const FingerBend& a = from.fingers[i];
    const FingerBend& b = to.fingers[i];
    shape.fingers[i] = {mix(a.base_rad, b.base_rad), mix(a.middle_rad, b.middle_rad),
                        mix(a.tip_rad, b.tip_rad)};
  }
  for (std::size_t i = 0; i < shape.thumb.size(); ++i) {
    shape.thumb[i] = {mix(from.thumb[i].aside_rad, to.thumb[i].aside_rad),
                      mix(from.thumb[i].down_rad, to.thumb[i].down_rad)};
  }
  return shape;
}

SyntheticObject Hand(const core::RigidTransform& world_from_wrist, const HandShape& shape,
                     const Vector3d& elbow_in_world, const HandBuild& build) {
  core::Require(build.size > 0.0, "a hand has a size");
  GrowingHand hand(world_from_wrist, build);
  for (std::size_t i = 0; i < kFingers.size(); ++i) AddFinger(kFingers[i], shape.fingers[i], hand);
  AddThumb(shape.thumb, hand);
  AddForearm(elbow_in_world, hand);
  return {"hand", hand.Take()};
}

// Points alone are mapped, so that a reflection will do.
SyntheticObject LeftHand(const core::RigidTransform& world_from_wrist, const HandShape& shape,
                         const Vector3d& elbow_in_world) {
  const Eigen::Matrix3d mirror = Vector3d(1.0, -1.0, 1.0).asDiagonal();
  return Hand({world_from_wrist.rotation * mirror, world_from_wrist.translation_mm}, shape, elbow_in_world);
}

SyntheticObject Pipe(const core::RigidTransform& world_from_pipe) {
  return {"pipe",
          {{Tube{kPipeRadiusMm, kPipeRadiusMm - kPipeWallMm, kPipeLengthMm}, world_from_pipe, kPvcBgr}}};
}

SyntheticObject Tongs(const core::RigidTransform& world_from_tongs, double opening_rad) {
  constexpr double kArmRadiusMm = 3.5;
  constexpr double kHingeRadiusMm = 7.0;
  constexpr double kBowMm = 9.0;  // the arms bow outwards between hinge and tips
  SyntheticObject tongs{"tongs", {}};
  const Vector3d hinge(0.0, 0.0, kTongsLengthMm);
  for (const double side : {-1.0, 1.0}) {
    const double half_rad = 0.5 * side * opening_rad;
    const Vector3d out(0.0, std::cos(half_rad), std::sin(half_rad));
    const Vector3d down(0.0, std::sin(half_rad), -std::cos(half_rad));
    const Vector3d elbow = hinge + 0.35 * kTongsLengthMm * down + side * kBowMm * out;
    const Vector3d tip = hinge + kTongsLengthMm * down + side * kArmRadiusMm * out;
    tongs.solids.push_back(
        CapsuleBetween(world_from_tongs * hinge, world_from_tongs * elbow, kArmRadiusMm, kSteelBgr));
    tongs.solids.push_back(
        CapsuleBetween(world_from_tongs * elbow, world_from_tongs * tip, kArmRadiusMm, kSteelBgr));
  }
  tongs.solids.push_back(
      {Sphere{kHingeRadiusMm}, {world_from_tongs.rotation, world_from_tongs * hinge}, kSteelBgr});
  return tongs;
}

SyntheticObject Cable(const Vector3d& plug_front_in_world, std::span<const Vector3d> through_in_world) {
  constexpr int kPiecesPerSpan = 6;
  core::Require(!through_in_world.empty(), "a cable runs through at least one point");
  const Vector3d back = plug_front_in_world + Vector3d(0.0, 0.0, kPlugLengthMm);
  SyntheticObject cable{"cable", {}};
  cable.solids.push_back({Tube{kPlugRadiusMm, 0.0, kPlugLengthMm},
                          {Eigen::Matrix3d::Identity(), plug_front_in_world},
                          kPlugBgr});

  std::vector<Vector3d> points{plug_front_in_world, back};
  points.insert(points.end(), through_in_world.begin(), through_in_world.end());
  points.push_back(2.0 * points.back() - points[points.size() - 2]);
  Vector3d from = back;
  for (std::size_t span = 1; span + 2 < points.size(); ++span) {
    for (int piece = 1; piece <= kPiecesPerSpan; ++piece) {
      const Vector3d to = CatmullRom(points[span - 1], points[span], points[span + 1], points[span + 2],
                                     static_cast<double>(piece) / kPiecesPerSpan);
      cable.solids.push_back(CapsuleBetween(from, to, kCableRadiusMm, kCableBgr));
      from = to;
    }
  }
  return cable;
}

}  // namespace elbowroom::recon
