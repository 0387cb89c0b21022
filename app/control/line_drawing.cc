#include "app/control/line_drawing.h"

#include <fmt/format.h>

#include "sessions/print/svg_pixels.h"
#include "sessions/report/markup.h"

namespace elbowroom::control {
namespace {

std::vector<LineDrawing::Point> CornersOf(const LineDrawing::Area& area) {
  if (area.points.size() != 2) return area.points;
  const LineDrawing::Point &a = area.points[0], &b = area.points[1];
  return {a, {b.x, a.y}, b, {a.x, b.y}};
}

std::string SvgPoints(const std::vector<LineDrawing::Point>& points) {
  std::string text;
  for (const LineDrawing::Point& p : points) text += fmt::format("{:.2f},{:.2f} ", p.x, p.y);
  return text;
}

std::string Shapes(const LineDrawing& drawing) {
  constexpr const char* kAnchors[] = {"start", "middle", "end"};
  std::string svg;
  for (const LineDrawing::Area& area : drawing.areas)
    svg += fmt::format("<polygon points='{}' fill='{}'/>\n", SvgPoints(CornersOf(area)), area.color);
  for (const LineDrawing::Line& line : drawing.lines)
    svg += fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='{}'/>\n",
                       SvgPoints(line.points), line.color, line.width);
  for (const LineDrawing::Text& text : drawing.texts)
    svg += fmt::format("<text x='{:.1f}' y='{:.1f}' font-size='{}' fill='{}' text-anchor='{}'>{}</text>\n",
                       text.at.x, text.at.y, text.size, text.color,
                       kAnchors[static_cast<std::size_t>(text.anchor)], sessions::Escaped(text.text));
  return svg;
}

std::string SvgWith(const LineDrawing& drawing, const std::string& content) {
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' width='{0}' height='{1}' "
      "font-family='Liberation Sans, DejaVu Sans, sans-serif'>\n{2}</svg>\n",
      drawing.width_px, drawing.height_px, content);
}

}  // namespace

std::string SvgOf(const LineDrawing& drawing) {
  const std::string ground =
      fmt::format("<rect width='{}' height='{}' fill='#ffffff'/>\n", drawing.width_px, drawing.height_px);
  return SvgWith(drawing, ground + Shapes(drawing));
}

void PaintOn(recon::Image* image, const LineDrawing& drawing, int offset_px) {
  LineDrawing whole = drawing;  // of what is painted over a picture, nothing is cut off but by the picture
  whole.width_px = image->width_px;
  whole.height_px = image->height_px;
  sessions::PaintSvg(SvgWith(whole, Shapes(drawing)), offset_px,
                     {image->width_px, image->height_px, image->rgb});
}

recon::Image ImageOf(const LineDrawing& drawing) {
  recon::Image image;
  image.width_px = drawing.width_px;
  image.height_px = drawing.height_px;
  image.rgb.assign(static_cast<std::size_t>(3) * static_cast<std::size_t>(drawing.width_px) *
                       static_cast<std::size_t>(drawing.height_px),
                   255);
  PaintOn(&image, drawing);
  return image;
}

}  // namespace elbowroom::control
