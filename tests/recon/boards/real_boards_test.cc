// Boards in photos and videos of real cameras, which others made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "recon/boards/board_finder.h"
#include "tests/support/places.h"

namespace elbowroom::recon {
namespace {

namespace fs = std::filesystem;

const fs::path kSharedData = test_support::SharedDataFolder();

Board Chessboard(int columns, int rows, double square_mm) {
  Board board;
  board.columns = columns;
  board.rows = rows;
  board.square_mm = square_mm;
  return board;
}

Board Charuco(int columns, int rows, double square_mm, double marker_mm, const char* dictionary) {
  Board board = Chessboard(columns, rows, square_mm);
  board.kind = BoardKind::kCharuco;
  board.marker_mm = marker_mm;
  board.dictionary = dictionary;
  return board;
}

std::vector<fs::path> PicturesIn(const fs::path& folder, const std::string& beginning) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(beginning) && entry.path().extension() == ".jpg") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

struct Lens {
  cv::Mat camera_matrix;
  cv::Mat distortion;
};

// The lens of a camera in the rig of the four cameras.
Lens LensOf(const std::string& camera) {
  const cv::FileStorage file((kSharedData / "four_cameras" / "rig.yml").string(), cv::FileStorage::READ);
  for (const cv::FileNode& node : file["cameras"]) {
    if (static_cast<std::string>(node["name"]) != camera) continue;
    Lens lens;
    node["camera_matrix"] >> lens.camera_matrix;
    node["distortion_coefficients"] >> lens.distortion;
    return lens;
  }
  throw std::runtime_error("no camera " + camera);
}

// Of the pose of the board that fits best: RMS distance between seen and expected points.
double ReprojectionRmsPx(const BoardSighting& sighting, const Board& board, const Lens& lens) {
  const std::vector<Eigen::Vector3d> points = PointsOf(board);
  std::vector<cv::Point3d> in_board;
  std::vector<cv::Point2d> seen, expected;
  for (const SightedPoint& point : sighting.points) {
    const Eigen::Vector3d& x = points[static_cast<std::size_t>(point.point)];
    in_board.emplace_back(x.x(), x.y(), x.z());
    seen.emplace_back(point.pixel.x(), point.pixel.y());
  }
  cv::Mat rotation, translation;
  cv::solvePnP(in_board, seen, lens.camera_matrix, lens.distortion, rotation, translation, false,
               cv::SOLVEPNP_IPPE);
  cv::solvePnP(in_board, seen, lens.camera_matrix, lens.distortion, rotation, translation, true);
  cv::projectPoints(in_board, rotation, translation, lens.camera_matrix, lens.distortion, expected);
  double sum = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) sum += (seen[i] - expected[i]).dot(seen[i] - expected[i]);
  return std::sqrt(sum / static_cast<double>(seen.size()));
}

class RealBoards : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kSharedData / "calibration") || !fs::exists(kSharedData / "four_cameras"))
      GTEST_SKIP() << "NOT TESTED on real boards: " << kSharedData << " is absent";
  }
};

TEST_F(RealBoards, TheBoardOnTheFloorIsFoundByAllFourCameras) {
  const Board board = Chessboard(8, 6, 115.0);
  const BoardFinder finder(board);
  for (const std::string camera : {"cam01", "cam02", "cam03", "cam04"}) {
    cv::VideoCapture video((kSharedData / "four_cameras" / camera / "checkerboard.avi").string());
    ASSERT_TRUE(video.isOpened()) << camera;
    int frames = 0, found = 0;
    double worst_px = 0.0;
    for (cv::Mat frame; frames < 20 && video.read(frame); ++frames) {
      const auto sighting = finder.Find(frame);
      if (!sighting) continue;
      ++found;
      worst_px = std::max(worst_px, ReprojectionRmsPx(*sighting, board, LensOf(camera)));
    }
    std::printf("floor board, %s: %d of %d frames, largest RMS %.2f px\n", camera.c_str(), found, frames,
                worst_px);
    EXPECT_EQ(found, frames) << camera;
    EXPECT_LT(worst_px, 1.0) << camera;
  }
}

