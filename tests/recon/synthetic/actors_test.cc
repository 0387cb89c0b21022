// The actors have the shapes that the demo's story needs.
#include "recon/synthetic/actors.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

double DistanceMm(const SyntheticObject& object, const Vector3d& x_in_world) {
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (const Solid& solid : object.solids)
    nearest_mm = std::min(nearest_mm, SignedDistanceMm(solid, x_in_world));
  return nearest_mm;
}

// Separate pieces that a hand at the origin shows in the strip x = x_mm, seen from above.
int PiecesAcross(const SyntheticObject& hand, double x_mm) {
  int pieces = 0;
  bool inside_before = false;
  for (double y_mm = -80.0; y_mm <= 80.0; y_mm += 0.5) {
    bool inside = false;
    for (double z_mm = -120.0; z_mm <= 30.0 && !inside; z_mm += 1.0) {
      inside = DistanceMm(hand, {x_mm, y_mm, z_mm}) <= 0.0;
    }
    pieces += inside && !inside_before;
    inside_before = inside;
  }
  return pieces;
}

const Vector3d kElbow(-260.0, 0.0, 0.0);

TEST(SyntheticHand, FourFingersStandApartWhenOpenAndAThumbBesideThem) {
  const SyntheticObject open = Hand({}, OpenHand(), kElbow);
  EXPECT_EQ(PiecesAcross(open, 155.0), 4) << "fingers";
  EXPECT_EQ(PiecesAcross(open, 70.0), 2) << "palm and thumb";
  EXPECT_EQ(PiecesAcross(open, -150.0), 1) << "forearm";
  const SyntheticObject pinch = Hand({}, PipePinch(), kElbow);
  EXPECT_EQ(PiecesAcross(pinch, 155.0), 0) << "bent fingers don't reach that far";
}

TEST(SyntheticHand, IsOnePieceWhateverItsPose) {
  for (const HandShape& shape :
       {OpenHand(), PipePinch(), TongsPinch(), Blend(OpenHand(), PipePinch(), 0.5)}) {
    const SyntheticObject hand = Hand({}, shape, kElbow);
    // Grow the set of solids that hang together from the first one: their axes' ends meet other solids.
    std::vector<bool> reached(hand.solids.size(), false);
    reached[0] = true;
    for (std::size_t round = 0; round < hand.solids.size(); ++round) {
      for (std::size_t i = 0; i < hand.solids.size(); ++i) {
        const Solid& solid = hand.solids[i];
        const double length_mm = std::get<Capsule>(solid.shape).length_mm;
        const Vector3d ends[] = {solid.world_from_solid.translation_mm,
                                 solid.world_from_solid * Vector3d(0.0, 0.0, length_mm)};
        for (std::size_t k = 0; k < hand.solids.size(); ++k) {
          const bool touch = Contains(hand.solids[k], ends[0]) || Contains(hand.solids[k], ends[1]);
          if (touch && (reached[i] || reached[k])) reached[i] = reached[k] = true;
        }
      }
    }
    EXPECT_EQ(std::ranges::count(reached, false), 0);
  }
}

TEST(SyntheticHand, BlendEndsAtItsShapes) {
  const HandShape half = Blend(OpenHand(), PipePinch(), 0.5);
  EXPECT_DOUBLE_EQ(Blend(OpenHand(), PipePinch(), 1.0).fingers[1].base_rad, PipePinch().fingers[1].base_rad);
  EXPECT_GT(half.fingers[0].base_rad, OpenHand().fingers[0].base_rad);
  EXPECT_LT(half.fingers[0].base_rad, PipePinch().fingers[0].base_rad);
}

TEST(SyntheticPipe, HasThePapersLengthAndDiameterAndIsOpen) {
  const SyntheticObject pipe = Pipe({});
  EXPECT_NEAR(DistanceMm(pipe, {25.0, 0.0, 70.0}), 5.0, 1e-9) << "40 mm across";
  EXPECT_NEAR(DistanceMm(pipe, {19.0, 0.0, 147.0}), 7.0, 1e-9) << "140 mm long";
  EXPECT_GT(DistanceMm(pipe, {0.0, 0.0, 70.0}), 15.0) << "a cable fits through";
}

TEST(SyntheticTongs, TheirTipsMeetAtTheOriginAndPartWhenOpened) {
  const SyntheticObject closed = Tongs({}, 0.0);
  EXPECT_LE(DistanceMm(closed, {0.0, 3.0, 0.0}), 0.0);
  EXPECT_LE(DistanceMm(closed, {0.0, -3.0, 0.0}), 0.0);
  EXPECT_LE(DistanceMm(closed, {0.0, 0.0, kTongsLengthMm}), 0.0) << "hinge";
  EXPECT_GT(DistanceMm(closed, {0.0, 0.0, 100.0}), 1.0) << "daylight between the arms";
  const SyntheticObject open = Tongs({}, 0.2);
  EXPECT_GT(DistanceMm(open, Vector3d::Zero()), 10.0);
  EXPECT_NEAR(DistanceMm(open, Vector3d::Zero()), kTongsLengthMm * std::sin(0.1), 3.0);
}

TEST(SyntheticCable, RunsUnbrokenFromThePlugThroughItsPoints) {
  const std::array<Vector3d, 3> through{Vector3d(0, 0, 150), Vector3d(80, 0, 160), Vector3d(150, 20, 40)};
  const SyntheticObject cable = Cable({0.0, 0.0, 60.0}, through);
  EXPECT_LE(DistanceMm(cable, {0.0, 0.0, 60.0}), 1e-9);
  EXPECT_NEAR(DistanceMm(cable, {0.0, 0.0, 50.0}), 10.0, 1e-9) << "nothing before the plug's face";
  for (const Vector3d& point : through) EXPECT_LE(DistanceMm(cable, point), -kCableRadiusMm + 1e-6);
  for (std::size_t i = 2; i < cable.solids.size(); ++i) {
    EXPECT_LE(SignedDistanceMm(cable.solids[i - 1], cable.solids[i].world_from_solid.translation_mm),
              -kCableRadiusMm + 1e-6)
        << "piece " << i;
  }
  EXPECT_THROW((void)Cable(Vector3d::Zero(), {}), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
