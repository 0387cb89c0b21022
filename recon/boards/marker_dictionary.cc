#include "recon/boards/marker_dictionary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

struct NamedDictionary {
  std::string_view name;
  cv::aruco::PREDEFINED_DICTIONARY_NAME value;
};
constexpr NamedDictionary kDictionaries[] = {
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    {"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    {"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    {"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    {"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    {"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    {"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    {"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    {"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
    {"DICT_APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
    {"DICT_APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
    {"DICT_APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
    {"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11},
};

constexpr int kLargestSearchedPx = 1600;

cv::Ptr<cv::aruco::Dictionary> DictionaryOf(const std::string& name) {
  for (const NamedDictionary& named : kDictionaries)
    if (named.name == name) return cv::aruco::getPredefinedDictionary(named.value);
  throw core::Error(core::ErrorKind::kRange,
                    fmt::format("the board: there is no dictionary \"{}\"; there are {}", name,
                                fmt::join(DictionaryNames(), ", ")));
}

cv::Ptr<cv::aruco::DetectorParameters> SearchParameters() {
  auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;  // the boards' finders refine
  // Markers of 12 px a side in a picture of 1280.
  parameters->minMarkerPerimeterRate = 0.02;
  parameters->minDistanceToBorder = 1;
  return parameters;
}

}  // namespace

struct MarkerDictionary::Parts {
  cv::Ptr<cv::aruco::Dictionary> dictionary;
  cv::Ptr<cv::aruco::DetectorParameters> parameters;
};

std::vector<std::string> DictionaryNames() {
  std::vector<std::string> names;
  for (const NamedDictionary& named : kDictionaries) names.emplace_back(named.name);
  return names;
}

MarkerDictionary::MarkerDictionary(const std::string& name)
    : parts_(std::make_unique<Parts>(Parts{DictionaryOf(name), SearchParameters()})) {}
MarkerDictionary::~MarkerDictionary() = default;
MarkerDictionary::MarkerDictionary(MarkerDictionary&&) noexcept = default;
MarkerDictionary& MarkerDictionary::operator=(MarkerDictionary&&) noexcept = default;

int MarkerDictionary::marker_count() const { return parts_->dictionary->bytesList.rows; }

int MarkerDictionary::modules_across() const {
  return parts_->dictionary->markerSize + 2 * parts_->parameters->markerBorderBits;
}

std::vector<std::vector<bool>> MarkerDictionary::PatternOf(int id) const {
  core::Require(id >= 0 && id < marker_count(), "the marker's id is in the dictionary");
  const int across = modules_across();
  cv::Mat picture;
  parts_->dictionary->drawMarker(id, across, picture, parts_->parameters->markerBorderBits);
  std::vector<std::vector<bool>> pattern(static_cast<std::size_t>(across));
  for (int row = 0; row < across; ++row)
    for (int column = 0; column < across; ++column)
      pattern[static_cast<std::size_t>(row)].push_back(picture.at<unsigned char>(row, column) > 127);
  return pattern;
}

std::vector<DetectedMarker> MarkerDictionary::Detect(const cv::Mat& grey) const {
  const double scale =
      std::min(1.0, static_cast<double>(kLargestSearchedPx) / std::max(grey.cols, grey.rows));
  cv::Mat searched = grey;
  if (scale < 1.0) cv::resize(grey, searched, {}, scale, scale, cv::INTER_AREA);
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(searched, parts_->dictionary, corners, ids, parts_->parameters);
  const Eigen::Vector2d per_pixel(static_cast<double>(grey.cols) / searched.cols,
                                  static_cast<double>(grey.rows) / searched.rows);
  const Eigen::Vector2d half(0.5, 0.5);
  std::vector<DetectedMarker> markers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    DetectedMarker marker{ids[i], {}};
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector2d corner(corners[i][k].x, corners[i][k].y);
      marker.corners_px[k] = (corner + half).cwiseProduct(per_pixel) - half;
    }
    markers.push_back(marker);
  }
  return markers;
}

}  // namespace elbowroom::recon
