// All that a calibration is made from: a board, cameras, and where the board was seen.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "recon/boards/board.h"
#include "recon/boards/board_sighting.h"

namespace elbowroom::recon {

struct CalibrationCamera {
  std::string name;
  int width_px = 0;
  int height_px = 0;
  std::optional<core::DistortionModel> distortion_model;  // nothing: chosen by the error on views left out
  // Its camera matrix and lens are kept as they are, without uncertainty; its pose isn't used.
  std::optional<core::CameraCalibration> known;
};

// One picture of the board.
struct CalibrationView {
  int camera = 0;
  // Views with the same number show the board at about one instant. Sets are numbered in the order of time.
  // Nothing: a picture for this camera's lens alone.
  std::optional<int> set;
  double time_s = 0.0;  // stamp of the picture, on the clock of all cameras; only differences count
  // A board that looks the same after half a turn may be numbered from either end. Where one set alone joins
  // two cameras, both are taken to number it from the same end.
  BoardSighting sighting;
  std::string label;  // for messages: "board/cam01/003.jpg", "frame 76"
};

// The world is the board's frame in one set, or the frame of one camera.
struct CalibrationWorld {
  enum class Kind { kBoardOfSet, kCamera };
  Kind kind = Kind::kBoardOfSet;
  int number = 0;  // of the set, or of the camera
};

struct CalibrationInput {
  Board board;
  std::vector<CalibrationCamera> cameras;
  std::vector<CalibrationView> views;
  CalibrationWorld world;
  bool finds_offsets = false;          // whether cameras may be late or early against their stamps
  bool has_flat_board = false;         // glass or granite: its flatness isn't looked for
  double frame_period_s = 1.0 / 30.0;  // nominal time between two frames of a camera; > 0

  // Throws: Error{kRange} naming the board's fault; Error{kCamera} naming a camera without size or views, or
  // a view with a wrong point; PreconditionError: numbers of cameras that aren't there, two views of a camera
  // in one set, a period that isn't positive.
  void Validate() const;
};

}  // namespace elbowroom::recon
