// The paper's lens correction: a plane is divided into cells, and only their corners go through the lens.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/camera_model.h"
#include "recon/paper_methods/sweep_cameras.h"

namespace elbowroom::recon {

// The picture positions of one camera over one triangle of a plane, as a projected texture has them: linear
// in the view's pixel (x, y) in homogeneous coordinates (position in px times z, z), where z is the depth in
// the camera. So a camera without lens is exact everywhere.
struct GridTriangle {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d along_x = Eigen::Vector3d::Zero();  // for a pixel of the view
  Eigen::Vector3d along_y = Eigen::Vector3d::Zero();

  // Nothing behind the camera.
  [[nodiscard]] std::optional<Eigen::Vector2d> At(double x, double y) const {
    const Eigen::Vector3d position = origin + x * along_x + y * along_y;
    if (!(position.z() > 0.0)) return std::nullopt;
    return position.hnormalized();
  }

  // The same, positions counted from a place of the picture.
  [[nodiscard]] GridTriangle CountedFrom(const Eigen::Vector2d& place_px) const;
};

// Divides the view's picture, and with it every plane in front of the view, into `cells` x `cells` cells of
// two triangles each. Paper, "Implementation" of the reconstruction: "Each plane is subdivided into a regular
// grid, and undistorted texture coordinates at the grid points are computed in software". Triangle 2 i is the
// upper left half of cell i, triangle 2 i + 1 the lower right half; cells count row by row. Immutable.
// Thread: any.
class PlaneGrid {
 public:
  // Throws: PreconditionError unless `cells` is 1 to 1024.
  PlaneGrid(const core::CameraModel& view, int cells);

  [[nodiscard]] std::size_t triangles() const { return 2 * static_cast<std::size_t>(cells_ * cells_); }

  // The triangle that the centre of the view's pixel is in.
  [[nodiscard]] std::size_t TriangleOf(int x, int y) const;

  // Positions in the view's picture, whose pixel centres are at integers. The first is the cell's corner that
  // the triangle doesn't share with the cell's other half.
  [[nodiscard]] std::array<Eigen::Vector2d, 3> CornersOf(std::size_t triangle) const;

  // One a triangle, for the plane at `depth_mm` along the view's z axis: exact at the corners. Beyond the
  // lens's domain, which ends just outside of the picture, the lens goes on with the magnification of the
  // domain's rim, so that triangles across the picture's border keep their positions. Nothing where a corner
  // has no ray in the view: such a triangle counts as exterior.
  [[nodiscard]] std::vector<std::optional<GridTriangle>> PositionsOf(const SweepCamera& camera,
                                                                     double depth_mm) const;

 private:
  [[nodiscard]] Eigen::Vector2d NodePx(int column, int row) const;
  [[nodiscard]] std::size_t NodeIndex(int column, int row) const {
    return static_cast<std::size_t>(row * (cells_ + 1) + column);
  }
  // The nodes of a triangle, in the order of CornersOf: column and row.
  [[nodiscard]] std::array<Eigen::Vector2i, 3> NodesOf(std::size_t triangle) const;

  int cells_;
  Eigen::Vector2d cell_px_;                           // the size of a cell in the view's picture
  std::vector<std::optional<Eigen::Vector2d>> rays_;  // of the nodes, normalised
};

}  // namespace elbowroom::recon
