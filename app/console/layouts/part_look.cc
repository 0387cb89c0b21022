#include "app/console/layouts/part_look.h"

#include <array>

namespace elbowroom::console {

QColor PartColor(std::size_t place_in_layout) {
  constexpr std::array<QRgb, 8> kColors = {0xff608fbe, 0xffd6a45c, 0xff71ad7d, 0xffac83ba,
                                           0xffcd7c78, 0xff5cb0b4, 0xff9e9e6e, 0xff9696a0};
  return QColor::fromRgb(kColors.at(place_in_layout % kColors.size()));
}

QColor ChoiceColor(int choice) {
  return choice == 1 ? QColor::fromRgb(0xffe67e00) : QColor::fromRgb(0xffb0389c);
}

}  // namespace elbowroom::console
