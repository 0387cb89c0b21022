#include "tests/recon/boards/board_picture.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>

namespace elbowroom::recon::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

// Which shapes are near a place, so that each place asks few of them.
class ShapeIndex {
 public:
  explicit ShapeIndex(const BoardDrawing& drawing) : drawing_(drawing) {
    const auto add = [this](const Eigen::AlignedBox2d& box, auto Cell::*list, std::size_t shape) {
      const auto [x0, y0] = CellAt(box.min());
      const auto [x1, y1] = CellAt(box.max());
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
          (cells_[static_cast<std::size_t>(y * kAcross + x)].*list).push_back(shape);
    };
    for (std::size_t i = 0; i < drawing.rectangles.size(); ++i)
      add(drawing.rectangles[i], &Cell::rectangles, i);
    for (std::size_t i = 0; i < drawing.circles.size(); ++i) {
      const DrawnCircle& circle = drawing.circles[i];
      const Vector2d radius = Vector2d::Constant(circle.radius_mm);
      add({circle.center_in_board - radius, circle.center_in_board + radius}, &Cell::circles, i);
    }
  }

  [[nodiscard]] bool IsInShape(const Vector2d& x_in_board) const {
    const auto [x, y] = CellAt(x_in_board);
    const Cell& cell = cells_[static_cast<std::size_t>(y * kAcross + x)];
    for (const std::size_t i : cell.rectangles)
      if (drawing_.rectangles[i].contains(x_in_board)) return true;
    for (const std::size_t i : cell.circles)
      if ((x_in_board - drawing_.circles[i].center_in_board).norm() <= drawing_.circles[i].radius_mm)
        return true;
    return false;
  }

 private:
  static constexpr int kAcross = 128;
  struct Cell {
    std::vector<std::size_t> rectangles, circles;
  };
  [[nodiscard]] std::pair<int, int> CellAt(const Vector2d& x_in_board) const {
    const Vector2d share = (x_in_board - drawing_.ground.min()).cwiseQuotient(drawing_.ground.sizes());
    const auto cell = [](double s) { return std::clamp(static_cast<int>(s * kAcross), 0, kAcross - 1); };
    return {cell(share.x()), cell(share.y())};
  }

  const BoardDrawing& drawing_;
  std::vector<Cell> cells_{static_cast<std::size_t>(kAcross * kAcross)};
};

// All pixels that may show something of the board; the whole picture where its outline isn't all before the
// lens.
cv::Rect BoxAround(const BoardDrawing& drawing, const core::CameraModel& camera) {
  constexpr int kStepsOfSide = 16;
  constexpr double kMarginPx = 3.0;  // the outline is curved between its steps, and a pixel has an extent
  const cv::Rect picture(0, 0, camera.width_px(), camera.height_px());
  const Vector2d from = drawing.ground.min(), to = drawing.ground.max();
  Eigen::AlignedBox2d box;
  for (int i = 0; i <= kStepsOfSide; ++i) {
    const Vector2d at = from + static_cast<double>(i) / kStepsOfSide * (to - from);
    for (const Vector2d& x_in_board : {Vector2d(at.x(), from.y()), Vector2d(at.x(), to.y()),
                                       Vector2d(from.x(), at.y()), Vector2d(to.x(), at.y())}) {
      const auto pixel = camera.Project({x_in_board.x(), x_in_board.y(), 0.0});
      if (!pixel) return picture;
      box.extend(*pixel);
    }
  }
  const Vector2d low = box.min().array() - kMarginPx, high = box.max().array() + kMarginPx;
  const cv::Point first(cvFloor(std::max(low.x(), 0.0)), cvFloor(std::max(low.y(), 0.0)));
  const cv::Point last(cvCeil(std::min(high.x(), 1.0 * picture.width)),
                       cvCeil(std::min(high.y(), 1.0 * picture.height)));
  return last.x > first.x && last.y > first.y ? cv::Rect(first, last) : cv::Rect();
}

