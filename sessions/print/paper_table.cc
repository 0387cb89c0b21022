#include "sessions/print/paper_table.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "sessions/print/paper_look.h"

namespace elbowroom::sessions {
namespace {

constexpr double kPadX = 4.0;  // left and right of a cell's text
constexpr double kPadY = 2.6;
constexpr double kDotSize = 6.0;
constexpr double kDotWidth = 10.0;           // with what is right of it
constexpr double kFewestLinesHeight = 36.0;  // of a row that is continued on the next page
// A table is at least so wide, of the page's.
constexpr double kLeastTableShare = 0.66;
// A word longer than this share of the page's width may be broken.
constexpr double kLongestWordShare = 0.22;
constexpr double kShortText = 52.0;  // isn't broken between words

double SnapshotHeight(const PngDrawing& picture) {
  return kSnapshotWidth * picture.height_px() / picture.width_px();
}

double IndentOf(const PaperCell& cell) { return cell.dot ? kDotWidth : 0.0; }

// How far each cell of a row is placed.
using Progress = std::vector<std::size_t>;

// The height of what fits of the row's rest into `room` (without padding), and where that ends.
double Fit(const PaperRow& row, double room, const Progress& from, Progress* to) {
  double height = 0.0;
  *to = from;
  for (std::size_t i = 0; i < row.cells.size(); ++i) {
    const PaperCell& cell = row.cells[i];
    if (cell.picture && from[i] == 0) {
      (*to)[i] = 1;
      height = std::max(height, SnapshotHeight(*cell.picture));
    } else if (!cell.picture && cell.text) {
      (*to)[i] = cell.text->EndWithin(from[i], room);
      height = std::max(height, cell.text->Height(from[i], (*to)[i]));
    }
  }
  return height;
}

bool IsDone(const PaperRow& row, const Progress& at) {
  for (std::size_t i = 0; i < row.cells.size(); ++i)
    if (row.cells[i].text && !row.cells[i].picture && at[i] < row.cells[i].text->line_count()) return false;
  return true;
}

void PutCell(const PaperCell& cell, std::size_t first, std::size_t end, double y, PaperPages* pages) {
  if (cell.picture) {
    if (first < end)
      pages->Put(
          PlacedPng{*cell.picture, {cell.left + kPadX, y, kSnapshotWidth, SnapshotHeight(*cell.picture)}});
    return;
  }
  if (!cell.text || first >= end) return;
  const double x = cell.left + kPadX;
  if (cell.dot && first == 0) {
    const double middle = y + 0.5 * cell.text->Height(0, 1);
    pages->Put(PlacedFill{{x, middle - 0.5 * kDotSize, kDotSize, kDotSize}, *cell.dot});
  }
  pages->Put(PlacedLines{*cell.text, first, end, x + IndentOf(cell), y});
}

// One page's share of a row. Returns where it ends.
Progress PutShare(const PaperRow& row, const Progress& from, PaperPages* pages) {
  Progress to;
  const double height = Fit(row, pages->room() - 2.0 * kPadY, from, &to) + 2.0 * kPadY;
  const double top = pages->y(), left = row.cells.front().left;
  const double right = row.cells.back().left + row.cells.back().width;
  if (row.wash) pages->Put(PlacedFill{{left, top, right - left, height}, *row.wash});
  for (std::size_t i = 0; i < row.cells.size(); ++i) {
    const PaperCell& cell = row.cells[i];
    if (row.is_framed) pages->Put(PlacedFrame{{cell.left, top, cell.width, height}, kLine});
    PutCell(cell, from[i], to[i], top + kPadY, pages);
  }
  if (row.rule > 0.0) pages->Put(PlacedFill{{left, top + height - row.rule, right - left, row.rule}, kLine});
  pages->Down(height);
  return to;
}

void PutHead(const PaperRow* head, PaperPages* pages) {
  if (head != nullptr) (void)PutShare(*head, Progress(head->cells.size(), 0), pages);
}

void PlaceRow(const PaperRow* head, const PaperRow& row, double needed, PaperPages* pages) {
  const double most = kBodyHeight - (head == nullptr ? 0.0 : head->Height());
  if (pages->room() < std::min(needed, most) && (needed <= most || pages->room() < kFewestLinesHeight)) {
    pages->Break();
    PutHead(head, pages);
  }
  Progress at(row.cells.size(), 0);
  for (bool is_continued = false;; is_continued = true) {
    const Progress next = PutShare(row, at, pages);
    if (IsDone(row, next)) return;
    core::Require(!is_continued || next != at, "a page holds a line");
    at = next;
    pages->Break();
    PutHead(head, pages);
  }
}

struct ColumnWidth {
  double least = 0.0;
  double natural = 0.0;
};

std::vector<double> WidthsOf(const std::vector<ColumnWidth>& columns) {
  double least = 0.0, natural = 0.0;
  for (const ColumnWidth& column : columns) {
    least += column.least;
    natural += column.natural;
  }
  std::vector<double> widths;
  const auto count = static_cast<double>(columns.size());
  const double spare = std::max(0.0, kLeastTableShare * kBodyWidth - natural) / count;
  const double share = natural > least ? std::clamp((kBodyWidth - least) / (natural - least), 0.0, 1.0) : 1.0;
  const double shrunk = std::min(1.0, kBodyWidth / least);
  for (const ColumnWidth& column : columns)
    widths.push_back(shrunk * (column.least + share * (column.natural - column.least)) + spare);
  return widths;
}

// A table's cells, of which none has its place yet.
class TableMaker {
 public:
  TableMaker(const PaperFonts& fonts, const DocumentTable& table, const InkColors& inks)
      : fonts_(fonts), table_(table), inks_(inks), widths_(table.columns.size()) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      PaperCell cell;
      cell.text.emplace(fonts, table.columns[i].title, HeadLook(table.columns[i].is_number));
      Measure(&cell, false, &widths_[i]);
      head_.cells.push_back(std::move(cell));
    }
    head_.rule = 1.2;
    for (const DocumentRow& row : table.rows) rows_.push_back(Row(row));
  }

