// Seeded rigs and masks of every awkward kind: the ground on which the ball query is held to account.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <random>
#include <vector>

#include "core/bit_mask.h"
#include "core/rig.h"
#include "core/soft_mask.h"

namespace elbowroom::recon {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  [[nodiscard]] double Uniform(double low, double high);
  [[nodiscard]] double LogUniform(double low, double high);
  [[nodiscard]] int Whole(int low, int high);  // both ends included
  [[nodiscard]] bool Chance(double share) { return Uniform(0.0, 1.0) < share; }
  [[nodiscard]] Eigen::Vector3d Direction();  // unit, uniform on the sphere
  [[nodiscard]] Eigen::Vector3d PointIn(const Eigen::AlignedBox3d& box);
  [[nodiscard]] Eigen::Matrix3d Rotation();

 private:
  std::mt19937_64 engine_;
};

enum class LensKind { kPinhole, kFoldingBarrel, kPincushion, kTangential, kRational, kFisheye };
inline constexpr int kLensKinds = 6;

// A camera of that kind, 40 to 150 px a side, 50 to 50,000 px of focal length (fx != fy, half of them with
// skew), near (in the middle of things) to far, roughly towards the origin.
[[nodiscard]] core::CameraModel RandomCamera(Random* random, LensKind kind);

// Blobs, blobs with holes, single pixels, stripes, noise, empty, full.
[[nodiscard]] core::BitMask RandomMask(Random* random, int width_px, int height_px);
// Blobs alone, in the middle of the picture.
[[nodiscard]] core::BitMask BlobMask(Random* random, int width_px, int height_px);

// The same mask with random coverage along its boundary.
[[nodiscard]] core::SoftMask RandomLevels(Random* random, core::BitMask mask);

struct RandomScene {
  std::shared_ptr<const core::Rig> rig;
  std::vector<core::BitMask> masks;
};

// One to five cameras of mixed kinds with masks of mixed kinds, either policy, a workspace about the origin.
[[nodiscard]] RandomScene MakeRandomScene(Random* random);

// `cameras` ordinary cameras around the origin, 400 to 900 mm away, each seeing blobs: a hull with volume.
[[nodiscard]] RandomScene MakeRingScene(Random* random, int cameras, core::UnseenPolicy unseen);

}  // namespace elbowroom::recon
