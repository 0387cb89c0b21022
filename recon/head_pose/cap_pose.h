// The head's pose from the markers of its cap, in the pictures of all cameras of one instant.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "core/camera_model.h"
#include "recon/calibration/lens_projection.h"
#include "recon/head_pose/cap.h"
#include "recon/head_pose/cap_finder.h"

namespace elbowroom::recon {

struct CapPoseOptions {
  // What each corner is off by for itself beside its noise: the model of an edge. > 0.
  double least_sigma_px = 0.04;
  // What blur moves the edges of all markers by, inwards together, in all pictures.
  double edge_sigma_px = 0.05;
  // A pose that is less certain is refused.
  double most_sigma_mm = 8.0;
  double most_sigma_rad = 0.03;
  // A second pose that explains the corners nearly as well (the flip of a plane): half the difference of the
  // squared residuals, in variances.
  double least_lead = 12.0;
};

struct CapPose {
  core::RigidTransform world_from_head;
  // Of a turn in `head` (rad), then of the eyes' place in world (mm), to the first order: noise, which
  // averages out over corners and cameras, and the places of the markers and blur, which don't. The cameras
  // are taken as exact.
  Eigen::Matrix<double, 6, 6> covariance;
  double rms_px = 0.0;  // of the corners that agree
  int cameras = 0;      // that see a marker
  int markers = 0;      // over all cameras
  int corners = 0;      // that agree

  [[nodiscard]] double sigma_mm() const;   // sqrt(trace)
  [[nodiscard]] double sigma_rad() const;  // likewise
};

enum class NoCapPose {
  kNotSeen,       // no marker in any picture
  kAmbiguous,     // two poses fit: one marker, or markers in one plane, from one side
  kUncertain,     // less certain than the options allow
  kDisagreement,  // the corners don't fit one pose: the cap was bent, a marker moved, a camera was knocked
};
[[nodiscard]] std::string_view ToString(NoCapPose why);

// What a fit needs of a camera; made once.
struct CapCamera {
  explicit CapCamera(const core::CameraModel& camera);
  LensParameters lens;
  core::RigidTransform cam_from_world;
};

// The pose with the least sum of robust squared residuals over the corners in all cameras, started from every
// marker in every camera, from both poses of its plane. sightings[i] belongs to cameras[i].
// cap_pose_test: at most 2 mm and 0.3 degrees off on the synthetic rigs of four and eight cameras.
[[nodiscard]] std::variant<CapPose, NoCapPose> FindCapPose(const Cap& cap, std::span<const CapCamera> cameras,
                                                           std::span<const CapSighting> sightings,
                                                           const CapPoseOptions& options = {});

}  // namespace elbowroom::recon
