// How a part looks in the layout's view. A look is of the window, not of the file.
#pragma once

#include <QColor>
#include <QString>
#include <map>

namespace elbowroom::console {

struct PartLook {
  bool is_visible = true;
  QColor color;          // not valid: that of its place in the layout
  double opacity = 1.0;  // 0..1

  [[nodiscard]] bool operator==(const PartLook&) const = default;
};
using PartLooks =
    std::map<QString, PartLook>;  // by the part's name; one that isn't there looks as by default

// Colours that differ clearly, and are light enough to show shading. Further parts take them again.
[[nodiscard]] QColor PartColor(std::size_t place_in_layout);

// Of what is chosen: 1 first, 2 second.
[[nodiscard]] QColor ChoiceColor(int choice);

}  // namespace elbowroom::console
