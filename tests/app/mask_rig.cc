#include "tests/app/mask_rig.h"

#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>

#include "cad_import/mesh_file.h"
#include "core/error.h"
#include "core/rigid_transform.h"
#include "recon/images/mask_image.h"
#include "recon/rig_files/rig_file.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::test_support {
namespace {

constexpr double kRigRadiusMm = 900.0;

core::Rig FourAround() {
  core::Rig rig;
  rig.name = "ball";
  rig.workspace_mm = Eigen::AlignedBox3d(Eigen::Vector3d(-150, -150, 50), Eigen::Vector3d(150, 150, 350));
  const Eigen::Vector3d target(0, 0, 200);
  const Eigen::Vector3d directions[] = {{1, 0, 0.3}, {0, 1, 0.3}, {-0.7, -0.7, 0.2}, {0.1, 0.2, 1.0}};
  for (const Eigen::Vector3d& direction : directions) {
    core::CameraCalibration camera;
    camera.name = "cam" + std::to_string(rig.cameras.size() + 1);
    camera.image_width_px = 320;
    camera.image_height_px = 240;
    camera.camera_matrix << 500, 0, 159.5, 0, 500, 119.5, 0, 0, 1;
    camera.cam_from_world =
        core::CamFromWorldLookingAt(target + kRigRadiusMm * direction.normalized(), target);
    rig.cameras.emplace_back(camera);
  }
  return rig;
}

core::TriangleMesh Box(double size_mm) {
  core::TriangleMesh box;
  for (int i = 0; i < 8; ++i) {
    box.vertices_mm.emplace_back(Eigen::Vector3d((i & 1) - 0.5, ((i >> 1) & 1) - 0.5, (i >> 2) - 0.5) *
                                 size_mm);
  }
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

recon::SyntheticObject Ball() {
  recon::SyntheticObject ball{"ball", {{recon::Sphere{kBallRadiusMm}, {}, Eigen::Vector3d::Constant(200)}}};
  ball.solids[0].world_from_solid.translation_mm = {0, 0, 200};
  return ball;
}

void WritePictures(const recon::FrameSet& pictures, const core::Rig& rig, const std::filesystem::path& folder,
                   const std::string& name) {
  for (std::size_t i = 0; i < pictures.cameras.size(); ++i) {
    const std::filesystem::path camera_folder = folder / rig.cameras[i].name();
    std::filesystem::create_directories(camera_folder);
    core::Require(cv::imwrite((camera_folder / name).string(), pictures.cameras[i].image_bgr),
                  "a test's folder can be written");
  }
}

}  // namespace

std::filesystem::path WriteBallRig(const std::filesystem::path& folder) {
  recon::RigFile file{FourAround(), {}};
  const recon::SyntheticRig rig(file.rig, [&](double) { return std::vector{Ball()}; });
  const std::vector<core::BitMask> masks = rig.TrueMasks(std::vector{Ball()});
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const std::filesystem::path camera_folder = folder / file.rig.cameras[i].name();
    std::filesystem::create_directories(camera_folder);
    recon::WriteMaskPng(masks[i], camera_folder / "mask_0000.png");
    file.sources.push_back({"", "", (camera_folder / "mask_%04d.png").string()});
  }
  recon::WriteRigFile(file, folder / "rig.yml");
  return folder / "rig.yml";
}

std::filesystem::path WriteBallFootage(const std::filesystem::path& folder) {
  constexpr core::FrameIndex kBackgroundFrames = 4;
  recon::RigFile file{FourAround(), {}};
  recon::SyntheticRigOptions options;
  options.samples_per_pixel_side = 4;
  const auto scene_at = [](double time_s) {
    return time_s == 0.0 ? std::vector{Ball()} : std::vector<recon::SyntheticObject>();
  };
  recon::SyntheticRig source(file.rig, scene_at, options);
  WritePictures(source.Read(0), file.rig, folder, "ball_0000.png");
  for (core::FrameIndex i = 0; i < kBackgroundFrames; ++i)
    WritePictures(source.Read(i + 1), file.rig, folder, fmt::format("cloth_{:04d}.png", i));
  for (const core::CameraModel& camera : file.rig.cameras) {
    const std::filesystem::path camera_folder = folder / camera.name();
    file.sources.push_back(
        {(camera_folder / "ball_%04d.png").string(), (camera_folder / "cloth_%04d.png").string(), ""});
  }
  recon::WriteRigFile(file, folder / "rig.yml");
  return folder / "rig.yml";
}

void WriteBoxStl(const std::filesystem::path& file, double size_mm) {
  cad_import::WriteMeshFile(Box(size_mm), file);
}

void WriteHollowBoxStl(const std::filesystem::path& file, double size_mm, double cavity_mm) {
  core::TriangleMesh mesh = Box(size_mm), cavity = Box(cavity_mm);
  for (auto& triangle : cavity.triangles) std::swap(triangle[1], triangle[2]);
  core::Append(mesh, cavity);
  cad_import::WriteMeshFile(mesh, file);
}

}  // namespace elbowroom::test_support