  void Place(PaperPages* pages) {
    const std::vector<double> widths = WidthsOf(widths_);
    Settle(widths, &head_);
    for (PaperRow& row : rows_) Settle(widths, &row);
    PlaceRows(&head_, rows_, pages);
  }

 private:
  PaperRow Row(const DocumentRow& row) {
    PaperRow paper;
    if (row.begins_group) {
      paper.cells.emplace_back().text.emplace(fonts_, row.cells.front().text, GroupLook());
      paper.stays_with_next = true;
      return paper;
    }
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      paper.cells.push_back(Cell(row.cells[i], i, row.is_highlighted && i == 0));
    if (row.is_highlighted) paper.wash = kHighlight;
    return paper;
  }

  PaperCell Cell(const DocumentCell& cell, std::size_t column, bool is_strong) {
    const bool is_number = table_.columns[column].is_number;
    PaperCell paper;
    if (!cell.png.empty()) {
      paper.picture.emplace(cell.png);
      widths_[column].least = std::max(widths_[column].least, kSnapshotWidth + 2.0 * kPadX);
      widths_[column].natural = std::max(widths_[column].natural, kSnapshotWidth + 2.0 * kPadX);
      return paper;
    }
    if (!cell.dot.empty()) paper.dot = InkColor(cell.dot, inks_);
    TextLook look = CellLook(is_number);
    look.is_strong = is_strong;
    paper.text.emplace(fonts_, cell.text, look);
    Measure(&paper, is_number, &widths_[column]);
    return paper;
  }

  // Words of others may be long, and break; numbers stay whole.
  static void Measure(PaperCell* cell, bool stays_whole, ColumnWidth* width) {
    const double around = 2.0 * kPadX + IndentOf(*cell);
    const double longest = stays_whole ? 0.5 * kBodyWidth : kLongestWordShare * kBodyWidth;
    const double natural = cell->text->NaturalWidth();
    const double least = std::max(cell->text->LeastWidth(), std::min(natural, kShortText));
    width->least = std::max(width->least, std::min(least, longest) + around);
    width->natural = std::max(width->natural, std::min(natural, kBodyWidth) + around);
    width->natural = std::max(width->natural, width->least);
  }

  static void Settle(const std::vector<double>& widths, PaperRow* row) {
    constexpr double kRounding = 0.05;  // a text as wide as its cell isn't broken
    const bool is_one = row->cells.size() != widths.size();
    double left = kMarginX;
    for (std::size_t i = 0; i < row->cells.size(); ++i) {
      PaperCell& cell = row->cells[i];
      cell.left = left;
      cell.width = is_one ? std::accumulate(widths.begin(), widths.end(), 0.0) : widths[i];
      left += cell.width;
      if (cell.text) cell.text->Wrap(cell.width - 2.0 * kPadX - IndentOf(cell) + kRounding);
    }
  }

  const PaperFonts& fonts_;
  const DocumentTable& table_;
  const InkColors& inks_;
  std::vector<ColumnWidth> widths_;
  PaperRow head_;
  std::vector<PaperRow> rows_;
};

}  // namespace

double PaperRow::Height() const {
  Progress to;
  return Fit(*this, 1e9, Progress(cells.size(), 0), &to) + 2.0 * kPadY;
}

void PlaceRows(const PaperRow* head, const std::vector<PaperRow>& rows, PaperPages* pages) {
  const auto needed_from = [&](std::size_t i) {
    double needed = rows[i].Height();
    for (; rows[i].stays_with_next && i + 1 < rows.size(); ++i) needed += rows[i + 1].Height();
    return needed;
  };
  if (rows.empty()) return;
  if (head != nullptr) pages->Need(head->Height() + std::min(needed_from(0), 0.5 * kBodyHeight));
  PutHead(head, pages);
  for (std::size_t i = 0; i < rows.size(); ++i) PlaceRow(head, rows[i], needed_from(i), pages);
}

void PlaceTable(const PaperFonts& fonts, const DocumentTable& table, const InkColors& inks,
                PaperPages* pages) {
  TableMaker(fonts, table, inks).Place(pages);
}

}  // namespace elbowroom::sessions
