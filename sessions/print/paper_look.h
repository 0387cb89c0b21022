// How texts and lines look on paper.
#pragma once

#include <algorithm>
#include <string>

#include "sessions/print/paper_text.h"
#include "sessions/print/printer.h"

namespace elbowroom::sessions {

inline constexpr Color kInk = {0.11, 0.15, 0.20};
inline constexpr Color kQuietInk = {0.36, 0.42, 0.48};
inline constexpr Color kLine = {0.82, 0.85, 0.88};
inline constexpr Color kWash = {0.957, 0.965, 0.973};
inline constexpr Color kHighlight = {0.988, 0.925, 0.870};
inline constexpr double kTextSize = 9.0;
inline constexpr double kTableSize = 8.0;

[[nodiscard]] inline TextLook BodyLook(bool is_quiet) {
  return {.size_pt = kTextSize, .color = is_quiet ? kQuietInk : kInk, .remark_color = kQuietInk};
}
[[nodiscard]] inline TextLook StrongLook(double size_pt) {
  return {.size_pt = size_pt, .is_strong = true, .color = kInk, .remark_color = kQuietInk};
}
[[nodiscard]] inline TextLook CellLook(bool is_number) {
  return {.size_pt = kTableSize,
          .color = kInk,
          .remark_color = kQuietInk,
          .remarks_stand_below = true,
          .holds_lines = is_number,
          .aligns_right = is_number};
}
[[nodiscard]] inline TextLook HeadLook(bool is_number) {
  TextLook look = CellLook(is_number);
  look.holds_lines = false;
  look.is_strong = true;
  look.color = kQuietInk;
  look.size_pt = 7.5;
  return look;
}
[[nodiscard]] inline TextLook GroupLook() { return StrongLook(9.0); }

// Of "#rrggbb", or of an ink.
[[nodiscard]] inline Color InkColor(const std::string& name, const InkColors& inks) {
  const auto at = std::ranges::find(inks, name, &InkColors::value_type::first);
  return ColorFrom(at == inks.end() ? name : at->second);
}

}  // namespace elbowroom::sessions
