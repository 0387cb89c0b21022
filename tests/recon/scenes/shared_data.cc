#include "tests/recon/scenes/shared_data.h"
#include "tests/support/places.h"

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "recon/images/mask_image.h"

namespace elbowroom::recon {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = test_support::SharedDataFolder();

core::CameraModel ReadCamera(const cv::FileNode& node) {
  cv::Mat k, d, r, t;
  node["camera_matrix"] >> k;
  node["distortion_coefficients"] >> d;
  node["rotation_cam_from_world"] >> r;
  node["translation_cam_from_world_mm"] >> t;
  core::CameraCalibration c;
  c.name = static_cast<std::string>(node["name"]);
  c.image_width_px = static_cast<int>(node["image_width"]);
  c.image_height_px = static_cast<int>(node["image_height"]);
  c.distortion_model = core::ParseDistortionModel(static_cast<std::string>(node["distortion_model"])).value();
  c.distortion_coefficients.assign(d.begin<double>(), d.end<double>());
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      c.camera_matrix(i, j) = k.at<double>(i, j);
      c.cam_from_world.rotation(i, j) = r.at<double>(i, j);
    }
    c.cam_from_world.translation_mm[i] = t.at<double>(i);
  }
  return core::CameraModel(std::move(c));
}

}  // namespace

std::optional<RandomScene> ReadSharedScene(const std::string& set) {
  const fs::path folder = kRoot / set;
  if (!fs::exists(folder)) return std::nullopt;
  const cv::FileStorage file((folder / "rig.yml").string(), cv::FileStorage::READ);
  if (!file.isOpened()) throw std::runtime_error("can't read the rig in " + folder.string());
  core::Rig rig;
  rig.name = static_cast<std::string>(file["rig_name"]);
  std::vector<double> box;
  file["workspace_mm"] >> box;
  rig.workspace_mm = {Eigen::Vector3d(box.at(0), box.at(1), box.at(2)),
                      Eigen::Vector3d(box.at(3), box.at(4), box.at(5))};
  const bool abstain = static_cast<std::string>(file["unseen"]) == "abstain";
  rig.unseen = abstain ? core::UnseenPolicy::kAbstain : core::UnseenPolicy::kOutside;
  RandomScene scene;
  for (const cv::FileNode& node : file["cameras"]) {
    rig.cameras.push_back(ReadCamera(node));
    std::string name = static_cast<std::string>(node["masks"]);
    if (const auto number = name.find("%04d"); number != std::string::npos) name.replace(number, 4, "0000");
    scene.masks.push_back(ReadMaskImage(folder / name, set));
  }
  scene.rig = std::make_shared<const core::Rig>(std::move(rig));
  return scene;
}

std::vector<Eigen::Vector3d> ReadPlyVertices(const std::string& path_in_shared_data) {
  std::ifstream file(kRoot / path_in_shared_data);
  std::size_t count = 0;
  for (std::string line; std::getline(file, line) && !line.starts_with("end_header");) {
    if (line.starts_with("element vertex ")) count = std::stoul(line.substr(15));
  }
  std::vector<Eigen::Vector3d> vertices(count);
  for (Eigen::Vector3d& v : vertices) file >> v.x() >> v.y() >> v.z();
  if (!file || count == 0) throw std::runtime_error("can't read " + path_in_shared_data);
  return vertices;
}

}  // namespace elbowroom::recon
