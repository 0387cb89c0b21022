#include "app/control/overlay/view_pixels.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace elbowroom::control {

core::CameraModel ScaledTo(const core::CameraModel& camera, int width_px, int height_px) {
  core::Require(width_px > 0 && height_px > 0, "a picture has pixels");
  if (width_px == camera.width_px() && height_px == camera.height_px()) return camera;
  core::CameraCalibration scaled = camera.calibration();
  scaled.image_width_px = width_px;
  scaled.image_height_px = height_px;
  // Pixel centres are at integers, so that the picture's border is at -1/2: x' + 1/2 = scale (x + 1/2).
  const double across = static_cast<double>(width_px) / camera.width_px();
  const double down = static_cast<double>(height_px) / camera.height_px();
  scaled.camera_matrix.row(0) *= across;
  scaled.camera_matrix.row(1) *= down;
  scaled.camera_matrix(0, 2) += 0.5 * (across - 1.0);
  scaled.camera_matrix(1, 2) += 0.5 * (down - 1.0);
  return core::CameraModel(std::move(scaled));
}

ViewPixels::ViewPixels(const core::CameraModel& camera) : camera_(camera), rays_(camera) {
  levels_.push_back(Leaves());
  while (levels_.back().boxes.size() > 1) {
    const Level& below = levels_.back();
    Level level{(below.across + 1) / 2, (below.down + 1) / 2, {}};
    level.boxes.resize(static_cast<std::size_t>(level.across) * static_cast<std::size_t>(level.down));
    for (int j = 0; j < below.down; ++j)
      for (int i = 0; i < below.across; ++i)
        level.boxes[static_cast<std::size_t>(j / 2 * level.across + i / 2)].extend(
            below.boxes[static_cast<std::size_t>(j * below.across + i)]);
    levels_.push_back(std::move(level));
  }
  frame_ = levels_.back().boxes.front();
  if (frame_.isEmpty()) return;
  const int longer_px = std::max(rays_.width_px(), rays_.height_px());
  const Eigen::Vector2d pixel = Eigen::Vector2d::Constant(2.0 * frame_.sizes().maxCoeff() / longer_px);
  frame_ = {frame_.min() - pixel, frame_.max() + pixel};
}

ViewPixels::Level ViewPixels::Leaves() const {
  Level leaves{(rays_.width_px() + kLeafPx - 1) / kLeafPx, (rays_.height_px() + kLeafPx - 1) / kLeafPx, {}};
  leaves.boxes.resize(static_cast<std::size_t>(leaves.across) * static_cast<std::size_t>(leaves.down));
  for (int y = 0; y < rays_.height_px(); ++y) {
    for (int x = 0; x < rays_.width_px(); ++x) {
      const Eigen::Vector2d ray = rays_.At(x, y);
      if (ray.hasNaN()) continue;
      leaves.boxes[static_cast<std::size_t>(y / kLeafPx * leaves.across + x / kLeafPx)].extend(ray);
    }
  }
  return leaves;
}

}  // namespace elbowroom::control
