#include "app/control/section/filled_outline.h"

#include <algorithm>
#include <cstddef>

namespace elbowroom::control {
namespace {

// A segment that runs up or down through a strip, with its places at the strip's lower and upper border.
struct Crossing {
  double x_low = 0.0;
  double x_high = 0.0;
  int winds = 0;  // what it adds to the winding number of the points on its right
};

double XAt(const DirectedSegment& segment, double y) {
  if (y == segment.from.y()) return segment.from.x();
  if (y == segment.to.y()) return segment.to.x();
  const double share = (y - segment.from.y()) / (segment.to.y() - segment.from.y());
  return segment.from.x() + share * (segment.to.x() - segment.from.x());
}

double Low(const DirectedSegment& segment) { return std::min(segment.from.y(), segment.to.y()); }
double High(const DirectedSegment& segment) { return std::max(segment.from.y(), segment.to.y()); }

void AddTrapezoid(const Crossing& left, const Crossing& right, double y_low, double y_high,
                  std::vector<FlatTriangle>* triangles) {
  const Eigen::Vector2d a(left.x_low, y_low), b(right.x_low, y_low), c(right.x_high, y_high),
      d(left.x_high, y_high);
  if (b.x() > a.x()) triangles->push_back({a, b, c});
  if (c.x() > d.x()) triangles->push_back({a, c, d});
}

}  // namespace

std::vector<FlatTriangle> FillOutline(std::span<const DirectedSegment> segments) {
  std::vector<DirectedSegment> by_low;
  std::vector<double> borders;
  for (const DirectedSegment& segment : segments) {
    borders.push_back(segment.from.y());
    borders.push_back(segment.to.y());
    if (segment.from.y() != segment.to.y()) by_low.push_back(segment);
  }
  std::ranges::sort(by_low, {}, Low);
  std::ranges::sort(borders);
  borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
  std::vector<FlatTriangle> triangles;
  std::vector<DirectedSegment> open;
  std::size_t next = 0;
  for (std::size_t i = 1; i < borders.size(); ++i) {
    const double y_low = borders[i - 1], y_high = borders[i];
    std::erase_if(open, [&](const DirectedSegment& segment) { return High(segment) <= y_low; });
    for (; next < by_low.size() && Low(by_low[next]) <= y_low; ++next) open.push_back(by_low[next]);
    std::vector<Crossing> crossings;
    for (const DirectedSegment& segment : open)
      crossings.push_back(
          {XAt(segment, y_low), XAt(segment, y_high), segment.to.y() < segment.from.y() ? 1 : -1});
    std::ranges::sort(crossings, {},
                      [](const Crossing& crossing) { return crossing.x_low + crossing.x_high; });
    int winding = 0;
    for (std::size_t k = 0; k + 1 < crossings.size(); ++k) {
      winding += crossings[k].winds;
      if (winding > 0) AddTrapezoid(crossings[k], crossings[k + 1], y_low, y_high, &triangles);
    }
  }
  return triangles;
}

}  // namespace elbowroom::control
