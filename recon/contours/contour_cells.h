// Square cells laid over a contour.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "recon/contours/cell_distances.h"
#include "recon/contours/contour.h"
#include "recon/contours/contour_cells_view.h"
#include "recon/contours/raw_bytes.h"

namespace elbowroom::recon {

// Cells over the contour's bounds and a margin. Each has the edges that touch it, the label of its centre,
// and a lower bound of the distance to the nearest cell with an edge. Cell (x, y) is item y * width + x. Time
// and memory follow the number of cells. Immutable. Thread: any.
class ContourCells {
 public:
  // The contour must have edges, all within `bounds_px`.
  ContourCells(const Contour& contour, bool exterior_is_object, const Eigen::AlignedBox2d& bounds_px);
  // Those that were written, of the same contour. Throws: core::Error{kFile}: they weren't.
  ContourCells(const Contour& contour, const Eigen::AlignedBox2d& bounds_px, RawReader* reader);
  void Write(RawWriter* writer) const;

  [[nodiscard]] const Eigen::Vector2d& origin_px() const { return origin_px_; }
  [[nodiscard]] double cell_px() const { return cell_px_; }
  [[nodiscard]] double cells_per_px() const { return cells_per_px_; }
  [[nodiscard]] const Eigen::Vector2i& size() const { return size_; }
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x()) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] Eigen::Vector2d Centre(int x, int y) const {
    return origin_px_ + cell_px_ * Eigen::Vector2d(x + 0.5, y + 0.5);
  }

  // The bits of ContourCellsView. In a mixed cell kObject is the label of its centre.
  [[nodiscard]] std::uint8_t Label(std::size_t cell) const { return labels_[cell]; }
  // Where a cell's edges begin; those of the next one begin where they end.
  [[nodiscard]] std::uint32_t First(std::size_t cell) const { return first_[cell]; }
  [[nodiscard]] std::span<const ContourCellsView::Edge> Edges(std::size_t cell) const {
    return std::span(segments_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }
  [[nodiscard]] const ContourCellsView::Edge& Edge(std::uint32_t i) const { return segments_[i]; }
  [[nodiscard]] std::uint32_t ContourEdge(std::uint32_t i) const { return listed_[i]; }
  [[nodiscard]] const CellDistances& distances() const { return distances_; }

  // Valid as long as these cells live.
  [[nodiscard]] ContourCellsView CellsView() const;

 private:
  explicit ContourCells(const Eigen::AlignedBox2d& bounds_px);  // where they lie; nothing in them

  // An edge touches a cell.
  struct Touch {
    std::uint32_t cell, edge;
  };

  template <typename Visit>
  void VisitCells(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Visit& visit) const;
  [[nodiscard]] std::vector<Touch> Touches(const Contour& contour) const;
  std::vector<std::uint32_t> ListEdges(const Contour& contour);
  void TakeSegments(const Contour& contour);  // of the edges listed
  void LabelCentres(const Contour& contour, bool exterior_is_object,
                    std::span<const std::uint32_t> mixed_cells);

  double cell_px_ = 1.0, cells_per_px_ = 1.0;
  Eigen::Vector2i size_{0, 0};
  Eigen::Vector2d origin_px_{0.0, 0.0};
  std::size_t count_ = 0;
  std::unique_ptr<std::uint32_t[]> first_;  // of each cell's edges, in listed_; one more at the end
  std::vector<std::uint32_t> listed_;
  std::vector<ContourCellsView::Edge> segments_;  // as listed_, and kEdgesBehind more
  std::unique_ptr<std::uint8_t[]> labels_;        // and kBytesBehind more
  CellDistances distances_;
};

}  // namespace elbowroom::recon
