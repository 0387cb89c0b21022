// The paper's collision detection: the volume query of a part's triangles, each sampled in a viewport of its
// own.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/triangle_mesh.h"
#include "recon/paper_methods/coverage_hull.h"

namespace elbowroom::recon {

struct TriangleViewportOptions {
  int width_px = 10;  // 2 to 400; the paper's
  int height_px = 10;

  // Throws: PreconditionError naming the field out of range.
  void Validate() const;
};

// A triangle seen along its normal, stretched until it fills a viewport: its base lies on the lower border
// from corner to corner, its apex on the upper border. Viewport positions: x to the right, y up, from the
// lower left corner; a pixel's centre is half a pixel from its lower left. The base is the side for which the
// larger of a pixel's width and height on the triangle is smallest, among the sides above which the apex
// stands. The apex' column is rounded to an odd sixteenth of a pixel: every OpenGL rasterises from such a
// place exactly and no pixel's centre is on an edge, so that all implementations cover the same pixels
// (docs/paper_collision.md). Corners keep their places in space, whatever is rounded in the viewport.
class TriangleViewport {
 public:
  // Corners in any one frame; triangles without area are sampled all the same.
  TriangleViewport(const std::array<Eigen::Vector3d, 3>& corners_mm, const TriangleViewportOptions& options);

  [[nodiscard]] const Eigen::Vector3d& origin_mm() const { return origin_mm_; }    // at viewport (0, 0)
  [[nodiscard]] const Eigen::Vector3d& along_x_mm() const { return along_x_mm_; }  // a pixel to the right
  [[nodiscard]] const Eigen::Vector3d& along_y_mm() const { return along_y_mm_; }  // a pixel up
  [[nodiscard]] double apex_x_px() const { return apex_sixteenths_ / 16.0; }

  // The columns [begin, end) of a row whose centres are in the triangle.
  struct Columns {
    int begin = 0, end = 0;
  };
  [[nodiscard]] Columns ColumnsOf(int row) const;
  [[nodiscard]] Eigen::Vector3d PositionOf(int column, int row) const {
    return origin_mm_ + (column + 0.5) * along_x_mm_ + (row + 0.5) * along_y_mm_;
  }
  // Width and height of a pixel on the triangle, the larger: the paper's x/u by y/v.
  [[nodiscard]] double StepMm() const { return step_mm_; }

 private:
  Eigen::Vector3d origin_mm_, along_x_mm_, along_y_mm_;
  double step_mm_ = 0.0;
  int width_px_, height_px_;
  int apex_sixteenths_ = 1;
};

// One viewport for each triangle of a part, in order, placed in the world.
[[nodiscard]] std::vector<TriangleViewport> MakeViewports(const core::TriangleMesh& part,
                                                          const core::RigidTransform& world_from_part,
                                                          const TriangleViewportOptions& options);

// One sample of the part that is in the hull: a collision point, CP_i.
struct ViewportContact {
  std::uint32_t triangle = 0;
  int column = 0, row = 0;  // of its viewport
  Eigen::Vector3d position_in_world_mm = Eigen::Vector3d::Zero();
};

// Work of one query in the paper's terms, for n cameras, m triangles, viewports of u x v in a window of x x
// y.
struct ViewportWork {
  std::int64_t triangles = 0;         // n m, transformed
  std::int64_t pixels = 0;            // about n m u v / 2, filled
  std::int64_t read_backs = 0;        // of the window: 1, more for parts whose viewports don't fit in one
  std::int64_t read_back_pixels = 0;  // x y, all windows
};

struct SampledContacts {
  std::vector<ViewportContact> contacts;  // triangle by triangle, row by row
  std::int64_t samples = 0;               // of all triangles
  double coarsest_step_mm = 0.0;          // a contact smaller than this may be missed
  ViewportWork work;
};

// Counts samples and work: all but the contacts and what is read back.
[[nodiscard]] SampledContacts CountSamples(std::span<const TriangleViewport> viewports, std::size_t cameras,
                                           const TriangleViewportOptions& options);

// Which samples of the part are in the hull, on the CPU, in double precision; the same samples as
// gl::TriangleViewportsGl's (triangle_viewports_test holds it to an oracle). Every sample is asked of one
// camera after the other, until one says background; nothing is read back. The result doesn't depend on the
// number of threads. A contact between samples is missed, and so is a hull inside a part that touches none of
// its faces. Throws: PreconditionError for options out of range.
[[nodiscard]] SampledContacts SampleTriangles(const CoverageHull& hull, const core::TriangleMesh& part,
                                              const core::RigidTransform& world_from_part,
                                              const TriangleViewportOptions& options = {});

// Where two queries of the same samples disagree.
struct SampleComparison {
  std::int64_t differing_samples = 0;
  std::int64_t unexplained_samples = 0;  // of those: CoverageHull::IsMatterOfRounding says no
};
[[nodiscard]] SampleComparison CompareSamples(const CoverageHull& hull, const SampledContacts& a,
                                              const SampledContacts& b);

}  // namespace elbowroom::recon
