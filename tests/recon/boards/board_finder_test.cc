// Boards of all kinds in pictures whose points are known exactly.
#include "recon/boards/board_finder.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>
#include <thread>
#include <tuple>

#include "core/error.h"
#include "tests/recon/boards/board_picture.h"

namespace elbowroom::recon {
namespace {

using testing::CameraAt;
using testing::MakeBoard;
using testing::PictureOf;
using testing::PictureOptions;
using testing::SightingError;
using testing::Viewpoint;

const std::vector<BoardKind> kKinds{BoardKind::kChessboard, BoardKind::kCharuco, BoardKind::kAprilTags,
                                    BoardKind::kCircles, BoardKind::kAsymmetricCircles};

// At the noise of the pictures, 2 levels of 175 between light and dark; measured: 0.01 to 0.035 px. Edges of
// tags have a module of 2 to 4 px beside them; measured: 0.03 to 0.09 px.
double UsualRmsPx(BoardKind kind) { return kind == BoardKind::kAprilTags ? 0.1 : 0.05; }
// Sigmas leave out what isn't noise: the discs' pixels, the lens's curvature. Measured: 0.6 to 1.5.
constexpr double kLeastHonest = 0.4, kMostHonest = 2.0;

double UsualDistance(const std::string& lens) {
  return lens == "plain" ? 520.0 : lens == "strong" ? 420.0 : lens == "fisheye" ? 300.0 : 2200.0;
}

// The sighting's error, after it was found, is complete to `least_share`, and is numbered as it is printed.
SightingError ExpectFound(const Board& board, const core::CameraModel& camera, const cv::Mat& picture,
                          double least_share) {
  const auto sighting = BoardFinder(board).Find(picture);
  if (!sighting) {
    ADD_FAILURE() << "not found";
    return {};
  }
  const double share =
      static_cast<double>(sighting->points.size()) / testing::PointsInPicture(board, camera, 3.0);
  EXPECT_GE(share, least_share);
  const auto error = testing::ErrorEitherWay(*sighting, board, camera);
  EXPECT_TRUE(error.has_value());
  return error.value_or(SightingError{});
}

std::string NameOf(BoardKind kind) { return std::string(ToString(kind)); }

class EveryBoardAndLens : public ::testing::TestWithParam<std::tuple<BoardKind, std::string>> {};

TEST_P(EveryBoardAndLens, IsFoundToAFewHundredthsOfAPixelWithHonestSigmas) {
  const auto& [kind, lens] = GetParam();
  const Board board = MakeBoard(kind);
  const BoardDrawing drawing = DrawBoard(board);
  double sum_of_sigma = 0.0;
  int pictures = 0;
  for (const double elevation_deg : {80.0, 50.0, 32.0}) {
    for (const auto& [azimuth_deg, roll_deg] :
         {std::pair(-75.0, 8.0), std::pair(-20.0, -65.0), std::pair(130.0, 20.0)}) {
      SCOPED_TRACE(std::to_string(elevation_deg) + " " + std::to_string(azimuth_deg));
      const core::CameraModel camera =
          CameraAt({lens, UsualDistance(lens), elevation_deg, azimuth_deg, roll_deg}, drawing);
      const cv::Mat picture = PictureOf(drawing, camera, {.seed = static_cast<unsigned>(++pictures)});
      const SightingError error = ExpectFound(board, camera, picture, 0.9);
      EXPECT_LT(error.rms_px, UsualRmsPx(kind));
      sum_of_sigma += error.rms_of_sigma * error.rms_of_sigma;
    }
  }
  const double rms_of_sigma = std::sqrt(sum_of_sigma / pictures);
  RecordProperty("error_in_sigmas", std::to_string(rms_of_sigma));
  EXPECT_GT(rms_of_sigma, kLeastHonest);
  EXPECT_LT(rms_of_sigma, kMostHonest);
}

INSTANTIATE_TEST_SUITE_P(All, EveryBoardAndLens,
                         ::testing::Combine(::testing::ValuesIn(kKinds),
                                            ::testing::Values("plain", "strong", "fisheye", "tele")),
                         [](const auto& test) {
                           return NameOf(std::get<0>(test.param)) + "_" + std::get<1>(test.param);
                         });

class EveryBoard : public ::testing::TestWithParam<BoardKind> {
 protected:
  Board board_ = MakeBoard(GetParam());
};
INSTANTIATE_TEST_SUITE_P(All, EveryBoard, ::testing::ValuesIn(kKinds),
                         [](const auto& test) { return NameOf(test.param); });

TEST_P(EveryBoard, IsFoundAtAGrazingAngle) {
  // At 12 degrees the squares are 6 px high. Markers are read, and circles told from spots, a little further
  // up.
  const bool is_chessboard = board_.kind == BoardKind::kChessboard;
  const double lowest_deg = is_chessboard ? 12.0 : board_.kind == BoardKind::kAprilTags ? 28.0 : 20.0;
  const BoardDrawing drawing = DrawBoard(board_);
  for (const double azimuth_deg : {-90.0, -60.0, 15.0}) {
    SCOPED_TRACE(azimuth_deg);
    const core::CameraModel camera = CameraAt({"plain", 420.0, lowest_deg, azimuth_deg}, drawing);
    const SightingError error = ExpectFound(board_, camera, PictureOf(drawing, camera, {}), 0.8);
    EXPECT_LT(error.rms_px, 0.15);
  }
}

TEST_P(EveryBoard, IsFoundInverted) {
  board_.inverted = true;
  const BoardDrawing drawing = DrawBoard(board_);
  const core::CameraModel camera = CameraAt({"strong", 420.0, 50.0}, drawing);
  const SightingError error = ExpectFound(board_, camera, PictureOf(drawing, camera, {}), 0.95);
  EXPECT_LT(error.rms_px, UsualRmsPx(board_.kind));
}

TEST_P(EveryBoard, IsFoundBlurredAndInNoise) {
  const BoardDrawing drawing = DrawBoard(board_);
  const core::CameraModel camera = CameraAt({"plain", 450.0, 60.0}, drawing);
  for (const PictureOptions& options : {PictureOptions{.blur_px = 1.8}, PictureOptions{.noise_levels = 9.0},
                                        PictureOptions{.light = 95.0, .dark = 60.0, .surround = 80.0},
                                        PictureOptions{.light = 250.0, .dark = 2.0}}) {
    SCOPED_TRACE("blur " + std::to_string(options.blur_px) + ", noise " +
                 std::to_string(options.noise_levels));
    const SightingError error = ExpectFound(board_, camera, PictureOf(drawing, camera, options), 0.9);
    // A blur as wide as a module moves a tag's edges by more than their noise.
    const bool is_tags = board_.kind == BoardKind::kAprilTags;
    EXPECT_LT(error.rms_px, is_tags ? 0.4 : 0.2);
    EXPECT_LT(error.rms_of_sigma, is_tags ? 5.0 : 2.5);
  }
}

TEST_P(EveryBoard, IsFoundSmallAndLarge) {
  const BoardDrawing drawing = DrawBoard(board_);
  // Modules of a tag are 2 px wide at 900 mm.
  const double furthest_mm = board_.kind == BoardKind::kAprilTags ? 750.0 : 1100.0;
  for (const double distance_mm : {furthest_mm, 330.0}) {
    SCOPED_TRACE(distance_mm);
    const core::CameraModel camera = CameraAt({"plain", distance_mm, 70.0}, drawing);
    const SightingError error = ExpectFound(board_, camera, PictureOf(drawing, camera, {}), 0.9);
    EXPECT_LT(error.rms_px, 2.0 * UsualRmsPx(board_.kind));
  }
}

TEST_P(EveryBoard, IsFoundInColourAndTheSameInFourThreads) {
  const BoardDrawing drawing = DrawBoard(board_);
  const core::CameraModel camera = CameraAt({"plain", 520.0, 60.0}, drawing);
  const cv::Mat grey = PictureOf(drawing, camera, {});
  cv::Mat bgr;
  cv::cvtColor(grey, bgr, cv::COLOR_GRAY2BGR);
  const BoardFinder finder(board_);
  const auto expected = finder.Find(grey);
  ASSERT_TRUE(expected.has_value());
  std::vector<std::optional<BoardSighting>> found(4);
  {
    std::vector<std::jthread> threads;
    for (auto& sighting : found) threads.emplace_back([&] { sighting = finder.Find(bgr); });
  }
  for (const auto& sighting : found) EXPECT_EQ(sighting, expected);
}

TEST_P(EveryBoard, IsNotFoundWhereThereIsAnother) {
  for (const BoardKind other : kKinds) {
    if (other == GetParam()) continue;
    const BoardDrawing drawing = DrawBoard(MakeBoard(other));
    const core::CameraModel camera = CameraAt({"plain", 450.0, 60.0}, drawing);
    EXPECT_FALSE(BoardFinder(board_).Find(PictureOf(drawing, camera, {}))) << NameOf(other);
  }
}

TEST_P(EveryBoard, IsNotFoundWhereALargerOneOfItsKindIs) {
  Board larger = board_;
  larger.columns += 2;
  larger.rows += 1;
  const BoardDrawing drawing = DrawBoard(larger);
  const core::CameraModel camera = CameraAt({"plain", 600.0, 60.0}, drawing);
  const auto sighting = BoardFinder(board_).Find(PictureOf(drawing, camera, {}));
  EXPECT_FALSE(sighting.has_value()) << sighting->points.size();
}

// Grounds without a board: smooth noise of several sizes, stripes, tiles with seams, a lattice of bars.
std::vector<cv::Mat> PicturesWithoutBoard() {
  std::vector<cv::Mat> pictures;
  cv::RNG random(7);
  for (const double blur_px : {0.0, 1.0, 2.5, 6.0}) {
    cv::Mat noise(480, 640, CV_32F);
    random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
    if (blur_px > 0.0) cv::GaussianBlur(noise, noise, {}, blur_px);
    cv::normalize(noise, noise, 0.0, 255.0, cv::NORM_MINMAX);
    noise.convertTo(noise, CV_8U);
    pictures.push_back(noise);
  }
  cv::Mat stripes(480, 640, CV_8U), tiles(480, 640, CV_8U, cv::Scalar(180)), bars(480, 640, CV_8U);
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      stripes.at<unsigned char>(y, x) = (x / 12) % 2 == 0 ? 220 : 30;
      if (x % 40 < 3 || y % 40 < 3) tiles.at<unsigned char>(y, x) = 60;
      bars.at<unsigned char>(y, x) =
          static_cast<unsigned char>(70 * ((x / 20) % 2) + 70 * ((y / 20) % 2) + 50);
    }
  }
  pictures.insert(pictures.end(), {stripes, tiles, bars, cv::Mat(480, 640, CV_8U, cv::Scalar(99))});
  return pictures;
}

