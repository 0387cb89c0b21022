// CALIB.toml: the board, the cameras' pictures of it, and where the world is.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/ids.h"
#include "recon/boards/board.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

// A camera and its pictures. Locations are resolved, as recon::ResolvedLocation gives them.
struct CameraFootage {
  std::string name;
  std::string frames;                               // the board, seen by several cameras at once
  std::string intrinsics;                           // pictures for the lens alone; empty: none
  std::filesystem::path timestamps;                 // empty: frame i goes with frame i
  std::optional<core::DistortionModel> lens_model;  // nothing: chosen by the error on views left out
  std::filesystem::path known;                      // a file with the lens to keep; empty: it is found
  recon::CameraSources trial;                       // what RIG.yml shall say of the trial's pictures
};

// A length that somebody measured, to hold the scale against.
struct KnownLength {
  std::string title;  // for messages: "between cam1 and cam2"
  double length_mm = 0.0;
  double tolerance_mm = 0.0;
  // Either the centres of two cameras, ...
  std::vector<std::string> cameras;
  // ... or two points, each given by its pixel in two or more cameras.
  struct Pixel {
    std::string camera;
    Eigen::Vector2d from_px;
    Eigen::Vector2d to_px;
  };
  std::vector<Pixel> pixels;
};

struct CalibrationFile {
  recon::Board board;
  std::vector<CameraFootage> cameras;
  // The world is the board's frame at this frame of the first camera that sees it there, or the camera's.
  std::optional<core::FrameIndex> board_frame;
  std::string world_camera;
  Eigen::AlignedBox3d workspace_mm;
  std::vector<KnownLength> lengths;
};

// Throws: Error{kFile} if it can't be read, Error{kFormat} or Error{kRange} that begins with file:line for a
// key that is missing, misspelt or wrong.
[[nodiscard]] CalibrationFile ReadCalibrationFile(const std::filesystem::path& path);

}  // namespace elbowroom::control
