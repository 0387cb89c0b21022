// The hull of one frame's silhouettes, with queries of points, balls, boxes and triangles.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/hull/hull_stats.h"
#include "recon/hull/world_shape.h"

namespace elbowroom::recon {

class Silhouette;        // recon/contours/silhouette.h: for queries of one camera
class UndistortedPlane;  // recon/contours/undistorted_plane.h
using UndistortedPlanes = std::vector<std::shared_ptr<const UndistortedPlane>>;

// The answer for a ball, a box or a triangle.
enum class BallAnswer {
  kOutside,  // no point of it is in the hull
  kInside,   // every point of it is
  kMixed,    // neither is certain
};

// Whether a point is in the hull, and the radius of a ball around it for all of which the answer is the same.
struct PointAnswer {
  bool is_inside = false;
  double radius_mm = 0.0;  // certified, but not the largest; may be infinite
};

// The camera whose silhouette bounds the hull nearest to a point, and the direction out of the hull there.
struct BoundingEdge {
  std::optional<core::CameraIndex> camera;         // nothing: a face of the workspace
  std::optional<Eigen::Vector3d> normal_in_world;  // unit; nothing where the silhouette gives none
};

// The cameras that may still exclude points of a set. A camera to which all of a set is object needn't be
// asked about parts of it.
struct UndecidedCameras {
  static constexpr std::size_t kMost = 64;  // cameras beyond are always asked

  std::uint64_t bits = ~std::uint64_t{0};
  bool asks_visibility = true;   // `abstain`: no camera is known to see all of the set
  core::CameraIndex likely = 0;  // is asked first, since it excluded a set near by

  [[nodiscard]] bool Asks(core::CameraIndex camera) const {
    return camera >= kMost || ((bits >> camera) & 1U) != 0;
  }
  void Close(core::CameraIndex camera) {
    if (camera < kMost) bits &= ~(std::uint64_t{1} << camera);
  }
};

// The visual hull: the points of the workspace that project into every camera's silhouette, where rig.unseen
// decides for cameras that can't see the point. An immutable snapshot; copies share silhouettes. The answers
// for balls are certain: docs/algorithms.md derives that, and tests/recon/hull/ball_query_test.cc tests it.
// Thread: any.
class VisualHull {
 public:
  // Throws: PreconditionError when there isn't one silhouette a camera, with the exterior label that the rig
  // asks for.
  VisualHull(std::shared_ptr<const core::Rig> rig,
             std::vector<std::shared_ptr<const Silhouette>> silhouettes);

  [[nodiscard]] const core::Rig& rig() const { return *rig_; }
  [[nodiscard]] const std::shared_ptr<const core::Rig>& shared_rig() const { return rig_; }
  [[nodiscard]] std::span<const std::shared_ptr<const Silhouette>> silhouettes() const {
    return silhouettes_;
  }

  // True when no point can be inside: under `outside`, some camera sees no object at all.
  [[nodiscard]] bool IsEmpty() const { return is_empty_; }

  // Builds now, for all cameras in parallel, what the first query of each would build otherwise. Changes no
  // answer.
  void Prepare() const;

  // The paper's volume query.
  [[nodiscard]] bool Contains(const Eigen::Vector3d& x_in_world) const;
  [[nodiscard]] bool Contains(const Eigen::Vector3d& x_in_world, const UndecidedCameras& open) const;

  // Contains(), and how far around the point the answer is sure to hold.
  [[nodiscard]] PointAnswer Probe(const Eigen::Vector3d& x_in_world) const;

  // Whether Probe() of a point in the hull may answer with a radius of more than `radius_mm`. It costs a
  // fraction of Probe(), in a search for the deepest of many points. `likely` is the camera to ask first;
  // after a no, it is the camera that decided.
  [[nodiscard]] bool MayBeDeeper(const Eigen::Vector3d& x_in_world, double radius_mm,
                                 core::CameraIndex* likely) const;

  // Whether a point of the ball may be deeper in the hull than `depth_mm`: whether a ball of hull with a
  // larger radius may be around it. A no is certain (docs/algorithms.md). `likely`: as above.
  [[nodiscard]] bool MayHoldDeeper(const Eigen::Vector3d& center_in_world, double radius_mm, double depth_mm,
                                   core::CameraIndex* likely) const;

  // The volume query of a closed ball. A radius of 0 is the point's own query.
  [[nodiscard]] BallAnswer Classify(const Eigen::Vector3d& center_in_world, double radius_mm) const;

  // The same for a set of points in the ball, about which only the open cameras are asked. Closes those to
  // which all of the ball is object: they needn't be asked about parts of the set.
  [[nodiscard]] BallAnswer Classify(const Eigen::Vector3d& center_in_world, double radius_mm,
                                    UndecidedCameras* open) const;

  // The same for a box or a triangle, by what it covers in each picture. It is often certain where a ball
  // around the shape is mixed, and costs a few times as much (ball_query_test). Under `abstain` it answers
  // kInside only if `open` knows already that a camera sees all of the shape.
  [[nodiscard]] BallAnswer Classify(const WorldShape& shape, UndecidedCameras* open) const;

  // Which silhouette ends the hull at a point on its surface; the normal is that of the plane
  // through the camera's centre and the contour's tangent there (FitTangent).
  [[nodiscard]] BoundingEdge EdgeAt(const Eigen::Vector3d& surface_point_in_world) const;

 private:
  std::shared_ptr<const core::Rig> rig_;
  std::vector<std::shared_ptr<const Silhouette>> silhouettes_;
  bool is_empty_ = false;
};

// Whether positions outside of a picture are labelled object: under `abstain` they are.
[[nodiscard]] bool ExteriorIsObject(const core::Rig& rig);

struct FrameHull {
  std::shared_ptr<const VisualHull> hull;  // the last one itself if no silhouette has changed
  HullStats stats;
};

// The hull of a frame's masks; `last`: the one of the frame before, or null. Throws: as MakeVisualHull.
[[nodiscard]] FrameHull NextHull(const std::shared_ptr<const VisualHull>& last,
                                 const std::shared_ptr<const core::Rig>& rig, const UndistortedPlanes& planes,
                                 std::span<const core::SoftMask> masks);

// One silhouette a mask, in parallel. Throws: core::Error{kCamera} naming the camera when a mask's size isn't
// the camera's. The overloads without planes work them out anew: for a single frame.
[[nodiscard]] VisualHull MakeVisualHull(const std::shared_ptr<const core::Rig>& rig,
                                        const UndistortedPlanes& planes,
                                        std::span<const core::SoftMask> masks);
[[nodiscard]] VisualHull MakeVisualHull(const std::shared_ptr<const core::Rig>& rig,
                                        std::span<const core::SoftMask> masks);
[[nodiscard]] VisualHull MakeVisualHull(const std::shared_ptr<const core::Rig>& rig,
                                        std::span<const core::BitMask> masks);

}  // namespace elbowroom::recon
