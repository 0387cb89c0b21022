#include "recon/contours/contour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/infinity.h"
#include "recon/contours/contour_cells.h"
#include "recon/contours/contour_kernel.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

using core::kInfinity;
// Half a cell's diagonal.
constexpr double kHalfDiagonal = 0.70710678118654757;
// Cells to each side whose edges are looked at one by one. Edges beyond them are at least as many cells away.
constexpr int kWindowCells = 2;
// Rounding of a position and of a distance.
constexpr double kRoundingPx = 1e-7;

double SquaredDistance(const Vector2d& p, const ContourCellsView::Edge& edge) {
  const Vector2d a(edge.from_x, edge.from_y), b(edge.to_x, edge.to_y), ab = b - a, ap = p - a;
  const double along = ab.dot(ap), length2 = ab.squaredNorm();
  if (!(along > 0.0)) return ap.squaredNorm();
  if (along >= length2) return (p - b).squaredNorm();
  return (ap - ab * (along / length2)).squaredNorm();
}

}  // namespace

// Queries of the contour's cells.
class ContourMap::Grid {
 public:
  Grid(const Contour& contour, bool exterior_is_object, const Eigen::AlignedBox2d& bounds_px)
      : cells_(contour, exterior_is_object, bounds_px) {}

  [[nodiscard]] ContourCellsView CellsView() const { return cells_.CellsView(); }

  struct Place {
    Eigen::Vector2i cell;
    std::size_t index = 0;
    Vector2d from_centre;  // in cells
  };

  [[nodiscard]] std::optional<Place> Find(const Vector2d& position) const {
    const Vector2d at = (position - cells_.origin_px()) * cells_.cells_per_px();
    const Eigen::Vector2i& size = cells_.size();
    // Written so that a NaN is outside.
    if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() < size.x() && at.y() < size.y())) return std::nullopt;
    const Eigen::Vector2i cell = at.cast<int>();
    return Place{cell, cells_.Index(cell.x(), cell.y()), at - cell.cast<double>() - Vector2d::Constant(0.5)};
  }

  [[nodiscard]] bool LabelOf(const Place& place, const Vector2d& position) const {
    const std::uint8_t label = cells_.Label(place.index);
    const bool at_centre = (label & ContourCellsView::kObject) != 0;
    if ((label & ContourCellsView::kMixed) == 0) return at_centre;
    const Vector2d centre = cells_.Centre(place.cell.x(), place.cell.y());
    return at_centre != LabelDiffersInCell(cells_.Edges(place.index), {centre.x(), centre.y()},
                                           {position.x(), position.y()});
  }

  // Lower bound, in px.
  [[nodiscard]] double DistanceOf(const Place& place, const Vector2d& position, double enough_px) const {
    const double cell_px = cells_.cell_px();
    const double cells = cells_.distances().LowerBound(place.cell.x(), place.cell.y());
    const double off_centre = place.from_centre.norm();
    const double bound_px = (cells - kHalfDiagonal - off_centre) * cell_px;
    if (bound_px >= enough_px) return bound_px;
    const bool is_sure_to_be_less = !std::isinf(enough_px) && AtMostPx(cells, off_centre) < enough_px;
    if (is_sure_to_be_less) return bound_px;  // the window isn't searched
    double within_px = kInfinity;             // no edge is in the window if the nearest mixed cell is farther
    if (cells < kWindowCells + 1) within_px = NearestInWindow(place, position).second;
    return std::max(bound_px, std::min(within_px, kWindowCells * cell_px));
  }

  // Upper bound, in px: the nearest edge touches a cell that holds some, or passes within kTouchCells of it,
  // so it is no farther than that cell's far corner and kShortBy.
  [[nodiscard]] double AtMostPx(const Place& place) const {
    return AtMostPx(cells_.distances().LowerBound(place.cell.x(), place.cell.y()), place.from_centre.norm());
  }
  [[nodiscard]] double AtMostPx(double lower_bound_cells, double off_centre_cells) const {
    constexpr double kShortBy = 0.125;
    const double cells = CellDistances::UpperBoundFrom(lower_bound_cells);
    return (cells + kShortBy + kHalfDiagonal + off_centre_cells) * cells_.cell_px();
  }

  [[nodiscard]] std::optional<std::uint32_t> NearestEdge(const Place& place, const Vector2d& position) const {
    const auto [edge, distance_px] = NearestInWindow(place, position);
    if (!(distance_px <= kWindowCells * cells_.cell_px())) return std::nullopt;
    return edge;
  }

 private:
  [[nodiscard]] std::pair<std::uint32_t, double> NearestInWindow(const Place& place,
                                                                 const Vector2d& p) const {
    std::pair<std::uint32_t, double> nearest{0, kInfinity};
    const int left = std::max(place.cell.x() - kWindowCells, 0);
    const int right = std::min(place.cell.x() + kWindowCells, cells_.size().x() - 1);
    const int bottom = std::min(place.cell.y() + kWindowCells, cells_.size().y() - 1);
    for (int y = std::max(place.cell.y() - kWindowCells, 0); y <= bottom; ++y) {
      const std::uint32_t end = cells_.First(cells_.Index(right, y) + 1);
      for (std::uint32_t i = cells_.First(cells_.Index(left, y)); i < end; ++i) {
        const double squared = SquaredDistance(p, cells_.Edge(i));
        if (squared < nearest.second) nearest = {cells_.ContourEdge(i), squared};
      }
    }
    nearest.second = std::sqrt(nearest.second);
    return nearest;
  }

  ContourCells cells_;
};

