// Boundaries located between pixels, in every command that segments a frame.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "cad_import/mesh_file.h"
#include "core/bvh.h"
#include "recon/exact_view/hull_view.h"
#include "recon/footage/recorded_rig.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "recon/images/mask_image.h"
#include "recon/paper_methods/plane_sweep.h"
#include "recon/segmentation/frame_segmenter.h"
#include "review/contacts.h"
#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom {
namespace {

class FootageCommands : public testing::Test {
 protected:
  FootageCommands() {
    recon::RecordedRig source(recon::ReadRigFile(file_), {});
    rig_ = std::make_shared<const core::Rig>(source.rig());
    const recon::FrameSegmenter segmenter(source.ReadBackgrounds({}, {}), {}, *rig_);
    const recon::FrameSet frames = source.Read(0);
    located_ = segmenter.SegmentSoft(frames);
    for (core::BitMask& mask : segmenter.Segment(frames)) detected_.push_back({std::move(mask), {}});
  }

  // Of `elbowroom COMMAND RIG.yml --frame 0 ... --json`.
  [[nodiscard]] nlohmann::json Run(const std::string& command, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {command, file_.string(), "--frame", "0", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const test_support::ProgramRun run = test_support::RunProgram(test_support::ProgramFile(), arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }

  [[nodiscard]] cv::Mat Depth(const std::string& method, const std::string& camera) const {
    const std::string tiff = (folder_ / "depth.tiff").string();
    (void)Run("view", {"--camera", camera, "--method", method, "--depth", tiff});
    return cv::imread(tiff, cv::IMREAD_UNCHANGED);
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path file_ = test_support::WriteBallFootage(folder_.path() / "rig");
  std::shared_ptr<const core::Rig> rig_;
  std::vector<core::SoftMask> located_;
  std::vector<core::SoftMask> detected_;  // as the thresholds have them
};

cv::Mat MatOf(std::span<const float> depth_mm, const cv::Mat& like) {
  return cv::Mat(like.size(), CV_32FC1, const_cast<float*>(depth_mm.data())).clone();
}

TEST_F(FootageCommands, SegmentWritesTheLocatedPixels) {
  const nlohmann::json json = Run("segment", {"--out", (folder_ / "masks").string()});
  ASSERT_EQ(json["masks"].size(), located_.size());
  for (std::size_t i = 0; i < located_.size(); ++i) {
    EXPECT_FALSE(located_[i].levels.empty());
    EXPECT_EQ(json["masks"][i]["object_pixels"], located_[i].mask.CountObjectPixels());
    EXPECT_LT(located_[i].mask.CountObjectPixels(), detected_[i].mask.CountObjectPixels());
    const cv::Mat png = cv::imread(json["masks"][i]["file"].get<std::string>(), cv::IMREAD_UNCHANGED);
    EXPECT_EQ(cv::norm(png, recon::ImageFromMask(located_[i].mask), cv::NORM_INF), 0.0);
  }
}

TEST_F(FootageCommands, HullIsThatOfTheLocatedBoundaries) {
  constexpr double kEdgeMm = 4.0;
  const auto volume_mm3 = [&](const auto& masks) {
    return core::VolumeMm3(recon::MeshHull(recon::MakeVisualHull(rig_, masks), kEdgeMm).mesh);
  };
  const double by_program_mm3 =
      Run("hull", {"--edge", "4", "--out", (folder_ / "hull.ply").string()})["volume_mm3"];
  EXPECT_DOUBLE_EQ(by_program_mm3, volume_mm3(located_));

  // Against perfect silhouettes: what thresholds find is larger by what they count as object at its rim.
  const std::filesystem::path ready = test_support::WriteBallRig(folder_.path() / "ready");
  recon::RecordedRig source(recon::ReadRigFile(ready), {});
  std::vector<core::BitMask> true_masks;
  for (const recon::CameraFrame& camera : source.Read(0).cameras) true_masks.push_back(*camera.ready_mask);
  const double true_mm3 = volume_mm3(true_masks);
  EXPECT_NEAR(by_program_mm3, true_mm3, 0.006 * true_mm3);
  EXPECT_GT(volume_mm3(detected_), 1.015 * true_mm3);
}

TEST_F(FootageCommands, ViewSeesTheLocatedBoundaries) {
  recon::RigFile view{*rig_, {{}}};
  core::CameraCalibration beside = rig_->cameras[0].calibration();
  beside.cam_from_world = core::CamFromWorldLookingAt({500.0, -400.0, 450.0}, {0.0, 0.0, 200.0});
  const core::CameraModel camera(beside);
  view.rig.cameras.assign(1, camera);
  recon::WriteRigFile(view, folder_ / "view.yml");
  const auto exact = [&](const auto& masks) {
    return recon::ViewHull(recon::MakeVisualHull(rig_, masks), camera).depth_mm;
  };
  const auto swept = [&](const auto& masks) {
    return recon::SweepPlanes(*rig_, masks, camera, recon::SweepRays(camera), {}).picture.depth_mm;
  };
  const cv::Mat by_exact = Depth("exact", (folder_ / "view.yml").string());
  const cv::Mat by_sweep = Depth("sweep", (folder_ / "view.yml").string());
  EXPECT_EQ(cv::norm(by_exact, MatOf(exact(located_), by_exact), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(by_exact, MatOf(exact(detected_), by_exact), cv::NORM_INF), 0.1);
  EXPECT_EQ(cv::norm(by_sweep, MatOf(swept(located_), by_sweep), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(by_sweep, MatOf(swept(detected_), by_sweep), cv::NORM_INF), 0.1);
}

TEST_F(FootageCommands, ContactsTouchTheLocatedBoundaries) {
  const std::filesystem::path box = folder_ / "box.stl";
  test_support::WriteBoxStl(box, 380.0);  // its top face cuts the ball
  const core::TriangleTree part(
      cad_import::ImportMeshFile(box, {.unit = core::LengthUnit::kMillimetre}).mesh);
  const auto area_mm2 = [&](const auto& masks) {
    return review::FindContacts(recon::MakeVisualHull(rig_, masks), part, {}, 0, {}).contact_area_mm2;
  };
  const nlohmann::json json = Run("contacts", {"--mesh", box.string(), "--unit", "mm"});
  EXPECT_EQ(json["verdict"], "contact");
  EXPECT_DOUBLE_EQ(json["contact_area_mm2"], area_mm2(located_));
  EXPECT_GT(area_mm2(detected_), 1.005 * area_mm2(located_));
}

}  // namespace
}  // namespace elbowroom
