#include "recon/contour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "recon/cell_distances.h"
#include "recon/contour_kernel.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Cells around the bounds, so that near positions outside are answered as well as those within.
constexpr int kMarginCells = 16;
constexpr double kMostCells = 4e6;
// Half a cell's diagonal.
constexpr double kHalfDiagonal = 0.70710678118654757;
// Cells looked at edge by edge, to each side; whatever lies beyond them is at least as many cells away.
constexpr int kWindowCells = 2;
// Rounding of a position and of a distance.
constexpr double kRoundingPx = 1e-7;
constexpr double kTouch = LabelRaster::kTouchCells;

double SquaredDistance(const Vector2d& p, const LabelRaster::Edge& edge) {
  const Vector2d a(edge.from_x, edge.from_y), b(edge.to_x, edge.to_y), ab = b - a, ap = p - a;
  const double along = ab.dot(ap), length2 = ab.squaredNorm();
  if (!(along > 0.0)) return ap.squaredNorm();
  if (along >= length2) return (p - b).squaredNorm();
  return (ap - ab * (along / length2)).squaredNorm();
}

}  // namespace

// Square cells over the contour's bounds and a margin. In each: the edges that touch it, the label of its
// centre, a lower bound of the distance to the nearest cell with an edge.
class ContourMap::Grid {
 public:
  Grid(const Contour& contour, bool exterior_is_object, const Eigen::AlignedBox2d& bounds_px)
      : contour_(contour) {
    const Vector2d size_px = bounds_px.sizes();
    cell_px_ = std::max(1.0, std::sqrt(size_px.prod() / kMostCells));
    cell_px_ = std::max(cell_px_, size_px.maxCoeff() / kMostCells);
    cells_per_px_ = 1.0 / cell_px_;
    cells_ = (size_px / cell_px_).array().ceil().cast<int>() + 1 + 2 * kMarginCells;
    origin_ = bounds_px.center() - 0.5 * cell_px_ * cells_.cast<double>();
    ListEdges();
    LabelCentres(exterior_is_object);
    distances_ = CellDistances(cells_.x(), cells_.y(), first_);
  }

  [[nodiscard]] LabelRaster Raster() const {
    return {origin_.x(), origin_.y(), cell_px_, cells_per_px_,
            cells_.x(),  cells_.y(),  labels_,  distances_.near_squares(),
            first_,      segments_};
  }

  struct Place {
    Eigen::Vector2i cell;
    std::size_t index = 0;
    Vector2d from_centre;  // in cells
  };

