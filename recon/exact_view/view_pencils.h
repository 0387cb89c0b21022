// All that one view's rays can meet of one hull: what the exact view is made from, here or on a graphics
// card.
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
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {

// The edges of all cameras as the view's rays meet them, and the workspace. Worked out in parallel. Borrows
// hull and rays. Immutable. Thread: any.
class ViewPencils {
 public:
  using Pencils = std::vector<std::unique_ptr<const EpipolarEdges>>;
  static constexpr int kSquarePx = 8;
  static constexpr int kLargestSquarePx = 64;

  ViewPencils(const VisualHull& hull, const ViewRays& rays);

  [[nodiscard]] const VisualHull& hull() const { return hull_; }
  [[nodiscard]] const ViewRays& rays() const { return rays_; }

  // One a camera: all must agree that a point is in the hull. None at all where no ray meets the workspace.
  [[nodiscard]] const Pencils& cameras() const { return cameras_; }
  // Under `abstain` one a camera, of its picture's outline: one must see the point.
  [[nodiscard]] const Pencils& visibility_outlines() const { return visibility_outlines_; }

  [[nodiscard]] const CastBox& box() const { return box_; }

  // Of the rays themselves: no crossing has this key or a later one.
  [[nodiscard]] float key_end() const;

  // Of all contours.
  [[nodiscard]] std::int64_t edges() const;

  // Cameras count first, visibility_outlines after them.
  [[nodiscard]] const EpipolarEdges& Caster(std::size_t number) const {
    return number < cameras_.size() ? *cameras_[number] : *visibility_outlines_[number - cameras_.size()];
  }

  // The squares, aligned to kSquarePx, whose rays might meet the hull; of the picture, or of the square of
  // kLargestSquarePx at (x, y).
  [[nodiscard]] std::vector<PixelBox> Squares() const;
  void AddSquaresIn(int x, int y, std::vector<PixelBox>* squares) const {
    Divide(x, y, kLargestSquarePx, squares);
  }

 private:
  // One face of the workspace as rays (u, v) meet it: they are on its inner side from, or up to, the key
  // `bound`; rays along the face, all the way where `bound` isn't negative.
  struct Face {
    enum class Kind { kNotBefore, kNotAfter, kBeside } kind = Kind::kBeside;
    AffineForm bound;
  };

  [[nodiscard]] static std::array<Face, 6> FacesOf(const Eigen::AlignedBox3d& box, const ViewRays& rays);
  void Divide(int x, int y, int size, std::vector<PixelBox>* squares) const;
  [[nodiscard]] EpipolarEdges::KeyRange KeysInWorkspace(const Eigen::AlignedBox2d& box) const;
  [[nodiscard]] bool MissesHull(const Eigen::AlignedBox2d& box) const;

  const VisualHull& hull_;
  const ViewRays& rays_;
  std::array<Face, 6> faces_;
  Pencils cameras_;
  Pencils visibility_outlines_;
  CastBox box_;
};

// Edge `edge` of the contour of caster `caster`: cameras count first, visibility_outlines after them;
// TileHits::kNoCamera is a face.
[[nodiscard]] HullSurface SurfaceOf(const VisualHull& hull, std::int32_t caster, std::uint32_t edge);

}  // namespace elbowroom::recon
