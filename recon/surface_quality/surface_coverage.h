// How many cameras see each place of the hull's surface.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera_model.h"
#include "core/rig.h"
#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/view_rays.h"
#include "recon/hull/visual_hull_declared.h"
#include "recon/surface_quality/surface_values.h"

namespace elbowroom::recon {

// A camera sees a place if it has it in its picture and the hull doesn't stand before it: its line of sight
// doesn't meet the hull by more than a pixel's width sooner. That is `cameras_seeing` of docs/coverage.md
// less the cameras whose sight the hull itself blocks (docs/view_tools.md). Lines of sight are looked up in
// the camera's picture of the hull, kMostPx a side at most, so that within a pixel of a rim of that picture
// either answer may come (surface_coverage_test). Thread: one; Of and Sees: any, once it has looked.
class SurfaceCoverage {
 public:
  static constexpr int kMostPx = 640;

  // Works out the cameras' rays.
  explicit SurfaceCoverage(const core::Rig& rig);

  // Makes each camera's picture of the hull, which is one of this rig.
  void LookAt(const VisualHull& hull);
  // Of the hull that was looked at last, by nobody before the first.
  // `normal_in_world`: the surface's, unit.
  [[nodiscard]] bool Sees(core::CameraIndex camera, const Eigen::Vector3d& x_in_world,
                          const Eigen::Vector3d& normal_in_world) const;
  // `shown`: what `picture` is of; a piece of the hull that was looked at, cut off by its workspace, or all
  // of it. The picture has surfaces and normals. Throws: PreconditionError: it hasn't, or its size isn't that
  // of `rays`.
  [[nodiscard]] SurfaceValues Of(const VisualHull& shown, const HullView& picture,
                                 const ViewRays& rays) const;

 private:
  struct Camera {
    core::CameraModel model;  // of the picture of the hull
    ViewRays rays;
    double focal_px;
    HullView view;
  };
  std::vector<Camera> cameras_;
};

}  // namespace elbowroom::recon
