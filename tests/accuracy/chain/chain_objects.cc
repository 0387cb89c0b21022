#include "tests/accuracy/chain/chain_objects.h"

#include "recon/synthetic/actors.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;
using recon::testing::HandMotion;
using recon::testing::MovingShape;

std::vector<recon::Solid> HandAt(HandMotion motion, MovingShape shape, double time_s) {
  motion.shape = shape;
  return recon::testing::HandsAt(motion, time_s);
}

std::vector<recon::Solid> PipeAt(const core::RigidTransform& world_from_middle) {
  const core::RigidTransform middle_from_pipe{Eigen::Matrix3d::Identity(),
                                              {0.0, 0.0, -0.5 * recon::kPipeLengthMm}};
  return recon::Pipe(world_from_middle * middle_from_pipe).solids;
}

// The cable bends out of the plug, whose front always points down.
std::vector<recon::Solid> CableAt(const core::RigidTransform& world_from_plug) {
  const Vector3d front = world_from_plug.translation_mm;
  const Vector3d back = front + Vector3d(0.0, 0.0, recon::kPlugLengthMm);
  const Vector3d towards = world_from_plug.rotation * Vector3d(0.8, 0.0, 0.6);
  const Vector3d through[] = {back + Vector3d(0.0, 0.0, 40.0) + 10.0 * towards,
                              back + Vector3d(0.0, 0.0, 50.0) + 70.0 * towards, back + 160.0 * towards};
  return recon::Cable(front, through).solids;
}

}  // namespace

ChainMotion DrawChainMotion(ChainObject object, const Vector3d& middle_in_world, std::uint64_t seed) {
  recon::Random random(seed);
  HandMotion motion;
  motion.seed = seed;
  motion.reach_mm = random.Uniform(20.0, 60.0);
  motion.speed = random.Uniform(0.8, 2.5);
  motion.middle_in_world = middle_in_world;
  return {object, motion};
}

std::vector<recon::Solid> SolidsAt(const ChainMotion& motion, double time_s) {
  switch (motion.object) {
    case ChainObject::kOpenHand:
      return HandAt(motion.motion, MovingShape::kOpenHand, time_s);
    case ChainObject::kFist:
      return HandAt(motion.motion, MovingShape::kFist, time_s);
    case ChainObject::kTongs:
      return HandAt(motion.motion, MovingShape::kTongs, time_s);
    case ChainObject::kPipe:
      return PipeAt(recon::testing::PoseAt(motion.motion, time_s));
    case ChainObject::kBall:
      return {{recon::Sphere{30.0}, recon::testing::PoseAt(motion.motion, time_s)}};
    case ChainObject::kCable:
      return CableAt(recon::testing::PoseAt(motion.motion, time_s));
  }
  return {};
}

}  // namespace elbowroom::accuracy
