// Tables and tiles on paper: rows that stand whole where a page can hold them.
#pragma once

#include <optional>
#include <vector>

#include "sessions/print/paper_pages.h"
#include "sessions/print/printer.h"

namespace elbowroom::sessions {

inline constexpr double kSnapshotWidth = 78.0;  // of a picture in a cell, which is no higher than wide

struct PaperCell {
  std::optional<PaperText> text = {};
  std::optional<PngDrawing> picture = {};  // instead of the text
  std::optional<Color> dot = {};           // before the text
  double left = 0.0;                       // of the page
  double width = 0.0;
};

struct PaperRow {
  std::vector<PaperCell> cells = {};
  std::optional<Color> wash = {};  // behind it
  double rule = 0.5;               // below it; 0: none
  bool is_framed = false;          // each cell has a frame
  bool stays_with_next = false;

  [[nodiscard]] double Height() const;  // whole
};

// Puts rows below `head`, which every page repeats. A row higher than a page goes on, line by line, on the
// next. Texts are wrapped.
void PlaceRows(const PaperRow* head, const std::vector<PaperRow>& rows, PaperPages* pages);

// Columns get the widths that their texts want; where that is too much, those that can break give way.
void PlaceTable(const PaperFonts& fonts, const DocumentTable& table, const InkColors& inks,
                PaperPages* pages);

}  // namespace elbowroom::sessions
