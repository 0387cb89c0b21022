// How well a calibrated rig knows where a point is.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/camera_model.h"
#include "core/progress.h"
#include "recon/calibration/calibration_result.h"
#include "recon/calibration/lens_projection.h"

namespace elbowroom::recon {

class PointResponse;  // recon/calibration/point_response.h

struct PointUncertainty {
  Eigen::Matrix3d covariance_mm2 = Eigen::Matrix3d::Zero();  // of the triangulated point, in world
  int cameras = 0;                                           // that see it

  [[nodiscard]] double sigma_mm() const;  // sqrt(trace)
};

// The point is before the camera and in its picture.
[[nodiscard]] bool IsInPicture(const core::CameraModel& camera, const Eigen::Vector3d& x_in_world);

// The covariance of a point that is triangulated by all cameras that see it, to the first order:
// A+ (sigma^2 I + B Sigma B^T) A+^T, with A and B the derivatives of its pixels by the point and by the
// cameras' parameters, Sigma their covariance, sigma the noise of one coordinate of a pixel. The point stands
// still, so time offsets have no part in it.
class RigUncertainty {
 public:
  // `covariance` of all cameras' parameters, as RIG.yml keeps it: a ParameterBlock for each camera. Empty:
  // the cameras are taken as exact. `noise_px`: CalibrationResult::noise_px, or the noise of what is looked
  // for later. Throws: PreconditionError: a covariance of another size, or noise that isn't positive.
  RigUncertainty(std::span<const core::CameraModel> cameras, Eigen::MatrixXd covariance, double noise_px);
  // Throws: Error{kCamera} as core::CameraModel, too.
  RigUncertainty(const CalibrationResult& result, double noise_px);

  // Nothing: fewer than two cameras see the point, or all see it from one direction.
  [[nodiscard]] std::optional<PointUncertainty> At(const Eigen::Vector3d& x_in_world) const;
  // How the triangulated point moves with the cameras' parameters, 3 x their number; nothing likewise.
  [[nodiscard]] std::optional<Eigen::Matrix3Xd> ShiftByParameters(const Eigen::Vector3d& x_in_world) const;
  [[nodiscard]] int CamerasSeeing(const Eigen::Vector3d& x_in_world) const;

 private:
  // Solved; nothing as At. Sets `seeing` to the number of cameras that see the point.
  [[nodiscard]] std::optional<PointResponse> ResponseAt(const Eigen::Vector3d& x_in_world, int* seeing) const;

  struct Camera {
    core::CameraModel model;
    LensParameters lens;
    ParameterBlock parameters;
  };

  std::vector<Camera> cameras_;
  Eigen::MatrixXd covariance_;
  double noise_px_ = 0.0;
  bool is_exact_ = false;  // the covariance is 0
};

// Sigma at the nodes of a grid: x runs fastest, then y, then z.
struct UncertaintyMap {
  struct Node {
    float sigma_mm = 0.0F;     // 0 where is_known is false
    std::uint8_t cameras = 0;  // that see it
    bool is_known = false;     // two cameras or more see it, from different directions
  };
  Eigen::Vector3d first_node_mm;
  double edge_mm = 0.0;
  Eigen::Vector3i nodes;
  std::vector<Node> values;
};

// `edge_mm`, made wider by factors of 1.5 until the box has `most_nodes` at most.
inline constexpr double kMapEdgeMm = 20.0;
inline constexpr double kMostMapNodes = 1e6;
[[nodiscard]] double MapEdgeMm(const Eigen::AlignedBox3d& box_mm, double edge_mm = kMapEdgeMm,
                               double most_nodes = kMostMapNodes);

// Nodes from the box's least corner on, at most at its largest. Throws: PreconditionError: an edge that isn't
// positive, an empty box, or more than 50,000,000 nodes; Error{kCancelled}. Thread: progress is called on the
// caller's.
[[nodiscard]] UncertaintyMap MapUncertainty(const RigUncertainty& rig,
                                            const Eigen::AlignedBox3d& workspace_mm, double edge_mm,
                                            const core::Progress& progress = {},
                                            const std::stop_token& stop = {});

}  // namespace elbowroom::recon
