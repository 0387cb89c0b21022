#include "recon/head_pose/cap_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "core/error.h"
#include "recon/boards/edge_fit.h"
#include "recon/boards/marker_dictionary.h"

namespace elbowroom::recon {
namespace {

constexpr std::ptrdiff_t kLeastCorners = 3;

// Twice: the detector's corners are off by a pixel, which matters to the window of a small marker.
std::optional<SightedCorner> CornerOf(const cv::Mat& grey, const std::array<Eigen::Vector2d, 4>& corners,
                                      std::size_t k, int modules) {
  const Eigen::Vector2d &before = corners[(k + 3) % 4], &after = corners[(k + 1) % 4];
  const auto first = FitCorner(grey, corners[k], before, after, modules);
  if (!first) return std::nullopt;
  const auto second = FitCorner(grey, first->pixel, before, after, modules);
  const CornerFit& fit = second ? *second : *first;
  return SightedCorner{fit.pixel, fit.sigma_px};
}

}  // namespace

struct CapFinder::Parts {
  Cap cap;
  MarkerDictionary dictionary;
  std::map<int, std::size_t> place_of_id;
};

CapFinder::CapFinder(const Cap& cap) {
  cap.Validate();
  Parts parts{cap, MarkerDictionary(cap.dictionary), {}};
  for (std::size_t i = 0; i < cap.markers.size(); ++i) {
    const int id = cap.markers[i].id;
    if (id >= parts.dictionary.marker_count())
      throw core::Error(core::ErrorKind::kRange,
                        fmt::format("the cap: {} has no marker {}; it has 0 to {}", cap.dictionary, id,
                                    parts.dictionary.marker_count() - 1));
    parts.place_of_id[id] = i;
  }
  parts_ = std::make_unique<const Parts>(std::move(parts));
}
CapFinder::~CapFinder() = default;
CapFinder::CapFinder(CapFinder&&) noexcept = default;
CapFinder& CapFinder::operator=(CapFinder&&) noexcept = default;

const Cap& CapFinder::cap() const { return parts_->cap; }

CapSighting CapFinder::Find(const cv::Mat& grey_or_bgr) const {
  cv::Mat grey = grey_or_bgr;
  if (grey_or_bgr.channels() == 3) cv::cvtColor(grey_or_bgr, grey, cv::COLOR_BGR2GRAY);
  const std::vector<DetectedMarker> detected = parts_->dictionary.Detect(grey);
  CapSighting sighting;
  for (const DetectedMarker& marker : detected) {
    const auto place = parts_->place_of_id.find(marker.id);
    const auto namesakes = std::ranges::count(detected, marker.id, &DetectedMarker::id);
    if (place == parts_->place_of_id.end() || namesakes > 1) continue;
    SightedMarker sighted{place->second, {}};
    for (std::size_t k = 0; k < 4; ++k)
      sighted.corners[k] = CornerOf(grey, marker.corners_px, k, parts_->dictionary.modules_across());
    const auto found = std::ranges::count_if(sighted.corners, [](const auto& c) { return c.has_value(); });
    if (found >= kLeastCorners) sighting.push_back(std::move(sighted));
  }
  return sighting;
}

}  // namespace elbowroom::recon