ContourMap::ContourMap(Contour contour, bool exterior_is_object)
    : contour_(std::move(contour)), exterior_is_object_(exterior_is_object) {
  double squared = 0.0;
  for (const Vector2d& vertex : contour_.vertices) {
    bounds_px_.extend(vertex);
    squared = std::max(squared, vertex.squaredNorm());
  }
  max_radius_px_ = std::sqrt(squared);
}

ContourMap::~ContourMap() = default;

const ContourMap::Grid& ContourMap::grid() const {
  if (const Grid* ready = ready_.load(std::memory_order_acquire)) return *ready;
  std::call_once(once_,
                 [this] { grid_ = std::make_unique<const Grid>(contour_, exterior_is_object_, bounds_px_); });
  ready_.store(grid_.get(), std::memory_order_release);
  return *grid_;
}

bool ContourMap::IsObject(const Vector2d& position) const {
  if (bounds_px_.isEmpty()) return exterior_is_object_;
  const std::optional<Grid::Place> place = grid().Find(position);
  return place ? grid().LabelOf(*place, position) : exterior_is_object_;
}

PlaneLabel ContourMap::LabelAt(const Vector2d& position, double enough_px) const {
  if (bounds_px_.isEmpty()) return {exterior_is_object_, kInfinity};
  const std::optional<Grid::Place> place = grid().Find(position);
  PlaneLabel label{exterior_is_object_, 0.0};
  if (place) {
    label = {grid().LabelOf(*place, position), grid().DistanceOf(*place, position, enough_px)};
  } else {
    label.distance_px = bounds_px_.exteriorDistance(position);
  }
  label.distance_px = std::max(label.distance_px - kRoundingPx, 0.0);
  return label;
}

double ContourMap::EdgeWithinPx(const Vector2d& position) const {
  if (bounds_px_.isEmpty()) return kInfinity;
  const std::optional<Grid::Place> place = grid().Find(position);
  return place ? grid().AtMostPx(*place) + kRoundingPx : kInfinity;
}

ContourCellsView ContourMap::CellsView() const {
  if (!bounds_px_.isEmpty()) return grid().CellsView();
  static constexpr std::array<std::uint8_t, 1 + ContourCellsView::kBytesBehind> kBackground{0},
      kObject{ContourCellsView::kObject};
  ContourCellsView nothing;
  nothing.labels = exterior_is_object_ ? kObject : kBackground;
  return nothing;
}

std::optional<std::uint32_t> ContourMap::NearestEdge(const Vector2d& position) const {
  if (bounds_px_.isEmpty()) return std::nullopt;
  const std::optional<Grid::Place> place = grid().Find(position);
  if (!place) return std::nullopt;
  return grid().NearestEdge(*place, position);
}

}  // namespace elbowroom::recon
