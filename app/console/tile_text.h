// A camera's tile in words.
#pragma once

#include <QString>

#include "app/control/tiles/tile_maker.h"

namespace elbowroom::console {

// "" where there is nothing to say.
struct TileText {
  QString rate;     // "30.0 Hz"; of footage without stamps the silhouette's size, "12,345 px"
  QString lost;     // "lost 3"
  QString skew;     // "skew +2.1 ms"
  QString light;    // "light 97 %, flicker 3 %"
  QString advice;   // "▲ advice": the tool tip has it
  QString trouble;  // over the picture: "gone: why", "no picture"
  QString tool_tip;
};

[[nodiscard]] TileText TextOf(const control::CameraTile& tile);

}  // namespace elbowroom::console