TEST_P(EveryBoard, IsNotFoundWhereThereIsNone) {
  const BoardFinder finder(board_);
  for (const cv::Mat& picture : PicturesWithoutBoard()) EXPECT_FALSE(finder.Find(picture).has_value());
}

TEST_P(EveryBoard, IsNotFoundInTinyPictures) {
  const BoardFinder finder(board_);
  for (const int size : {1, 7, 16, 17, 40}) {
    EXPECT_FALSE(finder.Find(cv::Mat(size, size, CV_8U, cv::Scalar(50)))) << size;
    EXPECT_FALSE(finder.Find(cv::Mat(size, 3 * size, CV_8UC3, cv::Scalar::all(50)))) << size;
  }
}

TEST(BoardFinder, SeesHalfOfABoardWithMarkers) {
  for (const BoardKind kind : {BoardKind::kCharuco, BoardKind::kAprilTags}) {
    const Board board = MakeBoard(kind);
    const BoardDrawing drawing = DrawBoard(board);
    for (const Eigen::Vector2d& aim_mm : {Eigen::Vector2d(200.0, 0.0), Eigen::Vector2d(-195.0, 40.0)}) {
      SCOPED_TRACE(NameOf(kind) + " " + std::to_string(aim_mm.x()));
      const core::CameraModel camera = CameraAt({"strong", 260.0, 60.0, -90.0, 10.0, aim_mm}, drawing);
      ASSERT_LT(testing::PointsInPicture(board, camera, 0.0),
                0.75 * static_cast<double>(PointsOf(board).size()));
      const SightingError error = ExpectFound(board, camera, PictureOf(drawing, camera, {}), 0.6);
      EXPECT_LT(error.rms_px, UsualRmsPx(kind));
    }
  }
}

