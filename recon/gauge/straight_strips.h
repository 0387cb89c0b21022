// Strips in a silhouette: two straight edges that face each other, with object between, as a rod shows them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "recon/gauge/rod_view.h"

namespace elbowroom::recon {

// Points of one contour that follow each other along a straight line.
struct StraightRun {
  std::vector<std::uint32_t> points;
  std::uint32_t loop = 0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  // unit, as the contour goes, object to the left
  double from = 0.0;                                 // along it, from the middle
  double to = 0.0;
};

struct Strip {
  StraightRun first;                                 // the object is to its left ...
  StraightRun second;                                // ... and to this one's, which goes the other way
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  // halfway between the two, where both are
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  // unit: the mean direction, that of `first`
  double from = 0.0;                                 // the stretch that both cover, along it from the middle
  double to = 0.0;
  double width = 0.0;  // at the middle

  [[nodiscard]] double length() const { return to - from; }
};

// Of widths between the two, plane units; the longest first.
[[nodiscard]] std::vector<Strip> FindStrips(const RodView& view, double least_width, double most_width);

// The strip with all points of the view that lie on its two lines, its ends excepted: also those beyond what
// interrupts it.
[[nodiscard]] Strip WithAllPoints(const RodView& view, const Strip& strip);

}  // namespace elbowroom::recon
