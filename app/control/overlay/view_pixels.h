// A camera's pixels as a tree of squares, to find those that a triangle covers.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "core/camera_model.h"
#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/view_rays.h"

namespace elbowroom::control {

// A camera with a picture of another size: its lens and its place stay. A width and height of the camera's
// own give the same camera to the last bit.
[[nodiscard]] core::CameraModel ScaledTo(const core::CameraModel& camera, int width_px, int height_px);

// Immutable; made once for a camera and a size. Thread: any.
class ViewPixels {
 public:
  static constexpr int kLeafPx = 4;

  explicit ViewPixels(const core::CameraModel& camera);

  [[nodiscard]] const core::CameraModel& camera() const { return camera_; }
  [[nodiscard]] const recon::ViewRays& rays() const { return rays_; }
  // Around the rays (X/Z, Y/Z) of all pixels, and a pixel beyond. Empty: no pixel has a ray.
  [[nodiscard]] const Eigen::AlignedBox2d& frame() const { return frame_; }

  // Calls `on_leaf` for the squares of kLeafPx pixels a side, cut off at the picture's border, that may hold
  // a ray of which `may_hold` is true: it is asked of the boxes around the rays of ever smaller squares.
  template <typename MayHold, typename OnLeaf>
  void VisitLeaves(const MayHold& may_hold, const OnLeaf& on_leaf) const {
    if (!levels_.empty()) Visit(levels_.size() - 1, 0, 0, may_hold, on_leaf);
  }

 private:
  struct Level {
    int across = 0;
    int down = 0;
    std::vector<Eigen::AlignedBox2d> boxes;  // empty: no pixel there has a ray
  };

  [[nodiscard]] Level Leaves() const;

  template <typename MayHold, typename OnLeaf>
  void Visit(std::size_t level, int i, int j, const MayHold& may_hold, const OnLeaf& on_leaf) const {
    const Level& at = levels_[level];
    if (i >= at.across || j >= at.down) return;
    const Eigen::AlignedBox2d& box = at.boxes[static_cast<std::size_t>(j * at.across + i)];
    if (box.isEmpty() || !may_hold(box)) return;
    if (level == 0) {
      const int x = i * kLeafPx, y = j * kLeafPx;
      on_leaf(recon::PixelBox{x, y, std::min(x + kLeafPx, rays_.width_px()),
                              std::min(y + kLeafPx, rays_.height_px())});
      return;
    }
    for (const int down : {0, 1})
      for (const int across : {0, 1}) Visit(level - 1, 2 * i + across, 2 * j + down, may_hold, on_leaf);
  }

  core::CameraModel camera_;
  recon::ViewRays rays_;
  std::vector<Level> levels_;  // the smallest squares first
  Eigen::AlignedBox2d frame_;
};

}  // namespace elbowroom::control