// The normalised image point of each corner of the box's pixels; nothing where the lens has none.
std::vector<std::optional<Vector2d>> CornersOfPixels(const core::CameraModel& camera, const cv::Rect& box) {
  std::vector<std::optional<Vector2d>> corners;
  for (int y = box.y; y <= box.y + box.height; ++y)
    for (int x = box.x; x <= box.x + box.width; ++x) {
      const Vector2d pixel(x - 0.5, y - 0.5);
      const bool has_nearby = !corners.empty() && corners.back().has_value() && x > box.x;
      corners.push_back(has_nearby ? camera.NormalisedFromPixel(pixel, *corners.back())
                                   : camera.NormalisedFromPixel(pixel));
    }
  return corners;
}

// Places in a pixel, from 0 to 1, whose projections on any line are spread evenly (Roberts' R2 sequence),
// each with its mirror image, so that their mean is the pixel's centre.
std::vector<Vector2d> PlacesInPixel() {
  std::vector<Vector2d> places;
  for (int i = 0; i < 20; ++i) {
    const double x = 0.5 + 0.7548776662466927 * i, y = 0.5 + 0.5698402909980532 * i;
    places.emplace_back(x - std::floor(x), y - std::floor(y));
    places.emplace_back(Vector2d(1.0, 1.0) - places.back());
  }
  return places;
}

}  // namespace

cv::Mat PictureOf(const BoardDrawing& drawing, const core::CameraModel& camera,
                  const PictureOptions& options) {
  const ShapeIndex shapes(drawing);
  const core::RigidTransform& cam_from_board = camera.cam_from_world();
  Matrix3d normalised_from_board;
  normalised_from_board << cam_from_board.rotation.leftCols<2>(), cam_from_board.translation_mm;
  const Matrix3d board_from_normalised = normalised_from_board.inverse();
  const cv::Rect box = BoxAround(drawing, camera);
  const std::vector<std::optional<Vector2d>> corners = CornersOfPixels(camera, box);
  const std::vector<Vector2d> places = PlacesInPixel();
  const double shape = drawing.inverted ? options.light : options.dark;
  const double ground = drawing.inverted ? options.dark : options.light;
  const auto level_at = [&](const Vector2d& normalised) {
    const Eigen::Vector3d q = board_from_normalised * normalised.homogeneous();
    // 1 / q.z is the depth; behind the camera it is negative.
    if (!(q.z() > 0.0)) return options.surround;
    const Vector2d x_in_board = q.hnormalized();
    if (!drawing.ground.contains(x_in_board)) return options.surround;
    return shapes.IsInShape(x_in_board) ? shape : ground;
  };
  cv::Mat picture(camera.height_px(), camera.width_px(), CV_32F, cv::Scalar(options.surround));
  const auto across = static_cast<std::size_t>(box.width + 1);
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y - box.y) * across + static_cast<std::size_t>(x - box.x);
      const auto &a = corners[i], &b = corners[i + 1], &c = corners[i + across], &d = corners[i + across + 1];
      if (!a || !b || !c || !d) continue;
      double sum = 0.0;
      for (const Vector2d& p : places)
        sum += level_at((1.0 - p.y()) * ((1.0 - p.x()) * *a + p.x() * *b) +
                        p.y() * ((1.0 - p.x()) * *c + p.x() * *d));
      picture.at<float>(y, x) = static_cast<float>(sum / static_cast<double>(places.size()));
    }
  }
  if (options.blur_px > 0.0) cv::GaussianBlur(picture, picture, {}, options.blur_px);
  std::mt19937 random(options.seed);
  std::normal_distribution<float> noise(0.0F, static_cast<float>(std::max(1e-6, options.noise_levels)));
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) picture.at<float>(y, x) += noise(random);
  cv::Mat grey;
  picture.convertTo(grey, CV_8U);
  return grey;
}

