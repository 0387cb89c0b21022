#include "recon/contours/contour_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

// Cells around the bounds, so that near positions outside are answered as well as those within.
constexpr int kMarginCells = 16;
constexpr double kMostCells = 4e6;
constexpr double kTouch = ContourCellsView::kTouchCells;

// A set of cells, to be walked in order.
class CellSet {
 public:
  explicit CellSet(std::size_t cells) : words_((cells + kBits - 1) / kBits, 0) {}

  void Insert(std::size_t cell) { words_[cell / kBits] |= Bit(cell); }
  void Flip(std::size_t cell) { words_[cell / kBits] ^= Bit(cell); }

  // Calls visit(cell), ascending.
  template <typename Visit>
  void ForEach(const Visit& visit) const {
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t left = words_[w]; left != 0; left &= left - 1)
        visit(w * kBits + static_cast<std::size_t>(std::countr_zero(left)));
  }

 private:
  static constexpr std::size_t kBits = 64;
  static std::uint64_t Bit(std::size_t cell) { return std::uint64_t{1} << (cell % kBits); }

  std::vector<std::uint64_t> words_;
};

double CrossingX(const Vector2d& a, const Vector2d& b, double y) {
  return a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
}

}  // namespace

ContourCells::ContourCells(const Eigen::AlignedBox2d& bounds_px) {
  const Vector2d extent_px = bounds_px.sizes();
  cell_px_ = std::max(1.0, std::sqrt(extent_px.prod() / kMostCells));
  cell_px_ = std::max(cell_px_, extent_px.maxCoeff() / kMostCells);
  cells_per_px_ = 1.0 / cell_px_;
  size_ = (extent_px / cell_px_).array().ceil().cast<int>() + 1 + 2 * kMarginCells;
  origin_px_ = bounds_px.center() - 0.5 * cell_px_ * size_.cast<double>();
  count_ = Index(0, size_.y());
}

ContourCells::ContourCells(const Contour& contour, bool exterior_is_object,
                           const Eigen::AlignedBox2d& bounds_px)
    : ContourCells(bounds_px) {
  const std::vector<std::uint32_t> mixed_cells = ListEdges(contour);
  LabelCentres(contour, exterior_is_object, mixed_cells);
  distances_ = CellDistances(size_.x(), size_.y(), mixed_cells);
}

// Of first_, only where it changes.
void ContourCells::Write(RawWriter* writer) const {
  std::vector<std::uint32_t> cells, edges;  // that have some, and how many
  for (std::uint32_t cell = 0; cell < count_; ++cell) {
    if (first_[cell + 1] == first_[cell]) continue;
    cells.push_back(cell);
    edges.push_back(first_[cell + 1] - first_[cell]);
  }
  writer->AddOne(cells.size());
  writer->Add(std::span<const std::uint32_t>(cells));
  writer->Add(std::span<const std::uint32_t>(edges));
  writer->AddOne(listed_.size());
  writer->Add(std::span<const std::uint32_t>(listed_));
  writer->Add(std::span<const std::uint8_t>(labels_.get(), count_));
  distances_.Write(writer);
}

ContourCells::ContourCells(const Contour& contour, const Eigen::AlignedBox2d& bounds_px, RawReader* reader)
    : ContourCells(bounds_px) {
  std::vector<std::uint32_t> cells(reader->ReadCount(2 * sizeof(std::uint32_t))), edges(cells.size());
  reader->Read(std::span(cells));
  reader->Read(std::span(edges));
  listed_.resize(reader->ReadCount(sizeof(std::uint32_t)));
  reader->Read(std::span(listed_));
  RawReader::Check(listed_.empty() || std::ranges::max(listed_) < contour.edges.size());
  first_ = std::make_unique_for_overwrite<std::uint32_t[]>(count_ + 1);
  std::uint32_t begin = 0;
  std::size_t filled = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    RawReader::Check(cells[i] >= filled && cells[i] < count_ && edges[i] <= listed_.size() - begin);
    std::fill(first_.get() + filled, first_.get() + cells[i] + 1, begin);
    filled = cells[i] + std::size_t{1};
    begin += edges[i];
  }
  std::fill(first_.get() + filled, first_.get() + count_ + 1, begin);
  RawReader::Check(begin == listed_.size());
  TakeSegments(contour);
  labels_ = std::make_unique_for_overwrite<std::uint8_t[]>(count_ + ContourCellsView::kBytesBehind);
  reader->Read(std::span(labels_.get(), count_));
  std::fill_n(labels_.get() + count_, ContourCellsView::kBytesBehind, std::uint8_t{0});
  distances_ = CellDistances(size_.x(), size_.y(), reader);
}

ContourCellsView ContourCells::CellsView() const {
  return {origin_px_.x(),
          origin_px_.y(),
          cell_px_,
          cells_per_px_,
          size_.x(),
          size_.y(),
          {labels_.get(), count_ + ContourCellsView::kBytesBehind},
          distances_.near_squares(),
          {first_.get(), count_ + 1},
          segments_};
}

