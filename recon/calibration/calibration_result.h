// A calibrated rig with the uncertainty of every parameter.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/rigid_transform.h"

namespace elbowroom::recon {

// Where one camera's parameters stand in the covariance: fx fy cx cy [px], distortion coefficients, rotation
// (3) [rad], translation (3) [mm], time offset [s]. The rotation is a small turn w from the left:
// rotation = exp(w) * rotation_found, about the camera's axes; the translation is that of cam_from_world.
struct ParameterBlock {
  int first = 0;
  int intrinsics = 0;  // 4 + the number of distortion coefficients

  [[nodiscard]] int rotation() const { return first + intrinsics; }
  [[nodiscard]] int translation() const { return rotation() + 3; }
  [[nodiscard]] int time_offset() const { return rotation() + 6; }
  [[nodiscard]] int size() const { return intrinsics + 7; }
};

struct CalibratedCamera {
  core::CameraCalibration calibration;
  ParameterBlock parameters;
  int views_used = 0;
  int views_rejected = 0;
  double rms_px = 0.0;  // of the used points, over both coordinates: sqrt(mean of |residual|^2)
  // A picture with the stamp t shows the scene at t + time_offset_s, on the clock of the first camera.
  double time_offset_s = 0.0;
  std::optional<double> time_offset_sigma_s;  // nothing: not looked for, or not observable
};

struct PointResidual {
  int point = 0;                // of the board, as its sighting numbers it
  Eigen::Vector2d pixel;        // where it was seen
  Eigen::Vector2d residual_px;  // model minus seen
  bool is_used = false;
};

struct ViewOutcome {
  bool is_used = false;
  std::string reason;                    // why it isn't used; empty if it is
  bool is_half_turned = false;           // the board was numbered from its other end
  double rms_px = 0.0;                   // of the used points; of a rejected view, all of its points
  std::vector<PointResidual> residuals;  // empty where the view has no pose
};

struct BoardPose {
  int set = 0;
  double time_s = 0.0;  // the instant of the pose, on the clock of the first camera
  core::RigidTransform world_from_board;
  int views = 0;  // used ones; a pose by one view alone isn't confirmed by another camera
};

// The board's points are at z = a q1 + b q2 + c q3 of its best plane, q: the parts of x^2, xy and y^2 that
// aren't linear over the board, each with the largest value 1.
struct BoardFlatness {
  std::array<double, 3> terms_mm{};
  std::array<double, 3> sigma_mm{};
  double largest_mm = 0.0;  // farthest point from the plane
  bool is_found = false;    // else the board is taken as flat
};

struct CalibrationResult {
  std::vector<CalibratedCamera> cameras;  // as in the input
  // Of all cameras' parameters, in the order of their blocks; 0 for what is kept or fixed. Enlarged by the
  // square of uncertainty_scale, as all sigmas here are.
  Eigen::MatrixXd covariance;
  std::vector<ViewOutcome> views;  // as in the input
  std::vector<BoardPose> boards;   // in the order of sets
  BoardFlatness flatness;
  double noise_scale = 1.0;  // s: the real noise over the sightings' sigma_px
  double noise_px = 0.0;     // of one coordinate of a point: s times the mean sigma_px
  double rms_px = 0.0;
  int points = 0;  // used
  int rejected_points = 0;
  // Nothing: too few sets to keep some out.
  std::optional<double> held_out_rms_px;
  std::optional<double> cross_camera_rms_px;  // of kept-out views, from where the other cameras see the board
  std::optional<double> rigidity_rms_mm;
  // 1 where the residuals of a view are independent; else how much less they tell than their number (standard
  // deviations).
  double uncertainty_scale = 1.0;
  std::vector<std::string> warnings;  // one plain line each
};

// Of the camera's centre in the world, in mm^2; of the turn w above, in rad^2.
[[nodiscard]] Eigen::Matrix3d CenterCovariance(const CalibrationResult& result, int camera);
[[nodiscard]] Eigen::Matrix3d RotationCovariance(const CalibrationResult& result, int camera);
// One number each: sqrt(trace).
[[nodiscard]] double CenterSigmaMm(const CalibrationResult& result, int camera);
[[nodiscard]] double RotationSigmaRad(const CalibrationResult& result, int camera);

}  // namespace elbowroom::recon
