// Pictures of boards whose points are known exactly.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "recon/boards/board.h"
#include "recon/boards/board_drawing.h"
#include "recon/boards/board_sighting.h"

namespace elbowroom::recon::testing {

struct PictureOptions {
  double light = 210.0, dark = 35.0, surround = 120.0;  // grey levels
  double blur_px = 0.6;                                 // standard deviation
  double noise_levels = 2.0;                            // standard deviation
  unsigned seed = 1;
};

// The board as the camera sees it where `cam_from_world` of the camera is cam_from_board. Each pixel is the
// mean of 40 places in it.
[[nodiscard]] cv::Mat PictureOf(const BoardDrawing& drawing, const core::CameraModel& camera,
                                const PictureOptions& options);

// One of the lenses "plain", "strong" (k1 = -0.37), "fisheye", "tele", looking at the middle of the board
// from `distance_mm`, `elevation_deg` above its plane, from the direction `azimuth_deg`, turned by
// `roll_deg`.
struct Viewpoint {
  std::string lens = "plain";
  double distance_mm = 600.0;
  double elevation_deg = 60.0;
  double azimuth_deg = -70.0;
  double roll_deg = 0.0;
  Eigen::Vector2d aim_mm = Eigen::Vector2d::Zero();  // from the board's middle
};
[[nodiscard]] core::CameraModel CameraAt(const Viewpoint& viewpoint, const BoardDrawing& drawing);

struct SightingError {
  double rms_px = 0.0;        // of both coordinates
  double most_px = 0.0;       // the largest distance
  double rms_of_sigma = 0.0;  // of each coordinate's error in standard deviations; 1 if they are honest
};
// Against the truth; `half_turn`: numbers are those after half a turn. Nothing: a number with no such point.
[[nodiscard]] std::optional<SightingError> ErrorOf(const BoardSighting& sighting, const Board& board,
                                                   const core::CameraModel& camera, bool half_turn = false);

// The smaller error of both ends where the board looks the same after half a turn.
[[nodiscard]] std::optional<SightingError> ErrorEitherWay(const BoardSighting& sighting, const Board& board,
                                                          const core::CameraModel& camera);

// How many of the board's points are in the picture, `margin_px` from its edge at least.
[[nodiscard]] int PointsInPicture(const Board& board, const core::CameraModel& camera, double margin_px);

// Boards of each kind, of about 200 x 150 mm.
[[nodiscard]] Board MakeBoard(BoardKind kind);

}  // namespace elbowroom::recon::testing