TEST(BoardFinder, DoesNotNumberAChessboardThatIsPartlyOutOfThePicture) {
  const Board board = MakeBoard(BoardKind::kChessboard);
  const BoardDrawing drawing = DrawBoard(board);
  const core::CameraModel camera = CameraAt({"plain", 400.0, 70.0, -80.0, 0.0, {190.0, 0.0}}, drawing);
  EXPECT_FALSE(BoardFinder(board).Find(PictureOf(drawing, camera, {})));
}

TEST(BoardFinder, TellsTheLayoutsOfCharucoApart) {
  for (const CharucoLayout layout : {CharucoLayout::kCurrent, CharucoLayout::kLegacy}) {
    Board board = MakeBoard(BoardKind::kCharuco);
    board.rows = 6;
    board.layout = layout;
    Board other = board;
    other.layout = layout == CharucoLayout::kCurrent ? CharucoLayout::kLegacy : CharucoLayout::kCurrent;
    const BoardDrawing drawing = DrawBoard(board);
    const core::CameraModel camera = CameraAt({"plain", 520.0, 60.0}, drawing);
    const cv::Mat picture = PictureOf(drawing, camera, {});
    const SightingError error = ExpectFound(board, camera, picture, 0.95);
    EXPECT_LT(error.rms_px, UsualRmsPx(board.kind));
    EXPECT_FALSE(BoardFinder(other).Find(picture)) << "seen as the other layout";
  }
}

