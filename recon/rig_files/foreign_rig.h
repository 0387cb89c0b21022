// Cameras that another program calibrated: what its files say, and what that means here.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera_model.h"
#include "core/units.h"

namespace elbowroom::recon {

enum class ForeignFormat { kOpenCv, kRos, kKalibr, kAnipose, kCaliscope, kProjection };

// opencv, ros, kalibr, anipose, caliscope, projection.
[[nodiscard]] std::optional<ForeignFormat> ParseForeignFormat(std::string_view text);
[[nodiscard]] std::string_view ToString(ForeignFormat format);

// Rotation and translation as a file has them, before anybody says what they map and in which unit.
struct StatedPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

struct ForeignCamera {
  std::string name;
  std::string alias = {};  // another name of it: the first part of its ROS topic; empty: none
  // Size, camera matrix and lens; its pose isn't used. Width and height 0: the file doesn't say.
  core::CameraCalibration lens;
  std::optional<StatedPose> stated;  // nothing: the file has a lens alone
  // The 3 x 4 matrix itself, where that is what the file has; its parts are in `lens` and `stated`, too.
  std::optional<Eigen::Matrix<double, 3, 4>> projection;
  // With such a matrix, the camera matrix and lens that somebody else knows; nothing: the pictures are
  // without distortion, and the camera matrix is the matrix's own.
  std::optional<core::CameraCalibration> known = std::nullopt;
};

struct ForeignRig {
  ForeignFormat format = ForeignFormat::kOpenCv;
  std::vector<ForeignCamera> cameras;
  bool is_chain = false;  // each pose is relative to the camera before; that of the first is the identity
  // OpenCV's stereo sample keeps this in a file without lenses.
  std::optional<StatedPose> second_from_first;
  std::vector<std::string> warnings;
};

// What a file's numbers can mean.
struct RigConvention {
  // What the stated pose maps: x_cam = R x_world + t, or x_world = R x_cam + t. In a chain the world is the
  // camera before.
  enum class Pose { kCamFromWorld, kWorldFromCam };
  // OpenCV: x right, y down, z forward. OpenGL: x right, y up, looking along -z; of a projection matrix,
  // whose camera has no axes: rows of pixels are counted from below.
  enum class Axes { kOpenCv, kOpenGl };
  Pose pose = Pose::kCamFromWorld;
  Axes axes = Axes::kOpenCv;

  [[nodiscard]] bool operator==(const RigConvention&) const = default;
};
// "cam_from_world, OpenCV axes".
[[nodiscard]] std::string ToString(const RigConvention& convention);

// The convention that the format's documentation states.
[[nodiscard]] RigConvention DocumentedConvention(ForeignFormat format);
// The unit of its lengths; nothing where it has none of its own (OpenCV, anipose, matrices).
[[nodiscard]] std::optional<core::LengthUnit> DocumentedUnit(ForeignFormat format);
// All that the format's numbers could mean, the documented one first.
[[nodiscard]] std::vector<RigConvention> PossibleConventions(ForeignFormat format);

// Complete calibrations under a convention; in world, which is as in the file, but in mm. Throws:
// PreconditionError unless all cameras have a pose and a size; Error{kCamera} naming a camera whose pose
// isn't a rotation, or whose matrix has no camera matrix in it.
[[nodiscard]] std::vector<core::CameraCalibration> CalibrationsOf(const ForeignRig& rig,
                                                                  const RigConvention& convention,
                                                                  double unit_mm);

// P = scale * K [R | t] with det R = +1, K's diagonal positive and K(2, 2) = 1; the scale may be negative.
struct SplitProjection {
  Eigen::Matrix3d camera_matrix;
  StatedPose cam_from_world;
};
// By an RQ decomposition. Nothing: P's left 3 x 3 part is singular, or holds a number that isn't finite.
[[nodiscard]] std::optional<SplitProjection> SplitOf(const Eigen::Matrix<double, 3, 4>& projection);

// A rotation vector, as OpenCV's Rodrigues takes it.
[[nodiscard]] Eigen::Matrix3d RotationFromRodrigues(const Eigen::Vector3d& vector);
// Leaves out the two angles of a tilted sensor if they are 0: OpenCV writes them, and no model here has them.
void DropTilt(core::CameraCalibration* lens);

// "cam_0", "Cam00" and "cam0" are the same camera: letters and numbers count, not signs, nor leading zeros.
[[nodiscard]] bool IsSameCamera(std::string_view a, std::string_view b);

// One file's text, of a format that isn't TOML. `who` begins the messages ("file 'camchain.yml'"), `name` is
// for a camera that the file doesn't name. Throws: Error{kFormat}, Error{kCamera} naming place and key.
[[nodiscard]] ForeignRig ParseForeignRig(std::string_view text, ForeignFormat format, const std::string& who,
                                         const std::string& name);

// Several files' cameras, in order. Throws: Error{kFormat} for files that don't go together: of several
// formats, a chain and something else, or a pose between two cameras without two cameras.
[[nodiscard]] ForeignRig Joined(std::vector<ForeignRig> rigs);

// The format of a text that isn't TOML; nothing: none of them.
[[nodiscard]] std::optional<ForeignFormat> FormatOf(std::string_view text, const std::string& who);

}  // namespace elbowroom::recon
