// A hull prepared for one view: the edges that the view's rays can meet, camera by camera. The exact view is
// made from it, on the processor or on a graphics card.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "recon/exact_view/epipolar_edges.h"
#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/tile_cast.h"
#include "recon/exact_view/view_rays.h"

namespace elbowroom::recon {

// Every camera's contour, with its edges ordered by epipolar plane (EpipolarEdges), and the workspace as the
// rays meet it. Built in parallel. Keeps references to hull and rays. Immutable. Thread: any.
class ViewPencils {
 public:
  using Pencils = std::vector<std::unique_ptr<const EpipolarEdges>>;
  static constexpr int kSquarePx = 8;
  static constexpr int kLargestSquarePx = 32;

  ViewPencils(const VisualHull& hull, const ViewRays& rays);

  [[nodiscard]] const VisualHull& hull() const { return hull_; }
  [[nodiscard]] const ViewRays& rays() const { return rays_; }

  // One a camera: a point is in the hull if it is object to all of them. Empty where no ray meets the
  // workspace.
  [[nodiscard]] const Pencils& cameras() const { return cameras_; }
  // Under `abstain` one a camera, made from the outline of what that camera sees: a point of the hull must be
  // seen by at least one camera. Else empty.
  [[nodiscard]] const Pencils& visibility_outlines() const { return visibility_outlines_; }

  [[nodiscard]] const CastBox& box() const { return box_; }

  // Every crossing's key is less than this: a ray ends here.
  [[nodiscard]] float key_end() const;

  // The number of edges of all contours.
  [[nodiscard]] std::int64_t edges() const;

  // cameras() have the first numbers, visibility_outlines() the ones after them.
  [[nodiscard]] const EpipolarEdges& Caster(std::size_t number) const {
    return number < cameras_.size() ? *cameras_[number] : *visibility_outlines_[number - cameras_.size()];
  }

  // The squares of kSquarePx pixels whose rays might meet the hull. They lie on a grid from the picture's
  // corner and are cut off at its border.
  [[nodiscard]] std::vector<PixelBox> Squares() const;
  // The same for the part of the picture from (x, y) that is kLargestSquarePx wide and high.
  void AddSquaresIn(int x, int y, std::vector<PixelBox>* squares) const {
    Divide(x, y, kLargestSquarePx, squares);
  }

 private:
  // One face of the workspace, or one of the rays' half-spaces, as the ray (u, v) meets it. kNotBefore: the
  // ray is on the face's inner side from the key bound(u, v) on; kNotAfter: up to that key. kBeside: the rays
  // run along the face, and a ray is on the inner side everywhere if bound(u, v) >= 0, else nowhere.
  struct Face {
    enum class Kind { kNotBefore, kNotAfter, kBeside } kind = Kind::kBeside;
    AffineForm bound;
  };

  [[nodiscard]] static Face FaceOf(const HalfSpace& half_space, const ViewRays& rays,
                                   const core::RigidTransform& world_from_view);
  [[nodiscard]] static std::vector<Face> FacesOf(const Eigen::AlignedBox3d& box, const ViewRays& rays);
  void Divide(int x, int y, int size, std::vector<PixelBox>* squares) const;
  [[nodiscard]] EpipolarEdges::KeyRange KeysInWorkspace(const Eigen::AlignedBox2d& box) const;
  [[nodiscard]] bool MissesHull(const Eigen::AlignedBox2d& box) const;

  const VisualHull& hull_;
  const ViewRays& rays_;
  std::vector<Face> faces_;
  Pencils cameras_;
  Pencils visibility_outlines_;
  CastBox box_;
};

// The surface that a crossing is on: edge `edge` of the contour with number `caster` (as
// ViewPencils::Caster), or a face of the workspace if `caster` is TileHits::kNoCamera.
[[nodiscard]] HullSurface SurfaceOf(const VisualHull& hull, std::int32_t caster, std::uint32_t edge);

}  // namespace elbowroom::recon
