// elbowroom view along parallel rays, and with silhouettes that are known between pixels.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "recon/footage/recorded_rig.h"
#include "recon/hull/visual_hull.h"
#include "recon/rig_files/rig_file.h"
#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;

// From above, one pixel a 1.25 mm, x to world x, y to minus world y.
constexpr double kPxPerMm = 0.8;
constexpr int kWidthPx = 150, kHeightPx = 130;
constexpr double kCenterX = 74.5, kCenterY = 64.5;

class OrthographicView : public testing::Test {
 protected:
  struct Seen {
    nlohmann::json json;
    cv::Mat depth_mm;
    cv::Mat picture;
  };

  [[nodiscard]] std::string WriteView(double above_mm, double center_x_px) const {
    const std::filesystem::path file = folder_ / "view.yml";
    test_support::WriteText(
        file, fmt::format("%YAML:1.0\n---\nprojection: \"orthographic\"\nimage_width: {}\nimage_height: {}\n"
                          "camera_matrix: [ {}, 0, {}, 0, {}, {}, 0, 0, 1 ]\n"
                          "distortion_model: \"plumb_bob\"\ndistortion_coefficients: [ 0, 0, 0, 0, 0 ]\n"
                          "rotation_cam_from_world: [ 1, 0, 0,  0, -1, 0,  0, 0, -1 ]\n"
                          "translation_cam_from_world_mm: [ 0, 0, {} ]\n",
                          kWidthPx, kHeightPx, kPxPerMm, center_x_px, kPxPerMm, kCenterY, above_mm));
    return file.string();
  }

  [[nodiscard]] ProgramRun View(const std::string& view, const std::string& method) const {
    return test_support::RunProgram(
        test_support::ProgramFile(),
        {"view", rig_.string(), "--frame", "0", "--camera", view, "--method", method, "--depth",
         (folder_ / "o.tiff").string(), "--image", (folder_ / "o.png").string(), "--json"});
  }

  [[nodiscard]] Seen See(double above_mm, double center_x_px = kCenterX) const {
    const ProgramRun run = View(WriteView(above_mm, center_x_px), "exact");
    EXPECT_EQ(run.exit_status, 0) << run.err;
    if (run.exit_status != 0) return {};
    return {nlohmann::json::parse(run.out), cv::imread((folder_ / "o.tiff").string(), cv::IMREAD_UNCHANGED),
            cv::imread((folder_ / "o.png").string(), cv::IMREAD_COLOR)};
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path rig_ = test_support::WriteBallRig(folder_.path() / "rig");
};

TEST_F(OrthographicView, FindsWhereEachParallelRayEntersTheHull) {
  constexpr double kAboveMm = 500.0;
  const Seen seen = See(kAboveMm);
  ASSERT_EQ(seen.depth_mm.size(), cv::Size(kWidthPx, kHeightPx));
  EXPECT_EQ(seen.json["hit_pixels"], cv::countNonZero(seen.depth_mm));

  recon::RecordedRig source(recon::ReadRigFile(rig_), {});
  std::vector<core::BitMask> masks;
  for (const recon::CameraFrame& camera : source.Read(0).cameras) masks.push_back(*camera.ready_mask);
  const recon::VisualHull hull = recon::MakeVisualHull(std::make_shared<core::Rig>(source.rig()), masks);
  constexpr double kDepthErrorMm = 0.01;  // float32 at 500 mm, with room
  int hits = 0, wrong = 0;
  for (int y = 0; y < kHeightPx; ++y) {
    for (int x = 0; x < kWidthPx; ++x) {
      const auto contains = [&](double depth_mm) {
        return hull.Contains({(x - kCenterX) / kPxPerMm, -(y - kCenterY) / kPxPerMm, kAboveMm - depth_mm});
      };
      const double depth_mm = seen.depth_mm.at<float>(y, x);
      const double first_mm = depth_mm == 0.0 ? 450.0 : depth_mm - kDepthErrorMm;
      for (double before_mm = 150.0; before_mm < first_mm; before_mm += 3.0) wrong += contains(before_mm);
      if (depth_mm == 0.0) continue;
      ++hits;
      wrong += contains(depth_mm - kDepthErrorMm) || !contains(depth_mm + kDepthErrorMm);
    }
  }
  const double ball_px = M_PI * std::pow(kPxPerMm * test_support::kBallRadiusMm, 2);
  EXPECT_GT(hits, ball_px);  // the hull holds the ball, and its drawing is to scale
  EXPECT_LT(hits, 1.4 * ball_px);
  EXPECT_LE(wrong, 2);  // rays that cut less than 0.01 mm off a corner
}

TEST_F(OrthographicView, HasNoVanishingPoint) {
  const Seen near = See(400.0), far = See(900.0), within = See(200.0), shifted = See(400.0, kCenterX - 30.0);
  // Farther away all is as large, and as much deeper; from the ball's middle its upper half lies behind.
  EXPECT_EQ(far.json["hit_pixels"], near.json["hit_pixels"]);
  const cv::Mat hit = near.depth_mm != 0.0F;
  EXPECT_LE(cv::norm(far.depth_mm - near.depth_mm, cv::Mat(hit.size(), CV_32F, 500.0F), cv::NORM_INF, hit),
            1e-3);
  EXPECT_LE(cv::norm(near.depth_mm - within.depth_mm, cv::Mat(hit.size(), CV_32F, 200.0F), cv::NORM_INF, hit),
            1e-3);
  EXPECT_LT(within.depth_mm.at<float>(65, 75), -test_support::kBallRadiusMm + 1.0);
  // Light and eye have the same direction all over: whatever moves in the picture keeps its colours.
  ASSERT_GT(cv::countNonZero(hit), 1000);
  for (const Seen* other : {&far, &within})
    EXPECT_EQ(cv::norm(near.picture, other->picture, cv::NORM_INF), 0.0);
  const cv::Rect there(30, 0, kWidthPx - 30, kHeightPx), here(0, 0, kWidthPx - 30, kHeightPx);
  EXPECT_EQ(cv::norm(near.picture(there), shifted.picture(here), cv::NORM_INF, hit(there)), 0.0);
  EXPECT_GT(cv::norm(near.picture.at<cv::Vec3b>(65, 40), near.picture.at<cv::Vec3b>(65, 110)), 10.0)
      << "shaded";
}

TEST_F(OrthographicView, NeedsNoLens) {
  const std::string view = WriteView(400.0, kCenterX);
  ASSERT_EQ(View(view, "exact").exit_status, 0);
  const std::string with_lens = test_support::ReadText(folder_ / "o.tiff");
  std::string text = test_support::ReadText(view);
  const std::size_t begin = text.find("distortion_model");
  text.erase(begin, text.find("rotation_cam_from_world") - begin);
  test_support::WriteText(view, text);
  const ProgramRun run = View(view, "exact");
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(test_support::ReadText(folder_ / "o.tiff"), with_lens);
}

TEST_F(OrthographicView, IsRefusedByTheSweepsInOneLine) {
  const std::string view = WriteView(500.0, kCenterX);
  for (const char* method : {"sweep", "sweep-gl"}) {
    const ProgramRun run = View(view, method);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    for (const char* word : {"view.yml", method, "perspective", "exact"})
      EXPECT_NE(run.err.find(word), std::string::npos) << word << " in: " << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "o.tiff"));
  }
}

