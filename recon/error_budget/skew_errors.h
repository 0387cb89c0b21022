// How far the hull's surface may be off because the cameras of a frame don't look at one instant.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "core/bvh.h"
#include "core/ids.h"
#include "core/rigid_transform.h"
#include "recon/error_budget/contour_motion.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

// What is real and moves is no faster than this; a hand at work seldom reaches half of it. Of a contour whose
// speed isn't known (in the first frame, or where it appears) this is assumed.
inline constexpr double kFastestMmPerS = 2000.0;
// The usual acceleration of a hand at work. Where contours move, at least this is allowed for.
inline constexpr double kHandMmPerS2 = 3000.0;

// When one camera looked, and how its contour moved before.
struct CameraLook {
  double skew_s = 0.0;                          // from the frame's time to the camera's instant, without sign
  double period_s = 0.0;                        // from the camera's picture before to this one
  std::shared_ptr<const ContourMotion> motion;  // in that period; null: not known
  double period_before_s = 0.0;                 // likewise, of the period before
  std::shared_ptr<const ContourMotion> motion_before = nullptr;
};

// For one frame. To the first order the distance from the hull to a part changes by the shifts of the cones
// that bound the hull at its nearest point, each times its share (SharesOf). Camera i's cone is off by how
// far its contour moves between its own instant and the frame's. All shifts count with the same sign, because
// the sign of a motion that is only known from two contours isn't sure (docs/error_budget.md). Held to moving
// objects by skew_errors_test. Immutable. Thread: any.
class SkewErrors {
 public:
  // One a camera; nothing for one whose picture is missing: it bounds no hull.
  explicit SkewErrors(std::vector<std::optional<CameraLook>> looks);

  // No contour moved, or all cameras looked at the frame's time: all errors are 0.
  [[nodiscard]] bool is_still() const { return is_still_; }

  // 1 sigma, in mm, of the distance from a point of the hull's surface to `x_of_part`. Where the silhouettes
  // near the point don't explain the direction, that of WorstInMm.
  [[nodiscard]] double AtMm(const VisualHull& hull, const Eigen::Vector3d& x_of_hull,
                            const Eigen::Vector3d& x_of_part) const;

  // The largest shift of one camera's cone, mm, by contours that are, or may come, in front of the ball.
  [[nodiscard]] double WorstInMm(const VisualHull& hull, const core::Ball& ball_in_world) const;

  // Whether the part stays farther than `distance_mm` from the object, wherever that is at the frame's time,
  // if no contour near the part moves by more than 2 sigma. The hull can't show that: of a thin thing that
  // moves fast it may hold nothing, since no point is in the cones of different instants. False: not sure. It
  // resolves pieces of the part of `finest_mm`.
  [[nodiscard]] bool StaysFarther(const VisualHull& hull, const core::TriangleTree& part,
                                  const core::RigidTransform& world_from_part, double distance_mm,
                                  double finest_mm) const;

 private:
  struct Seen;
  [[nodiscard]] Seen SeenBy(const VisualHull& hull, core::CameraIndex camera,
                            const core::Ball& ball_in_world) const;
  [[nodiscard]] double AccelerationNear(const VisualHull& hull, const core::Ball& ball_in_world) const;
  [[nodiscard]] double ShiftMm(const VisualHull& hull, core::CameraIndex camera,
                               const core::Ball& ball_in_world, double mm_per_s2) const;

  std::vector<std::optional<CameraLook>> looks_;
  bool is_still_ = true;
};

}  // namespace elbowroom::recon
