// A small chart as lines, boxes and texts, which become an SVG or pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recon/images/image.h"

namespace elbowroom::control {

// Units are pixels of the picture, y down. Colours are "#rrggbb".
struct LineDrawing {
  struct Point {
    double x = 0.0;
    double y = 0.0;
  };
  struct Line {
    std::vector<Point> points;
    std::string color;
    double width = 1.0;
  };
  struct Area {  // a polygon, or with two points a rectangle's opposite corners
    std::vector<Point> points;
    std::string color;
  };
  enum class Anchor { kStart, kMiddle, kEnd };
  struct Text {
    Point at;  // on the base line
    std::string text;
    Anchor anchor = Anchor::kStart;
    double size = 13.0;
    std::string color = "#333333";
  };

  int width_px = 0;
  int height_px = 0;
  std::vector<Area> areas;  // drawn first
  std::vector<Line> lines;
  std::vector<Text> texts;
};

[[nodiscard]] std::string SvgOf(const LineDrawing& drawing);  // on white

// Paints the drawing on a picture; what reaches out of it is cut off. An integer position is the middle of a
// pixel. offset_px: of the drawing's left edge.
void PaintOn(recon::Image* image, const LineDrawing& drawing, int offset_px = 0);

[[nodiscard]] recon::Image ImageOf(const LineDrawing& drawing);  // on white

}  // namespace elbowroom::control
