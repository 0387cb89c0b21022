#include "recon/calibration/calibration_input.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

[[noreturn]] void FailAtCamera(const std::string& message) {
  throw core::Error(core::ErrorKind::kCamera, message);
}

void ValidateSighting(const CalibrationInput& input, const CalibrationView& view, int board_points) {
  const auto& camera = input.cameras[static_cast<std::size_t>(view.camera)];
  int previous = -1;
  for (const SightedPoint& point : view.sighting.points) {
    if (point.point <= previous || point.point >= board_points)
      FailAtCamera(fmt::format("camera '{}', {}: point {} is no point of the board, or out of order",
                               camera.name, view.label, point.point));
    if (!point.pixel.allFinite() || !(point.sigma_px > 0.0))
      FailAtCamera(fmt::format("camera '{}', {}: point {} has no position or no standard deviation",
                               camera.name, view.label, point.point));
    previous = point.point;
  }
}

}  // namespace

void CalibrationInput::Validate() const {
  board.Validate();
  const int camera_count = static_cast<int>(cameras.size());
  core::Require(camera_count > 0, "a calibration has a camera");
  core::Require(frame_period_s > 0.0 && std::isfinite(frame_period_s), "the frame period is positive");
  core::Require(
      world.kind != CalibrationWorld::Kind::kCamera || (world.number >= 0 && world.number < camera_count),
      "the world's camera is one of the cameras");
  for (const CalibrationCamera& camera : cameras)
    if (camera.width_px <= 0 || camera.height_px <= 0)
      FailAtCamera(fmt::format("camera '{}': its pictures have the size {} x {}; both must be positive",
                               camera.name, camera.width_px, camera.height_px));
  const int board_points = static_cast<int>(PointsOf(board).size());
  std::set<std::pair<int, int>> seen;
  for (const CalibrationView& view : views) {
    core::Require(view.camera >= 0 && view.camera < camera_count, "a view's camera is one of the cameras");
    core::Require(std::isfinite(view.time_s), "a view's time is finite");
    core::Require(!view.set || seen.emplace(view.camera, *view.set).second,
                  "a camera has one view in a set at most");
    ValidateSighting(*this, view, board_points);
  }
}

}  // namespace elbowroom::recon
