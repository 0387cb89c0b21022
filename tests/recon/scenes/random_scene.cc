#include "tests/recon/scenes/random_scene.h"

#include <cmath>
#include <string>
#include <utility>

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

core::CameraCalibration RandomLens(Random* random, LensKind kind, core::CameraCalibration c) {
  const auto u = [&](double low, double high) { return random->Uniform(low, high); };
  switch (kind) {
    case LensKind::kPinhole:
      break;
    case LensKind::kFoldingBarrel:  // that of the four_cameras footage, and about it
      c.distortion_coefficients = {u(-0.45, -0.3), u(0.0, 0.25), u(-1e-3, 1e-3), u(-1e-3, 1e-3),
                                   u(-0.1, 0.0)};
      break;
    case LensKind::kPincushion:
      c.distortion_coefficients = {u(0.0, 0.6), u(-0.05, 0.3), 0.0, 0.0, u(-0.02, 0.05)};
      break;
    case LensKind::kTangential:
      c.distortion_coefficients = {u(-0.2, 0.2), u(-0.1, 0.1), u(-0.03, 0.03), u(-0.03, 0.03)};
      break;
    case LensKind::kRational:
      c.distortion_model = core::DistortionModel::kRationalPolynomial;
      c.distortion_coefficients = {u(0.2, 0.8),    u(-2.8, 0.5),   u(-1e-3, 1e-3), u(-1e-3, 1e-3),
                                   u(0.0, 1.6),    u(0.1, 0.5),    u(-2.6, 0.3),   u(0.0, 1.5),
                                   u(-1e-2, 1e-2), u(-1e-3, 1e-3), u(-1e-2, 1e-2), u(-1e-3, 1e-3)};
      break;
    case LensKind::kFisheye:
      c.distortion_model = core::DistortionModel::kFisheye;
      c.distortion_coefficients = {u(-0.1, 0.1), u(-0.05, 0.05), u(-0.02, 0.02), u(-0.01, 0.01)};
      break;
  }
  return c;
}

void PaintDisc(core::BitMask* mask, double x, double y, double radius_px, bool object) {
  for (int j = 0; j < mask->height_px(); ++j) {
    for (int i = 0; i < mask->width_px(); ++i) {
      if (std::hypot(i - x, j - y) <= radius_px) mask->Set(i, j, object);
    }
  }
}

core::BitMask DiscsMask(Random* random, int width_px, int height_px, bool with_holes) {
  core::BitMask mask(width_px, height_px);
  const double size_px = std::min(width_px, height_px);
  for (int n = random->Whole(1, 5); n > 0; --n) {
    PaintDisc(&mask, random->Uniform(-0.1, 1.1) * width_px, random->Uniform(-0.1, 1.1) * height_px,
              random->Uniform(0.05, 0.5) * size_px, true);
  }
  if (!with_holes) return mask;
  for (int n = random->Whole(1, 6); n > 0; --n) {
    PaintDisc(&mask, random->Uniform(0, width_px), random->Uniform(0, height_px),
              random->Uniform(0.0, 0.15) * size_px, false);
  }
  return mask;
}

void PaintAll(core::BitMask* mask, const auto& is_object) {
  for (int y = 0; y < mask->height_px(); ++y) {
    for (int x = 0; x < mask->width_px(); ++x) mask->Set(x, y, is_object(x, y));
  }
}

}  // namespace

double Random::Uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine_);
}

double Random::LogUniform(double low, double high) {
  return std::exp(Uniform(std::log(low), std::log(high)));
}

int Random::Whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

Vector3d Random::Direction() {
  for (;;) {
    const Vector3d v(Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1));
    const double square = v.squaredNorm();
    if (square > 1e-4 && square <= 1.0) return v / std::sqrt(square);
  }
}

Vector3d Random::PointIn(const Eigen::AlignedBox3d& box) {
  return {Uniform(box.min().x(), box.max().x()), Uniform(box.min().y(), box.max().y()),
          Uniform(box.min().z(), box.max().z())};
}

Eigen::Matrix3d Random::Rotation() {
  return Eigen::AngleAxisd(Uniform(0.0, 2.0 * M_PI), Direction()).toRotationMatrix();
}

