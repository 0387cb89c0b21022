// The section planes that a LAYOUT.toml keeps: [[section]].
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "cad_import/layout/layout_text.h"

namespace elbowroom::cad_import {

// What is judged doesn't know of sections: they are about the look of a layout, so core::Layout has none.
// All x with (normal / |normal|) . x <= offset_mm are shown.
struct LayoutSection {
  std::string name;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // in world, of any length but 0
  double offset_mm = 0.0;                             // of the plane from world's origin, along the normal
  bool is_on = true;

  [[nodiscard]] bool operator==(const LayoutSection& other) const {
    return name == other.name && normal == other.normal && offset_mm == other.offset_mm &&
           is_on == other.is_on;
  }
};

inline constexpr std::size_t kMostSections = 32;
inline constexpr double kShortestNormal = 1e-6;  // shorter ones have no direction

// In the file's order. Throws: Error{kFormat} or Error{kRange} with file, line and key: a key that is
// unknown, missing or of the wrong type, a name that is there twice, a normal without a length, too many of
// them.
[[nodiscard]] std::vector<LayoutSection> SectionsOf(const LayoutText& text);

// Changes the text so that SectionsOf() gives these. What is alike isn't touched; one that only got another
// name keeps its comments. Throws: as LayoutText and SectionsOf; then nothing has changed.
void ChangeSections(LayoutText& text, const std::vector<LayoutSection>& sections);

}  // namespace elbowroom::cad_import
