// A printed board: its lengths, and whether it is found again.
#include "recon/boards/board_page.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>

#include "recon/boards/board_finder.h"
#include "tests/recon/boards/board_picture.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::recon {
namespace {

constexpr double kDotsPerInch = 127.0;  // five to the millimetre
constexpr double kPixelsPerMm = kDotsPerInch / 25.4;
// A pixel: Poppler rounds the page's size up to whole pixels, and its antialiasing to quarters.
constexpr double kTruePlaceMm = 0.25;

// The page as a picture, by Poppler.
cv::Mat Printed(const Board& board, const BoardPage& page) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "board.pdf", BoardAsPdf(board, page));
  const auto run = test_support::RunProgram(
      "/usr/bin/pdftoppm", {"-r", "127", "-gray", "-png", "-singlefile", (folder / "board.pdf").string(),
                            (folder / "page").string()});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  return cv::imread((folder / "page.png").string(), cv::IMREAD_GRAYSCALE);
}

class PrintedBoard : public ::testing::TestWithParam<std::tuple<BoardKind, bool>> {};

TEST_P(PrintedBoard, IsTrueToScaleAndFound) {
  Board board = testing::MakeBoard(std::get<0>(GetParam()));
  board.inverted = std::get<1>(GetParam());
  const BoardPage page = PageFor(DrawBoard(board));
  const cv::Mat picture = Printed(board, page);
  ASSERT_FALSE(picture.empty());
  EXPECT_NEAR(picture.cols, page.width_mm * kPixelsPerMm, 1.0);
  EXPECT_NEAR(picture.rows, page.height_mm * kPixelsPerMm, 1.0);
  const auto sighting = BoardFinder(board).Find(picture);
  ASSERT_TRUE(sighting.has_value());
  const std::vector<Eigen::Vector3d> points = PointsOf(board);
  ASSERT_EQ(sighting->points.size(), points.size());
  // Pixel (0, 0) has its centre half a pixel inside of the page's upper left corner.
  double most_px = 0.0, most_turned_px = 0.0;
  for (const SightedPoint& point : sighting->points) {
    const auto place = [&](int number) {
      const Eigen::Vector2d on_page_mm =
          page.origin_on_page_mm + points[static_cast<std::size_t>(number)].head<2>();
      return Eigen::Vector2d(on_page_mm.x() * kPixelsPerMm - 0.5,
                             picture.rows - on_page_mm.y() * kPixelsPerMm - 0.5);
    };
    most_px = std::max(most_px, (point.pixel - place(point.point)).norm());
    if (const auto turned = PointAfterHalfTurn(board, point.point))
      most_turned_px = std::max(most_turned_px, (point.pixel - place(*turned)).norm());
  }
  if (most_turned_px > 0.0) most_px = std::min(most_px, most_turned_px);
  EXPECT_LT(most_px / kPixelsPerMm, kTruePlaceMm);
}

INSTANTIATE_TEST_SUITE_P(All, PrintedBoard,
                         ::testing::Combine(::testing::Values(BoardKind::kChessboard, BoardKind::kCharuco,
                                                              BoardKind::kAprilTags, BoardKind::kCircles,
                                                              BoardKind::kAsymmetricCircles),
                                            ::testing::Bool()),
                         [](const auto& test) {
                           return std::string(ToString(std::get<0>(test.param))) +
                                  (std::get<1>(test.param) ? "_inverted" : "");
                         });

TEST(BoardPage, TakesTheSmallestPaperThatIsLargeEnough) {
  Board board = testing::MakeBoard(BoardKind::kChessboard);
  board.square_mm = 10.0;
  EXPECT_EQ(PageFor(DrawBoard(board)).paper, "A4");
  board.square_mm = 25.0;
  EXPECT_EQ(PageFor(DrawBoard(board)).paper, "A4 landscape");
  board.square_mm = 40.0;
  EXPECT_EQ(PageFor(DrawBoard(board)).paper, "A2 landscape");
  board.square_mm = 400.0;
  const BoardPage page = PageFor(DrawBoard(board));
  EXPECT_EQ(page.paper, "custom");
  EXPECT_GT(page.width_mm, 9 * 400.0);
}

TEST(BoardPage, SaysTheBoardAsCalibTomlHasIt) {
  Board board = testing::MakeBoard(BoardKind::kCharuco);
  board.inverted = true;
  EXPECT_EQ(
      BoardAsToml(board),
      "board = { type = \"charuco\", columns = 7, rows = 5, square_mm = 28, marker_mm = 20, dictionary = "
      "\"DICT_5X5_250\", layout = \"current\", inverted = true }");
  EXPECT_EQ(BoardAsToml(testing::MakeBoard(BoardKind::kChessboard)),
            "board = { type = \"chessboard\", columns = 8, rows = 5, square_mm = 22 }");
}

}  // namespace
}  // namespace elbowroom::recon
