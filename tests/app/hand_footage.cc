#include "tests/app/hand_footage.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <string>

#include "recon/images/mask_image.h"
#include "recon/rig_files/rig_file.h"
#include "tests/recon/consistency/hand_stage.h"
#include "tests/recon/consistency/tangent_footage.h"
#include "tests/support/text_file.h"

namespace elbowroom::test_support {
namespace {

using recon::testing::CapsuleCamera;
using recon::testing::HandStage;

// The camera as it stands after the knock.
CapsuleCamera KnockedCamera(const HandStage& stage, const CameraKnock& knock) {
  const Eigen::Vector3d about = Eigen::Vector3d(0.5, 1.0, 0.3).normalized();
  const recon::PoseChange change =
      recon::testing::ChangeOfSize(stage.pairs, knock.camera, about, Eigen::Vector3d::Zero(), knock.turn_px);
  core::CameraCalibration calibration = stage.rig.cameras[knock.camera].calibration();
  const core::RigidTransform turned_from_cam{
      Eigen::AngleAxisd(change.head<3>().norm(), about).toRotationMatrix(), Eigen::Vector3d::Zero()};
  calibration.cam_from_world = turned_from_cam * calibration.cam_from_world;
  core::Rig rig = stage.rig;
  rig.cameras[knock.camera] = core::CameraModel(calibration);
  return HandStage(rig).cameras[knock.camera];
}

}  // namespace

std::filesystem::path WriteHandFootage(const std::filesystem::path& folder, const HandFootage& footage) {
  const HandStage stage(recon::testing::HandRig(static_cast<int>(footage.offset_s.size())));
  std::optional<CapsuleCamera> knocked;
  if (footage.knock) knocked = KnockedCamera(stage, *footage.knock);
  recon::RigFile file{stage.rig, {}};
  const int frames = static_cast<int>(footage.seconds * footage.rate_hz);
  for (core::CameraIndex i = 0; i < footage.offset_s.size(); ++i) {
    const std::filesystem::path camera_folder = folder / stage.rig.cameras[i].name();
    std::filesystem::create_directories(camera_folder);
    const double phase_s = 0.007 * static_cast<double>(i);
    std::string stamps = "frame,time_s\n";
    for (int frame = 0; frame < frames; ++frame) {
      const double stamp_s = frame / footage.rate_hz + phase_s, scene_s = stamp_s + footage.offset_s[i];
      const bool is_knocked = knocked && footage.knock->camera == i && scene_s >= footage.knock->at_s;
      const CapsuleCamera& camera = is_knocked ? *knocked : stage.cameras[i];
      const std::vector<recon::Solid> hands = recon::testing::HandsAt(footage.motion, scene_s);
      recon::WriteMaskPng(camera.MaskOf(hands).mask, camera_folder / fmt::format("mask_{:04}.png", frame));
      stamps += fmt::format("{},{:.6f}\n", frame, stamp_s);
    }
    WriteText(camera_folder / "stamps.csv", stamps);
    file.sources.push_back({"", "", (camera_folder / "mask_%04d.png").string()});
    file.sources.back().timestamps = (camera_folder / "stamps.csv").string();
  }
  recon::WriteRigFile(file, folder / "rig.yml");
  return folder / "rig.yml";
}

}  // namespace elbowroom::test_support
