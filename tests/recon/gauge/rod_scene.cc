#include "tests/recon/gauge/rod_scene.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include "core/units.h"
#include "recon/segmentation/frame_segmenter.h"
#include "recon/synthetic/actors.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::recon::testing {
namespace {

using Eigen::Vector3d;

Eigen::Matrix3d Towards(const Vector3d& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), direction).toRotationMatrix();
}

}  // namespace

SyntheticObject RodObject(const Rod& rod) {
  const Vector3d direction = rod.direction_in_world.normalized();
  Solid solid{Tube{0.5 * rod.diameter_mm, 0.0, rod.length_mm}, {}, Vector3d::Constant(210.0)};
  solid.world_from_solid.rotation = Towards(direction);
  solid.world_from_solid.translation_mm = rod.middle_in_world - 0.5 * rod.length_mm * direction;
  return {"rod", {solid}};
}

SyntheticObject BowedRod(const Rod& rod, double bow_mm) {
  constexpr int kPieces = 60;
  const Vector3d direction = rod.direction_in_world.normalized();
  const Vector3d aside = (std::abs(direction.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX())
                             .cross(direction)
                             .cross(direction);
  const auto at = [&](int k) -> Vector3d {
    const double s = 2.0 * k / kPieces - 1.0;
    return rod.middle_in_world + 0.5 * s * rod.length_mm * direction +
           bow_mm * (s * s - 1.0) * aside.normalized();
  };
  SyntheticObject object{"bowed rod", {}};
  for (int k = 0; k < kPieces; ++k)
    object.solids.push_back(CapsuleBetween(at(k), at(k + 1), 0.5 * rod.diameter_mm, Vector3d::Constant(210)));
  return object;
}

SyntheticObject HandAtTheEnd(const Rod& rod) {
  const Vector3d direction = rod.direction_in_world.normalized();
  const Vector3d end = rod.middle_in_world - 0.5 * rod.length_mm * direction;
  core::RigidTransform world_from_wrist;
  // Fingers across the rod, the palm on it.
  const Vector3d across = direction.unitOrthogonal();
  world_from_wrist.rotation.col(0) = across;
  world_from_wrist.rotation.col(1) = direction;
  world_from_wrist.rotation.col(2) = across.cross(direction);
  world_from_wrist.translation_mm = end - 80.0 * across + 20.0 * direction;
  const Vector3d elbow = world_from_wrist.translation_mm - 260.0 * across;
  return Hand(world_from_wrist, PipePinch(), elbow);
}

std::vector<Rod> TwentySevenRods(const core::Rig& rig, double share, double diameter_mm, double length_mm,
                                 unsigned draw) {
  std::vector<Rod> rods;
  std::mt19937 random(draw);
  std::uniform_real_distribution<double> within(-0.5, 0.5);
  std::normal_distribution<double> normal;
  const Vector3d center = rig.workspace_mm.center(), size = share * rig.workspace_mm.sizes();
  for (int k = 0; k < 27; ++k) {
    const Vector3d cell(k % 3 - 1, (k / 3) % 3 - 1, k / 9 - 1);
    // Evenly over the half sphere: a golden spiral.
    const double z = (k + 0.5) / 27.0, angle = k * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double flat = std::sqrt(1.0 - z * z);
    rods.push_back({center + cell.cwiseProduct(size) / 3.0,
                    Vector3d(flat * std::cos(angle), flat * std::sin(angle), z), diameter_mm, length_mm});
    if (draw == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      rods.back().middle_in_world[axis] += within(random) * size[axis] / 3.0;
      rods.back().direction_in_world[axis] = normal(random);
    }
  }
  return rods;
}

struct RodStage::Inside {
  std::vector<SyntheticObject> objects;
  std::unique_ptr<SyntheticRig> rig;
  std::unique_ptr<FrameSegmenter> segmenter;  // null: ready masks
};

RodStage::RodStage(const core::Rig& rig, Silhouettes silhouettes) : inside_(std::make_unique<Inside>()) {
  SyntheticRigOptions options;
  options.noise_sigma_levels = 0.02 * 255.0;
  options.samples_per_pixel_side = 8;
  options.background_frames = 10;
  Inside* inside = inside_.get();
  inside->rig = std::make_unique<SyntheticRig>(
      rig, [inside](double) { return inside->objects; }, options);
  if (silhouettes == Silhouettes::kSegmented)
    inside->segmenter =
        std::make_unique<FrameSegmenter>(inside->rig->ReadBackgrounds({}, {}), SegmentationOptions(), rig);
}

RodStage::~RodStage() = default;

std::vector<core::SoftMask> RodStage::MasksOf(const std::vector<SyntheticObject>& objects) {
  inside_->objects = objects;
  if (inside_->segmenter) return inside_->segmenter->SegmentSoft(inside_->rig->TryRead(0, {}).value());
  std::vector<core::SoftMask> masks;
  for (core::BitMask& mask : inside_->rig->TrueMasks(objects)) masks.push_back({std::move(mask), {}});
  return masks;
}

core::Rig RingRig(int cameras) {
  core::Rig rig;
  rig.name = "ring";
  rig.workspace_mm = {Vector3d(-250, -250, 0), Vector3d(250, 250, 400)};
  const Vector3d target(0, 0, 200);
  for (int i = 0; i < cameras; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / cameras;
    core::CameraCalibration camera;
    camera.name = "cam" + std::to_string(i + 1);
    camera.image_width_px = 640;
    camera.image_height_px = 480;
    camera.camera_matrix << 720, 0, 319.5, 0, 720, 239.5, 0, 0, 1;
    camera.distortion_coefficients = {-0.08, 0.02, 0.0005, -0.0004, 0.0};
    const Vector3d eye =
        target + Vector3d(1200 * std::cos(angle), 1200 * std::sin(angle), i % 2 == 0 ? 700 : 150);
    camera.cam_from_world = core::CamFromWorldLookingAt(eye, target);
    rig.cameras.emplace_back(camera);
  }
  return rig;
}

core::Rig WithTurnedCamera(const core::Rig& rig, std::size_t camera, double angle_deg,
                           const Vector3d& about_in_world) {
  core::Rig turned = rig;
  core::CameraCalibration calibration = rig.cameras[camera].calibration();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(core::RadiansFromDegrees(angle_deg), about_in_world.normalized()).toRotationMatrix();
  const Vector3d center = rig.cameras[camera].center_in_world();
  calibration.cam_from_world.rotation = calibration.cam_from_world.rotation * turn;
  calibration.cam_from_world.translation_mm = -calibration.cam_from_world.rotation * center;
  turned.cameras[camera] = core::CameraModel(calibration);
  return turned;
}

}  // namespace elbowroom::recon::testing