core::CameraModel CameraAt(const Viewpoint& viewpoint, const BoardDrawing& drawing) {
  core::CameraCalibration c;
  c.name = viewpoint.lens;
  c.image_width_px = 644;
  c.image_height_px = 486;
  double focal_px = 600.0;
  if (viewpoint.lens == "strong") {
    focal_px = 490.0;
    c.distortion_coefficients = {-0.37, 0.15, 0.0005, -0.0004, -0.02};
  } else if (viewpoint.lens == "fisheye") {
    focal_px = 330.0;
    c.distortion_model = core::DistortionModel::kFisheye;
    c.distortion_coefficients = {0.02, -0.01, 0.002, 0.0};
  } else if (viewpoint.lens == "tele") {
    focal_px = 2500.0;
  }
  c.camera_matrix << focal_px, 0.0, 325.0, 0.0, 1.003 * focal_px, 240.0, 0.0, 0.0, 1.0;
  constexpr double kDegree = std::numbers::pi / 180.0;
  const Vector2d middle = drawing.ground.center() + viewpoint.aim_mm;
  const double e = viewpoint.elevation_deg * kDegree, a = viewpoint.azimuth_deg * kDegree;
  const Eigen::Vector3d target(middle.x(), middle.y(), 0.0);
  const Eigen::Vector3d eye =
      target + viewpoint.distance_mm *
                   Eigen::Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
  core::RigidTransform roll;
  roll.rotation =
      Eigen::AngleAxisd(viewpoint.roll_deg * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  c.cam_from_world = roll * core::CamFromWorldLookingAt(eye, target);
  return core::CameraModel(c);
}

std::optional<SightingError> ErrorOf(const BoardSighting& sighting, const Board& board,
                                     const core::CameraModel& camera, bool half_turn) {
  const std::vector<Eigen::Vector3d> points = PointsOf(board);
  SightingError error;
  for (const SightedPoint& point : sighting.points) {
    const int number = half_turn ? PointAfterHalfTurn(board, point.point).value_or(-1) : point.point;
    if (number < 0 || static_cast<std::size_t>(number) >= points.size()) return std::nullopt;
    const auto truth = camera.Project(points[static_cast<std::size_t>(number)]);
    if (!truth) return std::nullopt;
    const Vector2d off = point.pixel - *truth;
    error.rms_px += off.squaredNorm();
    error.most_px = std::max(error.most_px, off.norm());
    error.rms_of_sigma += off.squaredNorm() / (point.sigma_px * point.sigma_px);
  }
  const double coordinates = 2.0 * static_cast<double>(std::max<std::size_t>(1, sighting.points.size()));
  error.rms_px = std::sqrt(error.rms_px / coordinates);
  error.rms_of_sigma = std::sqrt(error.rms_of_sigma / coordinates);
  return error;
}

std::optional<SightingError> ErrorEitherWay(const BoardSighting& sighting, const Board& board,
                                            const core::CameraModel& camera) {
  const auto one = ErrorOf(sighting, board, camera);
  if (!PointAfterHalfTurn(board, 0)) return one;
  const auto other = ErrorOf(sighting, board, camera, true);
  if (!one || !other) return std::nullopt;
  return one->rms_px < other->rms_px ? one : other;
}

int PointsInPicture(const Board& board, const core::CameraModel& camera, double margin_px) {
  int count = 0;
  for (const Eigen::Vector3d& point : PointsOf(board)) {
    const auto pixel = camera.Project(point);
    if (pixel && pixel->minCoeff() >= margin_px && pixel->x() <= camera.width_px() - 1 - margin_px &&
        pixel->y() <= camera.height_px() - 1 - margin_px)
      ++count;
  }
  return count;
}

Board MakeBoard(BoardKind kind) {
  Board board;
  board.kind = kind;
  switch (kind) {
    case BoardKind::kChessboard:
      board.columns = 8, board.rows = 5, board.square_mm = 22.0;
      break;
    case BoardKind::kCharuco:
      board.columns = 7, board.rows = 5, board.square_mm = 28.0;
      board.marker_mm = 20.0, board.dictionary = "DICT_5X5_250";
      break;
    case BoardKind::kAprilTags:
      board.columns = 5, board.rows = 4, board.square_mm = 38.0;
      board.marker_mm = 28.0, board.dictionary = "DICT_APRILTAG_36h11";
      break;
    case BoardKind::kCircles:
      board.columns = 9, board.rows = 6, board.square_mm = 22.0;
      break;
    case BoardKind::kAsymmetricCircles:
      board.columns = 4, board.rows = 11, board.square_mm = 20.0;
      break;
  }
  return board;
}

}  // namespace elbowroom::recon::testing