TEST(BoardFinder, DoesNotTakeMarkersOfAnotherDictionary) {
  for (const BoardKind kind : {BoardKind::kCharuco, BoardKind::kAprilTags}) {
    Board board = MakeBoard(kind);
    const BoardDrawing drawing = DrawBoard(board);
    const core::CameraModel camera = CameraAt({"plain", 520.0, 60.0}, drawing);
    const cv::Mat picture = PictureOf(drawing, camera, {});
    for (const char* dictionary : {"DICT_4X4_50", "DICT_6X6_250", "DICT_7X7_1000", "DICT_APRILTAG_25h9"}) {
      board.dictionary = dictionary;
      EXPECT_FALSE(BoardFinder(board).Find(picture)) << NameOf(kind) << " " << dictionary;
    }
  }
}

TEST(BoardFinder, NumbersAChessboardFromItsBlackCorner) {
  const Board board = MakeBoard(BoardKind::kChessboard);  // 8 x 5: both ends can be told apart
  const BoardDrawing drawing = DrawBoard(board);
  for (const double roll_deg : {0.0, 90.0, 180.0, 270.0}) {
    const core::CameraModel camera = CameraAt({"plain", 520.0, 60.0, -70.0, roll_deg}, drawing);
    const auto sighting = BoardFinder(board).Find(PictureOf(drawing, camera, {}));
    ASSERT_TRUE(sighting.has_value()) << roll_deg;
    EXPECT_LT(testing::ErrorOf(*sighting, board, camera).value().rms_px, UsualRmsPx(board.kind)) << roll_deg;
  }
}

TEST(BoardFinder, RefusesBoardsThatCanNotBe) {
  Board board = MakeBoard(BoardKind::kCharuco);
  board.dictionary = "DICT_8X8_50";
  EXPECT_THROW((void)BoardFinder(board), core::Error);
  board.dictionary = "DICT_4X4_50";
  board.columns = board.rows = 12;
  EXPECT_THROW((void)BoardFinder(board), core::Error) << "72 markers";
  EXPECT_THROW((void)BoardFinder(MakeBoard(BoardKind::kChessboard)).Find(cv::Mat(40, 40, CV_16U)),
               core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
