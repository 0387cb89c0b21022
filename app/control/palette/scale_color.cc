#include "app/control/palette/scale_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "sessions/charts/ink.h"

namespace elbowroom::control {
namespace {

constexpr std::size_t kColors = 256;

std::array<Color, kColors> MakeColors() {
  std::array<Color, kColors> colors;
  for (std::size_t i = 0; i < kColors; ++i) {
    const unsigned long rgb =
        std::stoul(sessions::DepthColour(static_cast<double>(i) / (kColors - 1)).substr(1), nullptr, 16);
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      colors[i][channel] = static_cast<float>((rgb >> (16 - 8 * channel)) & 255UL) / 255.0F;
  }
  return colors;
}

}  // namespace

Color ScaleColor(double share) {
  static const std::array<Color, kColors> colors = MakeColors();
  return colors[static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * (kColors - 1)))];
}

}  // namespace elbowroom::control