// Calls visit(index of cell) for the cells that an edge touches, row by row.
template <typename Visit>
void ContourCells::VisitCells(const Vector2d& from, const Vector2d& to, const Visit& visit) const {
  Vector2d a = (from - origin_px_) * cells_per_px_, b = (to - origin_px_) * cells_per_px_;
  if (a.y() > b.y()) std::swap(a, b);
  const int top = static_cast<int>(a.y() - kTouch), bottom = static_cast<int>(b.y() + kTouch);
  // A level edge is near all of the rows that it touches, from end to end.
  const bool is_level = b.y() - a.y() < kTouch;
  const double slope = is_level || top == bottom ? 0.0 : (b.x() - a.x()) / (b.y() - a.y());
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

std::vector<ContourCells::Touch> ContourCells::Touches(const Contour& contour) const {
  std::vector<Touch> touches;
  touches.reserve(3 * contour.edges.size());
  for (std::uint32_t e = 0; e < contour.edges.size(); ++e) {
    const auto& [from, to] = contour.edges[e];
    VisitCells(contour.vertices[from], contour.vertices[to], [&](std::size_t cell) {
      touches.push_back({static_cast<std::uint32_t>(cell), e});
    });
  }
  return touches;
}

// Returns the cells that have edges, ascending.
std::vector<std::uint32_t> ContourCells::ListEdges(const Contour& contour) {
  const std::vector<Touch> touches = Touches(contour);
  CellSet touched(count_);
  first_ = std::make_unique_for_overwrite<std::uint32_t[]>(count_ + 1);
  for (const Touch& touch : touches) {
    touched.Insert(touch.cell);
    first_[touch.cell] = 0;
  }
  for (const Touch& touch : touches) ++first_[touch.cell];
  // Cells without edges begin where the edges of the last cell before them end.
  std::vector<std::uint32_t> mixed_cells;
  std::uint32_t begin = 0;
  std::size_t filled = 0;
  touched.ForEach([&](std::size_t cell) {
    const std::uint32_t edges = first_[cell];
    std::fill(first_.get() + filled, first_.get() + cell + 1, begin);
    filled = cell + 1;
    begin += edges;
    mixed_cells.push_back(static_cast<std::uint32_t>(cell));
  });
  std::fill(first_.get() + filled, first_.get() + count_ + 1, begin);
  listed_.resize(touches.size());
  // Meanwhile first_ says where a cell's next edge goes; in the end, that is where the cell's edges end.
  for (const auto& [cell, e] : touches) listed_[first_[cell]++] = e;
  TakeSegments(contour);
  // Restores the beginnings, from the last cell to the first: first_ of the cell before is where its edges
  // end, which is where this one's begin.
  for (std::size_t i = mixed_cells.size(); i-- > 0;)
    first_[mixed_cells[i]] = mixed_cells[i] == 0 ? 0 : first_[mixed_cells[i] - 1];
  return mixed_cells;
}

void ContourCells::TakeSegments(const Contour& contour) {
  segments_.resize(listed_.size() + ContourCellsView::kEdgesBehind);
  for (std::size_t i = 0; i < listed_.size(); ++i) {
    const auto& [from, to] = contour.edges[listed_[i]];
    const Vector2d &a = contour.vertices[from], &b = contour.vertices[to];
    segments_[i] = {a.x(), a.y(), b.x(), b.y()};
  }
}

// Goes along each row of centres, from the left. An edge flips the label of each centre at or to the right of
// where it crosses the row. The contour is closed, so each row ends with the exterior label, with which the
// next one begins; all rows can be walked as one.
void ContourCells::LabelCentres(const Contour& contour, bool exterior_is_object,
                                std::span<const std::uint32_t> mixed_cells) {
  CellSet flips(count_);
  for (const auto& edge : contour.edges) {
    const Vector2d &a = contour.vertices[edge.from], &b = contour.vertices[edge.to];
    const double low = std::min(a.y(), b.y()), high = std::max(a.y(), b.y());
    for (int y = static_cast<int>((low - origin_px_.y()) / cell_px_); y < size_.y(); ++y) {
      const double centre_y = Centre(0, y).y();
      if (centre_y > high) break;
      if ((a.y() > centre_y) == (b.y() > centre_y)) continue;
      const double crossing_x = CrossingX(a, b, centre_y);
      int x = static_cast<int>((crossing_x - origin_px_.x()) / cell_px_);
      if (Centre(x, y).x() < crossing_x) ++x;
      flips.Flip(Index(x, y));
    }
  }
  labels_ = std::make_unique_for_overwrite<std::uint8_t[]>(count_ + ContourCellsView::kBytesBehind);
  std::uint8_t label = exterior_is_object ? ContourCellsView::kObject : 0;
  std::size_t labelled = 0;
  const auto label_to = [&](std::size_t end) {
    std::memset(labels_.get() + labelled, label, end - labelled);
    labelled = end;
  };
  flips.ForEach([&](std::size_t cell) {
    label_to(cell);
    label ^= ContourCellsView::kObject;
  });
  label_to(count_ + ContourCellsView::kBytesBehind);
  for (const std::uint32_t cell : mixed_cells) labels_[cell] |= ContourCellsView::kMixed;
}

}  // namespace elbowroom::recon
