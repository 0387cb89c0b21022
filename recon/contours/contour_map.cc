#include "recon/contours/contour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/infinity.h"
#include "recon/contours/contour_cells.h"
#include "recon/contours/contour_kernel.h"
#include "recon/contours/raw_bytes.h"

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

// x and y of one after the other.
template <typename Vertices>
auto CoordinatesOf(Vertices& vertices) {
  static_assert(sizeof(Vector2d) == 2 * sizeof(double));
  const std::span all(vertices);
  return std::span(all.empty() ? nullptr : all.front().data(), 2 * all.size());
}

}  // namespace

// Queries of the contour's cells.
class ContourMap::Grid {
 public:
  Grid(const Contour& contour, bool exterior_is_object, const Eigen::AlignedBox2d& bounds_px)
      : cells_(contour, exterior_is_object, bounds_px) {}

  // One that was written, of the same contour.
  Grid(const Contour& contour, const Eigen::AlignedBox2d& bounds_px, RawReader* reader)
      : cells_(contour, bounds_px, reader) {}

  void Write(RawWriter* writer) const { cells_.Write(writer); }
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

std::string ContourMap::Bytes() const {
  RawWriter writer;
  writer.AddOne(exterior_is_object_);
  writer.AddOne(contour_.vertices.size());
  writer.Add(std::span<const double>(CoordinatesOf(contour_.vertices)));
  writer.AddOne(contour_.edges.size());
  writer.Add(std::span<const ContourEdge>(contour_.edges));
  if (!bounds_px_.isEmpty()) grid().Write(&writer);
  return std::move(writer).Take();
}

std::shared_ptr<const ContourMap> ContourMap::FromBytes(std::string_view bytes) {
  try {
    RawReader reader(bytes);
    const bool exterior_is_object = reader.ReadOne<char>() != 0;
    Contour contour;
    contour.vertices.resize(reader.ReadCount(sizeof(Vector2d)));
    reader.Read(CoordinatesOf(contour.vertices));
    contour.edges.resize(reader.ReadCount(sizeof(ContourEdge)));
    reader.Read(std::span(contour.edges));
    contour.edge_from.resize(contour.vertices.size());
    contour.edge_to.resize(contour.vertices.size());
    for (std::uint32_t e = 0; e < contour.edges.size(); ++e) {
      const auto& [from, to] = contour.edges[e];
      RawReader::Check(from < contour.vertices.size() && to < contour.vertices.size());
      contour.edge_from[from] = e;
      contour.edge_to[to] = e;
    }
    const auto map = std::make_shared<ContourMap>(std::move(contour), exterior_is_object);
    if (map->bounds_px_.isEmpty()) return map;
    std::call_once(map->once_, [&] {
      map->grid_ = std::make_unique<const Grid>(map->contour_, map->bounds_px_, &reader);
    });
    map->ready_.store(map->grid_.get(), std::memory_order_release);
    return map;
  } catch (const core::Error&) {
    return nullptr;
  }
}

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
