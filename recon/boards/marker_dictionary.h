// Square markers with a number in them: their dictionaries, their patterns, and those in a picture.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace elbowroom::recon {

struct DetectedMarker {
  int id = 0;
  std::array<Eigen::Vector2d, 4> corners_px;  // as BoardMarker has them; to about a pixel
};

// The names that a dictionary can have, as "DICT_6X6_250".
[[nodiscard]] std::vector<std::string> DictionaryNames();

// One of OpenCV's dictionaries. Immutable. Thread: any.
class MarkerDictionary {
 public:
  // Throws: Error{kRange} naming a dictionary that OpenCV doesn't have, and those it has.
  explicit MarkerDictionary(const std::string& name);
  ~MarkerDictionary();
  MarkerDictionary(MarkerDictionary&&) noexcept;
  MarkerDictionary& operator=(MarkerDictionary&&) noexcept;

  [[nodiscard]] int marker_count() const;
  // Along a side of a marker, its black border included.
  [[nodiscard]] int modules_across() const;
  // Row by row from the marker's first corner, true: light.
  [[nodiscard]] std::vector<std::vector<bool>> PatternOf(int id) const;
  // All markers in a picture where light is light, also several of one number.
  [[nodiscard]] std::vector<DetectedMarker> Detect(const cv::Mat& grey) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace elbowroom::recon
