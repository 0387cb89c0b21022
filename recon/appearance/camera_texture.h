// A camera's picture of the real objects, and what of the hull that camera sees.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "core/camera_model.h"
#include "recon/hull/visual_hull_declared.h"
#include "recon/images/picture_buffer.h"

namespace elbowroom::recon {

// What a photo shows of one point of the hull's surface.
struct TextureSample {
  Eigen::Vector3f color_bgr = Eigen::Vector3f::Zero();            // grey levels, bilinear between pixels
  float weight = 0.0F;                                            // (0, 1]: how well the camera sees it
  Eigen::Vector3f to_camera_in_world = Eigen::Vector3f::UnitZ();  // unit
};

// Immutable; shares the image. Thread: any.
class CameraTexture {
 public:
  // Looks at the hull once from the camera, through its lens. Throws: PreconditionError unless the image is
  // CV_8UC3 of the camera's size.
  CameraTexture(const VisualHull& hull, core::CameraModel camera, cv::Mat image_bgr);

  [[nodiscard]] const core::CameraModel& camera() const { return camera_; }

  // Nothing where the camera doesn't see the point: outside of its picture, turned away, or more than four
  // pixels' footprints behind what it sees of the hull there. The weight is continuous along the surface. It
  // falls to 0 where the point ceases to be seen, at the picture's borders, at the rims of what hides
  // something, and where the camera grazes the surface. `normal_in_world`: unit, out of the hull.
  [[nodiscard]] std::optional<TextureSample> Sample(const Eigen::Vector3d& x_in_world,
                                                    const Eigen::Vector3d& normal_in_world) const;

 private:
  core::CameraModel camera_;
  cv::Mat image_bgr_;
  double focal_px_;                // the shorter one
  PictureBuffer<float> depth_mm_;  // of the hull, a pixel; 0: it isn't there
  cv::Mat trust_;                  // CV_32FC1: 0 at rims and borders, 1 from kFeatherPx away
};

}  // namespace elbowroom::recon
