#include "app/control/line_drawing.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "sessions/report/markup.h"

namespace elbowroom::control {
namespace {

// OpenCV's polygons take positions in 1/16 px.
constexpr int kFractionBits = 4;
// The text size, as a browser counts it, that Hershey's plain letters have at scale 1.
constexpr double kHersheySize = 26.0;

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

cv::Scalar ColorOf(const std::string& color) {
  core::Require(color.size() == 7 && color[0] == '#', "a colour is #rrggbb");
  const auto rgb = static_cast<unsigned>(std::stoul(color.substr(1), nullptr, 16));
  return {static_cast<double>(rgb >> 16U), static_cast<double>((rgb >> 8U) & 255U),
          static_cast<double>(rgb & 255U)};
}

std::vector<cv::Point> PixelsOf(const std::vector<LineDrawing::Point>& points, int offset_px) {
  std::vector<cv::Point> pixels;
  const auto fixed = [](double px) { return static_cast<int>(std::lround(px * (1 << kFractionBits))); };
  for (const LineDrawing::Point& p : points) pixels.emplace_back(fixed(p.x + offset_px), fixed(p.y));
  return pixels;
}

void Paint(const cv::Mat& rgb, const LineDrawing::Text& text, int offset_px) {
  const double scale = text.size / kHersheySize;
  int base_line = 0;
  const int width_px = cv::getTextSize(text.text, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &base_line).width;
  const double share = text.anchor == LineDrawing::Anchor::kStart    ? 0.0
                       : text.anchor == LineDrawing::Anchor::kMiddle ? 0.5
                                                                     : 1.0;
  const cv::Point at(static_cast<int>(std::lround(text.at.x - share * width_px)) + offset_px,
                     static_cast<int>(std::lround(text.at.y)));
  cv::putText(rgb, text.text, at, cv::FONT_HERSHEY_SIMPLEX, scale, ColorOf(text.color), 1, cv::LINE_AA);
}

}  // namespace

std::string SvgOf(const LineDrawing& drawing) {
  constexpr const char* kAnchors[] = {"start", "middle", "end"};
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' width='{0}' height='{1}' "
      "font-family='sans-serif'>\n<rect width='{0}' height='{1}' fill='#ffffff'/>\n",
      drawing.width_px, drawing.height_px);
  for (const LineDrawing::Area& area : drawing.areas)
    svg += fmt::format("<polygon points='{}' fill='{}'/>\n", SvgPoints(CornersOf(area)), area.color);
  for (const LineDrawing::Line& line : drawing.lines)
    svg += fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='{}'/>\n",
                       SvgPoints(line.points), line.color, line.width);
  for (const LineDrawing::Text& text : drawing.texts)
    svg += fmt::format("<text x='{:.1f}' y='{:.1f}' font-size='{}' fill='{}' text-anchor='{}'>{}</text>\n",
                       text.at.x, text.at.y, text.size, text.color,
                       kAnchors[static_cast<std::size_t>(text.anchor)], sessions::Escaped(text.text));
  return svg + "</svg>\n";
}

void PaintOn(recon::Image* image, const LineDrawing& drawing, int offset_px) {
  const cv::Mat rgb(image->height_px, image->width_px, CV_8UC3, image->rgb.data());
  for (const LineDrawing::Area& area : drawing.areas)
    cv::fillPoly(rgb, std::vector{PixelsOf(CornersOf(area), offset_px)}, ColorOf(area.color), cv::LINE_AA,
                 kFractionBits);
  for (const LineDrawing::Line& line : drawing.lines)
    cv::polylines(rgb, std::vector{PixelsOf(line.points, offset_px)}, false, ColorOf(line.color),
                  std::max(1, static_cast<int>(std::lround(line.width))), cv::LINE_AA, kFractionBits);
  for (const LineDrawing::Text& text : drawing.texts) Paint(rgb, text, offset_px);
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