TEST_F(RealBoards, PhotosOfTheFourCameras) {
  const Board board = Chessboard(8, 6, 115.0);
  const BoardFinder finder(board);
  for (const std::string camera : {"cam01", "cam02", "cam03", "cam04"}) {
    const std::vector<fs::path> files = PicturesIn(kSharedData / "four_cameras" / "board" / camera, "frame");
    int found = 0;
    double sum_px = 0.0;
    for (const fs::path& file : files) {
      const auto sighting = finder.Find(cv::imread(file.string(), cv::IMREAD_GRAYSCALE));
      if (!sighting) continue;
      ++found;
      sum_px += ReprojectionRmsPx(*sighting, board, LensOf(camera));
    }
    std::printf("photos, %s: %d of %d, mean RMS %.2f px\n", camera.c_str(), found,
                static_cast<int>(files.size()), sum_px / found);
    EXPECT_GE(found, 0.88 * static_cast<double>(files.size())) << camera;
    EXPECT_LT(sum_px / found, 0.6) << camera;
  }
}

TEST_F(RealBoards, ChessboardsOfTheStereoPairAreWhereOpenCvSeesThem) {
  const Board board = Chessboard(9, 6, 25.0);
  const BoardFinder finder(board);
  int found = 0, compared = 0;
  double sum_px2 = 0.0;
  for (const char* side : {"left", "right"}) {
    for (const fs::path& file : PicturesIn(kSharedData / "calibration" / "chessboard", side)) {
      const cv::Mat grey = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
      const auto sighting = finder.Find(grey);
      EXPECT_TRUE(sighting.has_value()) << file;
      if (!sighting) continue;
      ++found;
      EXPECT_GE(sighting->points.size(), 53U) << file;
      std::vector<cv::Point2f> oracle;
      if (!cv::findChessboardCorners(grey, cv::Size(9, 6), oracle)) continue;
      cv::cornerSubPix(grey, oracle, cv::Size(5, 5), cv::Size(-1, -1),
                       cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-3));
      for (const SightedPoint& point : sighting->points) {
        double nearest = 1e9;
        for (const cv::Point2f& other : oracle)
          nearest = std::min(nearest, std::hypot(point.pixel.x() - other.x, point.pixel.y() - other.y));
        EXPECT_LT(nearest, 1.0) << file << " point " << point.point;
        sum_px2 += nearest * nearest;
        ++compared;
      }
    }
  }
  const double rms_px = std::sqrt(sum_px2 / compared);
  std::printf("stereo pair: %d of 26 found; RMS distance from OpenCV's corners %.3f px over %d\n", found,
              rms_px, compared);
  EXPECT_EQ(found, 26);
  EXPECT_GE(compared, 20 * 54);
  EXPECT_LT(rms_px, 0.2);
}

TEST_F(RealBoards, CharucoPhotos) {
  const BoardFinder finder(Charuco(5, 7, 40.0, 20.0, "DICT_6X6_250"));
  const fs::path photo = kSharedData / "calibration" / "aruco" / "choriginal.jpg";
  const auto sighting = finder.Find(cv::imread(photo.string(), cv::IMREAD_COLOR));
  ASSERT_TRUE(sighting.has_value());
  std::printf("choriginal.jpg: %zu of 24 corners\n", sighting->points.size());
  EXPECT_EQ(sighting->points.size(), 24U);
}

TEST_F(RealBoards, VideosOfWebcams) {
  Board board = Charuco(4, 5, 54.0, 40.5, "DICT_4X4_1000");
  board.inverted = true;
  const BoardFinder finder(board);
  for (int camera = 0; camera < 4; ++camera) {
    const std::string name = "cam_" + std::to_string(camera);
    cv::VideoCapture video((kSharedData / "calibration" / "webcams" / (name + ".mp4")).string());
    ASSERT_TRUE(video.isOpened()) << name;
    int frames = 0, found = 0, points = 0;
    for (cv::Mat frame; video.read(frame); ++frames) {
      if (frames % 4 != 0) continue;
      if (const auto sighting = finder.Find(frame)) {
        ++found;
        points += static_cast<int>(sighting->points.size());
      }
    }
    const int looked_at = (frames + 3) / 4;
    std::printf("webcam %d: board in %d of %d frames, %.1f of 12 corners\n", camera, found, looked_at,
                static_cast<double>(points) / std::max(1, found));
    EXPECT_GE(found, 9) << name;  // the board is in view in the last two fifths
  }
}

}  // namespace
}  // namespace elbowroom::recon