// The ball from the side, by any method.
class UndistortionGrid : public testing::Test {
 protected:
  [[nodiscard]] ProgramRun View(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"view",     rig_.string(),    "--frame", "0",
                                 "--camera", camera_.string(), "--depth", (folder_ / "d.tiff").string(),
                                 "--json"};
    all.insert(all.end(), more.begin(), more.end());
    return test_support::RunProgram(test_support::ProgramFile(), all);
  }

  [[nodiscard]] nlohmann::json Sweep(const std::string& method, const std::string& cells) const {
    const ProgramRun run = View({"--method", method, "--undistortion-grid", cells});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }

  static std::filesystem::path WriteCamera(const std::filesystem::path& file) {
    core::CameraCalibration c;
    c.name = "view";
    c.image_width_px = 160;
    c.image_height_px = 120;
    c.camera_matrix << 300.0, 0.0, 79.5, 0.0, 300.0, 59.5, 0.0, 0.0, 1.0;
    c.cam_from_world = core::CamFromWorldLookingAt({300.0, -350.0, 450.0}, {0.0, 0.0, 200.0});
    core::Rig rig;
    rig.workspace_mm = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()};
    rig.cameras.emplace_back(c);
    recon::WriteRigFile({rig, {{}}}, file);
    return file;
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path rig_ = test_support::WriteBallRig(folder_.path() / "rig"),
                        camera_ = WriteCamera(folder_ / "camera.yml");
};

TEST_F(UndistortionGrid, IsTakenByTheSweeps) {
  constexpr double kRim = 0.02;  // of the pixels
  for (const std::string method : {"sweep", "sweep-gl"}) {
    const nlohmann::json plain = Sweep(method, "0"), grid = Sweep(method, "5");
    EXPECT_EQ(plain["undistortion_grid"], 0);
    EXPECT_EQ(grid["undistortion_grid"], 5);
    EXPECT_GT(grid["tested_points"], plain["tested_points"]) << "every point is asked with a grid";
    ASSERT_GT(plain["hit_pixels"], 1000);
    EXPECT_NEAR(grid["hit_pixels"], plain["hit_pixels"], kRim * plain["hit_pixels"].get<double>());
  }
}

TEST_F(UndistortionGrid, IsRefusedWhereThereAreNoPlanes) {
  EXPECT_EQ(View({"--undistortion-grid", "5"}).exit_status, 2);
  EXPECT_EQ(View({"--method", "exact", "--undistortion-grid", "5"}).exit_status, 2);
  EXPECT_EQ(View({"--method", "sweep", "--undistortion-grid", "-1"}).exit_status, 2);
  EXPECT_EQ(View({"--method", "sweep", "--undistortion-grid", "1025"}).exit_status, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "d.tiff"));
}

}  // namespace
}  // namespace elbowroom