  [[nodiscard]] std::optional<Place> Find(const Vector2d& position) const {
    const Vector2d at = (position - origin_) * cells_per_px_;
    // Written so that a NaN is outside.
    if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() < cells_.x() && at.y() < cells_.y())) return std::nullopt;
    const Eigen::Vector2i cell = at.cast<int>();
    return Place{cell, Index(cell.x(), cell.y()), at - cell.cast<double>() - Vector2d::Constant(0.5)};
  }

  [[nodiscard]] bool LabelOf(const Place& place, const Vector2d& position) const {
    const std::uint8_t label = labels_[place.index];
    const bool at_centre = (label & LabelRaster::kObject) != 0;
    if ((label & LabelRaster::kMixed) == 0) return at_centre;
    const Vector2d centre = Centre(place.cell.x(), place.cell.y());
    const std::span edges(segments_.data() + first_[place.index], segments_.data() + first_[place.index + 1]);
    return at_centre != ChangesInCell(edges, {centre.x(), centre.y()}, {position.x(), position.y()});
  }

  // Lower bound, in px.
  [[nodiscard]] double DistanceOf(const Place& place, const Vector2d& position, double enough_px) const {
    const double cells = distances_.LowerBound(place.cell.x(), place.cell.y());
    const double off_centre = place.from_centre.norm();
    const double bound_px = (cells - kHalfDiagonal - off_centre) * cell_px_;
    if (bound_px >= enough_px) return bound_px;
    constexpr double kShortBy = 0.125;
    const bool is_sure_to_be_less =
        !std::isinf(enough_px) && (cells + kShortBy + kHalfDiagonal + off_centre) * cell_px_ < enough_px;
    if (is_sure_to_be_less) return bound_px;
    double within_px = kInfinity;  // cells as far as that aren't in the window
    if (cells < kWindowCells + 1) within_px = NearestInWindow(place, position).second;
    return std::max(bound_px, std::min(within_px, kWindowCells * cell_px_));
  }

  [[nodiscard]] std::optional<std::uint32_t> NearestEdge(const Place& place, const Vector2d& position) const {
    const auto [edge, distance_px] = NearestInWindow(place, position);
    if (!(distance_px <= kWindowCells * cell_px_)) return std::nullopt;
    return edge;
  }

 private:
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(cells_.x()) + static_cast<std::size_t>(x);
  }

  [[nodiscard]] const Vector2d& From(std::uint32_t edge) const {
    return contour_.vertices[contour_.edges[edge].from];
  }
  [[nodiscard]] const Vector2d& To(std::uint32_t edge) const {
    return contour_.vertices[contour_.edges[edge].to];
  }

  // Calls visit(index of cell) for the cells that an edge touches, row by row.
  template <typename Visit>
  void VisitCells(std::uint32_t edge, const Visit& visit) const {
    Vector2d a = (From(edge) - origin_) * cells_per_px_, b = (To(edge) - origin_) * cells_per_px_;
    if (a.y() > b.y()) std::swap(a, b);
    const int top = static_cast<int>(a.y() - kTouch), bottom = static_cast<int>(b.y() + kTouch);
    // A level edge is near all of the rows that it touches, from end to end.
    const bool is_level = b.y() - a.y() < kTouch;
    const double slope = is_level ? 0.0 : (b.x() - a.x()) / (b.y() - a.y());
    for (int y = top; y <= bottom; ++y) {
      double x0 = a.x(), x1 = b.x();
      if (y > top && !is_level) x0 = a.x() + (y - kTouch - a.y()) * slope;
      if (y < bottom && !is_level) x1 = a.x() + (y + 1 + kTouch - a.y()) * slope;
      if (x0 > x1) std::swap(x0, x1);
      // Rounding must not leave the edge's own box.
      x0 = std::max(x0, std::min(a.x(), b.x())), x1 = std::min(x1, std::max(a.x(), b.x()));
      const int left = static_cast<int>(x0 - kTouch), right = static_cast<int>(x1 + kTouch);
      for (int x = left; x <= right; ++x) visit(Index(x, y));
    }
  }

  void ListEdges() {
    first_.assign(Index(0, cells_.y()) + 1, 0);
    const auto edges = static_cast<std::uint32_t>(contour_.edges.size());
    for (std::uint32_t e = 0; e < edges; ++e) VisitCells(e, [&](std::size_t cell) { ++first_[cell + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    listed_.resize(first_.back());
    segments_.resize(first_.back() + LabelRaster::kEdgesBehind);
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t e = 0; e < edges; ++e) {
      VisitCells(e, [&](std::size_t cell) {
        segments_[next[cell]] = {From(e).x(), From(e).y(), To(e).x(), To(e).y()};
        listed_[next[cell]++] = e;
      });
    }
  }

  // Along each row of centres, from the left; an edge flips every centre at or right of where it crosses.
  void LabelCentres(bool exterior_is_object) {
    labels_.assign(first_.size() - 1 + LabelRaster::kBytesBehind, 0);
    for (std::uint32_t e = 0; e < contour_.edges.size(); ++e) {
      const Vector2d &a = From(e), &b = To(e);
      const double low = std::min(a.y(), b.y()), high = std::max(a.y(), b.y());
      const int first_row = static_cast<int>((low - origin_.y()) / cell_px_);
      for (int y = first_row; y < cells_.y() && Centre(0, y).y() <= high; ++y) {
        const double centre_y = Centre(0, y).y();
        if ((a.y() > centre_y) == (b.y() > centre_y)) continue;
        int x = static_cast<int>((CrossingX(a, b, centre_y) - origin_.x()) / cell_px_);
        if (Centre(x, y).x() < CrossingX(a, b, centre_y)) ++x;
        labels_[Index(x, y)] ^= LabelRaster::kObject;
      }
    }
    for (int y = 0; y < cells_.y(); ++y) {
      std::uint8_t label = exterior_is_object ? LabelRaster::kObject : 0;
      for (std::size_t i = Index(0, y); i < Index(0, y + 1); ++i) {
        label ^= labels_[i];
        labels_[i] = first_[i] == first_[i + 1] ? label : label | LabelRaster::kMixed;
      }
    }
  }

  [[nodiscard]] Vector2d Centre(int x, int y) const {
    return origin_ + cell_px_ * Vector2d(x + 0.5, y + 0.5);
  }
  static double CrossingX(const Vector2d& a, const Vector2d& b, double y) {
    return a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  }

  [[nodiscard]] std::pair<std::uint32_t, double> NearestInWindow(const Place& place,
                                                                 const Vector2d& p) const {
    std::pair<std::uint32_t, double> nearest{0, kInfinity};
    const int left = std::max(place.cell.x() - kWindowCells, 0);
    const int right = std::min(place.cell.x() + kWindowCells, cells_.x() - 1);
    const int bottom = std::min(place.cell.y() + kWindowCells, cells_.y() - 1);
    for (int y = std::max(place.cell.y() - kWindowCells, 0); y <= bottom; ++y) {
      for (std::uint32_t i = first_[Index(left, y)]; i < first_[Index(right, y) + 1]; ++i) {
        const double squared = SquaredDistance(p, segments_[i]);
        if (squared < nearest.second) nearest = {listed_[i], squared};
      }
    }
    nearest.second = std::sqrt(nearest.second);
    return nearest;
  }

  const Contour& contour_;
  double cell_px_ = 1.0, cells_per_px_ = 1.0;
  Eigen::Vector2i cells_{0, 0};
  Vector2d origin_{0.0, 0.0};
  std::vector<std::uint32_t> first_;  // of each cell's edges, in listed_; one more at the end
  std::vector<std::uint32_t> listed_;
  std::vector<LabelRaster::Edge> segments_;  // as listed_, and kEdgesBehind more
  std::vector<std::uint8_t> labels_;         // LabelRaster's; of a mixed cell kObject is its centre's
  CellDistances distances_;
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

LabelRaster ContourMap::Raster() const {
  if (!bounds_px_.isEmpty()) return grid().Raster();
  static constexpr std::array<std::uint8_t, 1 + LabelRaster::kBytesBehind> kBackground{0},
      kObject{LabelRaster::kObject};
  LabelRaster nothing;
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
