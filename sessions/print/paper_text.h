// Text on paper, laid out in lines by Pango.
#pragma once

#include <pango/pangocairo.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "sessions/document/document.h"

namespace elbowroom::sessions {

// Lengths on paper are points, 1/72 inch.
struct Color {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
};

// `text` is "#rrggbb".
[[nodiscard]] Color ColorFrom(const std::string& text);

struct TextLook {
  double size_pt = 9.0;
  bool is_strong = false;
  Color color = {};
  double strong_scale = 1.0;  // of the size
  double remark_scale = 0.9;
  Color remark_color = {};
  bool remarks_stand_below = false;  // each on a line of its own
  bool holds_lines = false;          // no break but within names
  bool aligns_right = false;
  bool is_cut = false;  // to one line
};

// UTF-8 without control characters; what is no UTF-8 becomes U+FFFD.
[[nodiscard]] std::string Printable(const std::string& text);

// The fonts of this machine. Thread: one at a time.
class PaperFonts {
 public:
  // Throws: Error{kFile} if there is none.
  PaperFonts();
  [[nodiscard]] PangoContext* context() const { return context_.get(); }

 private:
  std::shared_ptr<PangoFontMap> map_;
  std::shared_ptr<PangoContext> context_;
};

// Copies share the lines.
class PaperText {
 public:
  PaperText(const PaperFonts& fonts, const RichText& text, const TextLook& look);

  [[nodiscard]] double NaturalWidth();  // without a break
  [[nodiscard]] double LeastWidth();    // of the longest word
  // Before anything below is asked.
  void Wrap(double width_pt);
  [[nodiscard]] std::size_t line_count() const { return lines_.size(); }
  // Of the lines from `first` to before `end`.
  [[nodiscard]] double Height(std::size_t first, std::size_t end) const;
  [[nodiscard]] double Height() const { return Height(0, line_count()); }
  // The end of the lines from `first` on that fit into that height.
  [[nodiscard]] std::size_t EndWithin(std::size_t first, double height_pt) const;
  // The first line's top is at y.
  void Draw(cairo_t* cairo, std::size_t first, std::size_t end, double x, double y) const;
  [[nodiscard]] const Color& color() const { return color_; }

 private:
  struct Line {
    PangoLayoutLine* line = nullptr;  // of layout_
    double left = 0.0;
    double top = 0.0;
    double bottom = 0.0;
    double baseline = 0.0;
  };

  std::shared_ptr<PangoLayout> layout_;
  std::vector<Line> lines_;
  Color color_;
};

}  // namespace elbowroom::sessions