core::CameraModel RandomCamera(Random* random, LensKind kind) {
  core::CameraCalibration c;
  c.name = "random";
  c.image_width_px = random->Whole(40, 150);
  c.image_height_px = random->Whole(40, 150);
  // Lenses that bend strongly are wide; only the others go to extreme focal lengths.
  const bool is_plain = kind == LensKind::kPinhole || kind == LensKind::kTangential;
  const double fx = is_plain ? random->LogUniform(50.0, 50'000.0) : random->LogUniform(50.0, 400.0);
  const double fy = fx * random->Uniform(0.6, 1.7);
  const double skew = random->Chance(0.5) ? fx * random->Uniform(-0.2, 0.2) : 0.0;
  c.camera_matrix << fx, skew, c.image_width_px * random->Uniform(0.3, 0.7), 0.0, fy,
      c.image_height_px * random->Uniform(0.3, 0.7), 0.0, 0.0, 1.0;
  c = RandomLens(random, kind, std::move(c));
  // Near cameras stand inside the workspace; far ones so that 100 mm about fill the picture.
  const double filling_mm = 100.0 * fx / c.image_width_px;
  const double distance_mm =
      random->Chance(0.2) ? random->LogUniform(1.0, 150.0) : filling_mm * random->Uniform(0.5, 2.0);
  const Vector3d eye = distance_mm * random->Direction();
  const Vector3d target = random->Uniform(0.0, 40.0) * random->Direction();
  c.cam_from_world = core::CamFromWorldLookingAt(eye, target, random->Direction());
  return core::CameraModel(std::move(c));
}

core::BitMask BlobMask(Random* random, int width_px, int height_px) {
  core::BitMask mask(width_px, height_px);
  const double size_px = std::min(width_px, height_px);
  for (int n = random->Whole(2, 6); n > 0; --n) {
    PaintDisc(&mask, random->Uniform(0.3, 0.7) * width_px, random->Uniform(0.3, 0.7) * height_px,
              random->Uniform(0.1, 0.25) * size_px, true);
  }
  return mask;
}

core::BitMask RandomMask(Random* random, int width_px, int height_px) {
  const int kind = random->Whole(0, 13);
  core::BitMask mask(width_px, height_px);
  if (kind == 0) return mask;
  if (kind == 1) {
    PaintAll(&mask, [](int, int) { return true; });
  } else if (kind == 2) {  // a few single pixels, object or holes
    const bool object = random->Chance(0.5);
    PaintAll(&mask, [&](int, int) { return !object; });
    for (int n = random->Whole(1, 4); n > 0; --n)
      mask.Set(random->Whole(0, width_px - 1), random->Whole(0, height_px - 1), object);
  } else if (kind == 3) {  // stripes one pixel wide and wider
    const int period_px = random->Whole(2, 9);
    const bool across = random->Chance(0.5);
    PaintAll(&mask, [&](int x, int y) { return (across ? x : y) % period_px == 0; });
  } else if (kind == 4) {  // noise
    const double share = random->Uniform(0.01, 0.99);
    PaintAll(&mask, [&](int, int) { return random->Chance(share); });
  } else {
    mask = DiscsMask(random, width_px, height_px, kind % 2 == 0);
  }
  return mask;
}

core::SoftMask RandomLevels(Random* random, core::BitMask mask) {
  core::SoftMask soft{std::move(mask), {}};
  const core::BitMask boundary = core::BoundaryPixels(soft.mask);
  for (int y = 0; y < boundary.height_px(); ++y) {
    for (int x = 0; x < boundary.width_px(); ++x) {
      if (!boundary.At(x, y)) continue;
      const bool is_object = soft.mask.At(x, y);
      soft.levels.push_back(
          static_cast<std::uint8_t>(is_object ? random->Whole(128, 255) : random->Whole(0, 127)));
    }
  }
  return soft;
}

RandomScene MakeRandomScene(Random* random) {
  core::Rig rig;
  rig.name = "random";
  const double half_mm = random->LogUniform(30.0, 400.0);
  rig.workspace_mm = {Vector3d::Constant(-half_mm) + 0.3 * half_mm * random->Direction(),
                      Vector3d::Constant(half_mm) + 0.3 * half_mm * random->Direction()};
  rig.unseen = random->Chance(0.5) ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
  RandomScene scene;
  for (int n = random->Whole(1, 5); n > 0; --n) {
    const auto kind = static_cast<LensKind>(random->Whole(0, kLensKinds - 1));
    rig.cameras.push_back(RandomCamera(random, kind));
    const core::CameraModel& camera = rig.cameras.back();
    scene.masks.push_back(RandomMask(random, camera.width_px(), camera.height_px()));
  }
  scene.rig = std::make_shared<const core::Rig>(std::move(rig));
  return scene;
}

RandomScene MakeRingScene(Random* random, int cameras, core::UnseenPolicy unseen) {
  core::Rig rig;
  rig.name = "ring";
  rig.workspace_mm = {Vector3d(-150, -140, -130), Vector3d(160, 150, 140)};
  rig.unseen = unseen;
  RandomScene scene;
  for (int i = 0; i < cameras; ++i) {
    core::CameraCalibration c;
    c.name = "ring " + std::to_string(i + 1);
    c.image_width_px = 160;
    c.image_height_px = 120;
    c.camera_matrix << 190.0, 0.0, 79.0, 0.0, 200.0, 61.0, 0.0, 0.0, 1.0;
    c.distortion_coefficients = {-0.2, 0.05, 1e-3, -5e-4, 0.0};
    const double angle_rad = 2.0 * M_PI * (i + random->Uniform(-0.2, 0.2)) / cameras;
    const Vector3d eye(std::cos(angle_rad), std::sin(angle_rad), random->Uniform(-0.3, 1.2));
    c.cam_from_world =
        core::CamFromWorldLookingAt(eye.normalized() * random->Uniform(400.0, 900.0), Vector3d::Zero());
    rig.cameras.emplace_back(std::move(c));
    scene.masks.push_back(BlobMask(random, 160, 120));
  }
  scene.rig = std::make_shared<const core::Rig>(std::move(rig));
  return scene;
}

}  // namespace elbowroom::recon
