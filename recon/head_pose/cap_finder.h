// The markers of a cap in one picture.
#pragma once

#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "recon/head_pose/cap.h"

namespace elbowroom::recon {

struct SightedCorner {
  Eigen::Vector2d pixel;  // pixel centres at whole numbers
  double sigma_px = 0.1;  // standard deviation of each coordinate, as far as the picture tells
};

struct SightedMarker {
  std::size_t marker = 0;                               // its place in Cap::markers
  std::array<std::optional<SightedCorner>, 4> corners;  // as CornersInCap; at least three are there
};

// What one camera sees of the cap; may be empty.
using CapSighting = std::vector<SightedMarker>;

// Made once for a cap; then any number of threads may look for it, each in a picture of its own.
class CapFinder {
 public:
  // Throws: Error{kRange}: Cap::Validate; no such dictionary, or a marker that isn't in it.
  explicit CapFinder(const Cap& cap);
  ~CapFinder();
  CapFinder(CapFinder&&) noexcept;
  CapFinder& operator=(CapFinder&&) noexcept;

  [[nodiscard]] const Cap& cap() const;

  // `grey_or_bgr`: 8 bits a channel, one or three channels. Each corner is where the straight edges of its
  // marker meet. A number that is seen twice isn't used. Thread: any.
  [[nodiscard]] CapSighting Find(const cv::Mat& grey_or_bgr) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace elbowroom::recon
