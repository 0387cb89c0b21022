#include "recon/synthetic/block_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "recon/synthetic/ease.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::Vector3d;

constexpr double kWorkShare = 0.95;   // of the time; then the hand leaves
constexpr double kCarriedZMm = 90.0;  // a block's underside: over those that stand
constexpr double kBlockInWristXMm = 105.0, kBlockTopInWristZMm = -30.0;
const Vector3d kAway(560.0, 60.0, kCarriedZMm);

const Vector3d kWhiteBgr(230.0, 235.0, 235.0), kBlueBgr(220.0, 150.0, 90.0);

// When the hand is where, in shares of one block's time; it thinks until the block is over.
enum Moment : std::size_t { kStarts, kOverStock, kAtStock, kLifted, kOverSlot, kAtSlot, kReleased };
constexpr std::array<double, 7> kMoments{0.0, 0.22, 0.32, 0.38, 0.64, 0.76, 0.84};

// Where block i waits: beside the pattern, in two rows. All are places of a block's underside.
Vector3d Stock(int i) {
  constexpr int kInRow = 5;
  constexpr double kPitchMm = 88.0, kNearRowMm = 245.0;
  return {kNearRowMm + kPitchMm * (i / kInRow), kPitchMm * (i % kInRow - 0.5 * (kInRow - 1)), 0.0};
}

// The rows that are farthest from the person first.
Vector3d Slot(int i, int side) {
  const double middle = 0.5 * (side - 1);
  return {kBlockMm * (i / side - middle), kBlockMm * (i % side - middle), 0.0};
}

Vector3d Over(const Vector3d& place, double lift_mm) { return {place.x(), place.y(), kCarriedZMm + lift_mm}; }

// What goes on at a share of the pattern's time.
struct Moving {
  int block = 0;          // that is taken, carried or was placed last
  double at = 0.0;        // share of its time
  Vector3d held_in_task;  // the underside of a block in the hand
};

Moving MovingAt(const BlockManner& manner, int side, double share) {
  const int blocks = side * side;
  const double work = std::min(share / kWorkShare, 1.0) * blocks;
  const int block = std::min(static_cast<int>(work), blocks - 1);
  const double at = work - block;
  const Vector3d stock = Stock(block), slot = Slot(block, side);
  const Vector3d start = block == 0 ? kAway : Over(Slot(block - 1, side), manner.lift_mm);
  const std::array<Vector3d, kMoments.size()> places{
      start, Over(stock, manner.lift_mm), stock, Over(stock, manner.lift_mm), Over(slot, manner.lift_mm),
      slot,  Over(slot, manner.lift_mm)};
  Vector3d held = places[0];
  for (std::size_t i = 1; i < places.size(); ++i)
    held += Ease(at, kMoments[i - 1], kMoments[i]) * (places[i] - places[i - 1]);
  held += Ease(share, kWorkShare, 1.0) * (kAway - places[kReleased]);
  return {block, at, held};
}

SyntheticObject BlockAt(const Vector3d& underside, double turned_rad, int i) {
  return {"block",
          {{Box{Vector3d::Constant(kBlockMm)},
            {Eigen::AngleAxisd(turned_rad, Vector3d::UnitZ()).toRotationMatrix(),
             underside + Vector3d(0.0, 0.0, 0.5 * kBlockMm)},
            i % 2 == 0 ? kWhiteBgr : kBlueBgr}}};
}

SyntheticObject HandOver(const BlockManner& manner, const Moving& moving) {
  Eigen::Matrix3d world_from_wrist;  // fingers away from the person, the palm down
  world_from_wrist << -Vector3d::UnitX(), -Vector3d::UnitY(), Vector3d::UnitZ();
  const Vector3d top = moving.held_in_task + Vector3d(0.0, 0.0, kBlockMm);
  const Vector3d wrist =
      top - world_from_wrist * (manner.hand.size * Vector3d(kBlockInWristXMm, 0.0, kBlockTopInWristZMm));
  constexpr double kOpen = 0.3, kClosed = 0.45;  // towards the pinch that holds a pipe
  const double closed = Ease(moving.at, kMoments[kAtStock] - 0.02, kMoments[kAtStock]) -
                        Ease(moving.at, kMoments[kAtSlot], kMoments[kAtSlot] + 0.02);
  return Hand({world_from_wrist, wrist}, Blend(OpenHand(), PipePinch(), kOpen + closed * (kClosed - kOpen)),
              wrist + Vector3d(380.0, 40.0, -60.0), manner.hand);
}

}  // namespace

std::vector<SyntheticObject> BlocksAt(const BlockManner& manner, int side, double share) {
  core::Require(side == 2 || side == 3, "a pattern has 2 or 3 blocks on a side");
  core::Require(share >= 0.0 && share <= 1.0, "the share of the time lies between 0 and 1");
  core::Require(manner.lift_mm >= 0.0 && manner.lift_mm <= 150.0, "lift_mm lies between 0 and 150");
  const Moving moving = MovingAt(manner, side, share);
  std::vector<SyntheticObject> objects{HandOver(manner, moving)};
  for (int i = 0; i < side * side; ++i) {
    // Each is turned by another number of quarters while it is carried.
    const double turn_rad = 0.5 * std::numbers::pi * ((i + side) % 4);
    const bool is_held = i == moving.block && moving.at > kMoments[kAtStock] && moving.at < kMoments[kAtSlot];
    const bool is_placed = i < moving.block || (i == moving.block && moving.at >= kMoments[kAtSlot]);
    if (is_held)
      objects.push_back(BlockAt(moving.held_in_task,
                                turn_rad * Ease(moving.at, kMoments[kLifted], kMoments[kOverSlot]), i));
    else
      objects.push_back(BlockAt(is_placed ? Slot(i, side) : Stock(i), is_placed ? turn_rad : 0.0, i));
  }
  const RigidTransform world_from_task{
      Eigen::AngleAxisd(manner.from_rad, Vector3d::UnitZ()).toRotationMatrix(), Vector3d::Zero()};
  for (SyntheticObject& object : objects)
    for (Solid& solid : object.solids) solid.world_from_solid = world_from_task * solid.world_from_solid;
  return objects;
}

double PatternDoneAt(int side) {
  const double blocks = side * side;
  return kWorkShare * (blocks - 1.0 + kMoments[kAtSlot]) / blocks;
}

}  // namespace elbowroom::recon
