// Pictures of a cap on a head, as the cameras of a rig would take them, with the truth.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <random>
#include <vector>

#include "core/camera_model.h"
#include "core/rig.h"
#include "core/rigid_transform.h"
#include "recon/head_pose/cap.h"

namespace elbowroom::recon::testing {

struct Ball {
  Eigen::Vector3d center_in_world;
  double radius_mm = 0.0;
};

struct CapPictureOptions {
  double light = 205.0, dark = 40.0;  // grey levels
  double blur_px = 0.7;               // standard deviation
  double noise_levels = 2.0;          // standard deviation
  std::vector<Ball> before;           // hands and the like, which may hide markers
};

// Empty scenes of a rig without noise, grey, one a camera.
[[nodiscard]] std::vector<cv::Mat> EmptyScenes(const core::Rig& rig);

// The cap, with a head below it, before `scene`. A pixel is the mean of 16 places in it.
[[nodiscard]] cv::Mat PictureOfCap(const Cap& cap, const core::RigidTransform& world_from_head,
                                   const core::CameraModel& camera, const cv::Mat& scene,
                                   const CapPictureOptions& options, std::mt19937* random);

// How far one pose is from another: of the eyes, and of the turn.
struct HeadError {
  double distance_mm = 0.0;
  double turn_deg = 0.0;
};
[[nodiscard]] HeadError ErrorOf(const core::RigidTransform& a, const core::RigidTransform& b);

// A head before the synthetic rigs' table, anywhere in a box of 400 x 400 x 200 mm, that looks anywhere down
// to 50 degrees below and up to 20 degrees above the horizon and is tilted by up to 25 degrees.
[[nodiscard]] core::RigidTransform RandomHead(std::mt19937* random);

}  // namespace elbowroom::recon::testing
