// The label that a contour gives to any position of its plane, and how far around it the label is sure to
// hold.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "recon/contours/contour.h"
#include "recon/contours/contour_cells_view.h"

namespace elbowroom::recon {

struct PlaneLabel {
  bool is_object = false;
  // Certified: every position nearer than this carries the same label. Infinite where nothing differs.
  double distance_px = 0.0;
};

// A contour with queries. Its grid of cells is built at the first query of a position; time and memory grow
// with the contour's bounds. Without a query nothing is built. Immutable. Thread: any.
class ContourMap {
 public:
  ContourMap(Contour contour, bool exterior_is_object);
  ~ContourMap();

  // Contour and grid as bytes, for this program: FromBytes() gives a map with the same answers in a fraction
  // of the time that making it takes. Builds the grid. Null: the bytes aren't those of a map.
  [[nodiscard]] std::string Bytes() const;
  [[nodiscard]] static std::shared_ptr<const ContourMap> FromBytes(std::string_view bytes);

  [[nodiscard]] const Contour& contour() const { return contour_; }
  [[nodiscard]] bool exterior_is_object() const { return exterior_is_object_; }

  // The box of all edges. Empty if there are none: then every position is exterior.
  [[nodiscard]] const Eigen::AlignedBox2d& bounds_px() const { return bounds_px_; }

  // All edges lie within this distance of the principal axis.
  [[nodiscard]] double max_radius_px() const { return max_radius_px_; }

  // The label of any finite position.
  [[nodiscard]] bool IsObject(const Eigen::Vector2d& position) const;

  // Within the bounds the distance is exact to 1e-6 up to 2 cells from an edge, at most 3 cells short up to
  // 11, farther away at most 11.5; outside it is at least as good as the distance to the bounds, less 3
  // cells. A cell is 1 px, or larger where that would make more than 4e6 of them (contour_map_test). A
  // distance that is sure to be at least `enough_px`, or sure to be less, isn't worked out any closer.
  [[nodiscard]] PlaneLabel LabelAt(const Eigen::Vector2d& position,
                                   double enough_px = std::numeric_limits<double>::infinity()) const;

  // An upper bound of the distance to the nearest edge, at most 3 cells above it up to 8, farther away
  // at most 20; infinite outside of the bounds.
  [[nodiscard]] double EdgeWithinPx(const Eigen::Vector2d& position) const;

  // The grid's cells, for queries of many positions. There are no cells if there are no edges. Valid as long
  // as the map lives.
  [[nodiscard]] ContourCellsView CellsView() const;

  // The nearest edge, if one is within 2 cells.
  [[nodiscard]] std::optional<std::uint32_t> NearestEdge(const Eigen::Vector2d& position) const;

 private:
  class Grid;
  [[nodiscard]] const Grid& grid() const;

  Contour contour_;
  bool exterior_is_object_ = false;
  Eigen::AlignedBox2d bounds_px_;
  double max_radius_px_ = 0.0;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const Grid> grid_;
  mutable std::atomic<const Grid*> ready_ = nullptr;  // grid_, once it is there
};

}  // namespace elbowroom::recon
