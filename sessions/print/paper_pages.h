// The pages of a document, filled from the top; drawn when their number is known.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "sessions/print/paper_text.h"
#include "sessions/print/svg_drawing.h"

namespace elbowroom::sessions {

// A4 and its margins, in points.
inline constexpr double kPaperWidth = 595.276;
inline constexpr double kPaperHeight = 841.89;
inline constexpr double kMarginX = 40.0;
inline constexpr double kBodyTop = 56.0;
inline constexpr double kBodyBottom = kPaperHeight - 52.0;
inline constexpr double kBodyWidth = kPaperWidth - 2.0 * kMarginX;
inline constexpr double kBodyHeight = kBodyBottom - kBodyTop;

struct PlacedLines {
  PaperText text;
  std::size_t first = 0;
  std::size_t end = 0;
  double x = 0.0;
  double y = 0.0;
};
struct PlacedFill {
  Box box;
  Color color;
};
struct PlacedFrame {
  Box box;
  Color color;
};
struct PlacedSvg {
  SvgDrawing drawing;
  Box box;
};
struct PlacedPng {
  PngDrawing drawing;
  Box box;
};
using Placed = std::variant<PlacedLines, PlacedFill, PlacedFrame, PlacedSvg, PlacedPng>;

struct OutlineEntry {
  std::string title;
  bool is_minor = false;
  std::size_t page = 0;  // from 0
  double y = 0.0;
};

class PaperPages {
 public:
  // Where the next thing goes.
  [[nodiscard]] double y() const { return y_; }
  [[nodiscard]] double room() const { return kBodyBottom - y_; }
  [[nodiscard]] bool is_fresh() const { return y_ <= kBodyTop; }  // nothing is on the page yet

  void Put(Placed thing) { pages_.back().push_back(std::move(thing)); }
  void Down(double height_pt) { y_ += height_pt; }
  void Space(double height_pt);  // nothing at the top of a page
  void Break();
  // Begins a page unless there is so much room, or no page has more.
  void Need(double height_pt);
  void Mark(const std::string& title, bool is_minor);  // in the outline

  [[nodiscard]] const std::vector<std::vector<Placed>>& pages() const { return pages_; }
  [[nodiscard]] const std::vector<OutlineEntry>& outline() const { return outline_; }

 private:
  std::vector<std::vector<Placed>> pages_ = {{}};
  std::vector<OutlineEntry> outline_;
  double y_ = kBodyTop;
};

}  // namespace elbowroom::sessions
