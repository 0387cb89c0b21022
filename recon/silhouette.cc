#include "recon/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <opencv2/imgproc.hpp>

namespace elbowroom::recon {
namespace {

// The field holds whole numbers' square roots in float; a query position costs a subtraction or two.
constexpr double kRoundingPx = 1e-3;
constexpr double kPositionRoundingPx = 1e-7;
// Half a pixel's diagonal: from a centre to the farthest point of its square.
constexpr double kHalfDiagonalPx = 0.70710678118654757;
// Within this distance the neighbourhood is looked at pixel by pixel.
constexpr int kWindowPx = 2;

// floor(position + 0.5). std::floor is a call where the processor's baseline lacks the instruction; far
// positions are all alike: outside the image.
int NearestPixel(double position_px) {
  const double shifted_px = std::min(std::max(position_px, -1e6), 1e6) + 0.5;
  const int truncated = static_cast<int>(shifted_px);
  return truncated - (shifted_px < truncated ? 1 : 0);
}

Eigen::Vector2i NearestPixel(const Eigen::Vector2d& position_px) {
  return {NearestPixel(position_px.x()), NearestPixel(position_px.y())};
}

double DistanceToBox(const Eigen::AlignedBox2d& box, const Eigen::Vector2d& position_px) {
  return box.isEmpty() ? std::numeric_limits<double>::infinity() : box.exteriorDistance(position_px);
}

// Directions all around, evenly.
const std::array<Eigen::Vector2d, 16>& Compass() {
  static const std::array<Eigen::Vector2d, 16> directions = [] {
    std::array<Eigen::Vector2d, 16> result;
    for (std::size_t i = 0; i < result.size(); ++i) {
      const double angle_rad = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(result.size());
      result[i] = {std::cos(angle_rad), std::sin(angle_rad)};
    }
    return result;
  }();
  return directions;
}

// Labels as bytes, 255 where object, with kWindowPx rings of exterior around the image.
std::vector<std::uint8_t> RingedLabels(const core::BitMask& mask, bool exterior_is_object) {
  const auto width = static_cast<std::size_t>(mask.width_px() + 2 * kWindowPx);
  const auto height = static_cast<std::size_t>(mask.height_px() + 2 * kWindowPx);
  std::vector<std::uint8_t> labels(width * height, exterior_is_object ? 255 : 0);
  for (int y = 0; y < mask.height_px(); ++y) {
    std::uint8_t* row = labels.data() + static_cast<std::size_t>(y + kWindowPx) * width + kWindowPx;
    const std::uint64_t* words = mask.words().data() + static_cast<std::size_t>(y) * mask.words_per_row();
    for (int x = 0; x < mask.width_px(); ++x)
      row[x] = ((words[x >> 6] >> (static_cast<unsigned>(x) & 63U)) & 1U) != 0 ? 255 : 0;
  }
  return labels;
}

// The box of the pixels that carry `label`; 0 wide if none does.
cv::Rect BoxOf(const cv::Mat& labels, std::uint8_t label) {
  int left = labels.cols, right = -1, top = labels.rows, bottom = -1;
  for (int y = 0; y < labels.rows; ++y) {
    const auto* begin = labels.ptr<std::uint8_t>(y);
    const auto* end = begin + labels.cols;
    const auto* first = std::find(begin, end, label);
    if (first == end) continue;
    const auto last = std::find(std::reverse_iterator(end), std::reverse_iterator(begin), label);
    left = std::min(left, static_cast<int>(first - begin));
    right = std::max(right, static_cast<int>(last.base() - begin) - 1);
    top = std::min(top, y);
    bottom = y;
  }
  return right < 0 ? cv::Rect() : cv::Rect(left, top, right - left + 1, bottom - top + 1);
}

}  // namespace

Silhouette::Silhouette(core::BitMask mask, bool exterior_is_object)
    : mask_(std::move(mask)), exterior_is_object_(exterior_is_object) {
  labels_ = RingedLabels(mask_, exterior_is_object);
  const cv::Mat ringed(mask_.height_px() + 2 * kWindowPx, mask_.width_px() + 2 * kWindowPx, CV_8U,
                       labels_.data());
  const cv::Rect box = BoxOf(ringed, exterior_is_object ? 0 : 255);
  if (box.empty()) return;
  differing_px_ = {Eigen::Vector2d(box.x, box.y).array() - (kWindowPx + 0.5),
                   Eigen::Vector2d(box.x + box.width, box.y + box.height).array() - (kWindowPx + 0.5)};
  const cv::Mat differs = exterior_is_object ? cv::Mat(~ringed) : ringed;
  cv::Mat field, within;
  cv::distanceTransform(~differs, field, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  // The nearest exterior pixel of one inside the box is never farther than the ring around the box.
  const cv::Rect ring(box.x - 1, box.y - 1, box.width + 2, box.height + 2);
  cv::distanceTransform(differs(ring), within, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  field(ring) += within;  // one of the two is zero
  field_px_.assign(field.begin<float>(), field.end<float>());
}

bool Silhouette::IsPixel(const Eigen::Vector2i& pixel) const {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < mask_.width_px() && pixel.y() < mask_.height_px();
}

std::size_t Silhouette::Index(const Eigen::Vector2i& pixel) const {
  return static_cast<std::size_t>(pixel.y() + kWindowPx) *
             static_cast<std::size_t>(mask_.width_px() + 2 * kWindowPx) +
         static_cast<std::size_t>(pixel.x() + kWindowPx);
}

bool Silhouette::IsInImage(const Eigen::Vector2d& position_px) const {
  return IsPixel(NearestPixel(position_px));
}

bool Silhouette::IsObject(const Eigen::Vector2d& position_px) const {
  const Eigen::Vector2i pixel = NearestPixel(position_px);
  return IsPixel(pixel) ? labels_[Index(pixel)] != 0 : exterior_is_object_;
}

PixelLabel Silhouette::LabelAt(const Eigen::Vector2d& position_px) const {
  if (differing_px_.isEmpty()) return {exterior_is_object_, std::numeric_limits<double>::infinity()};
  const Eigen::Vector2i pixel = NearestPixel(position_px);
  if (!IsPixel(pixel)) {
    return {exterior_is_object_, std::max(DistanceFromOutside(position_px) - kPositionRoundingPx, 0.0)};
  }
  const std::size_t index = Index(pixel);
  double distance_px =
      field_px_[index] - kHalfDiagonalPx - (position_px - pixel.cast<double>()).norm() - kRoundingPx;
  if (distance_px < kWindowPx) distance_px = std::max(distance_px, DistanceWithinWindow(position_px, pixel));
  return {labels_[index] != 0, std::max(distance_px - kPositionRoundingPx, 0.0)};
}

double Silhouette::DistanceFromOutside(const Eigen::Vector2d& position_px) const {
  // The picture is convex: what lies in it is at least as far as the legs to the picture's nearest position
  // and from there make a right angle.
  const Eigen::Vector2d nearest_px =
      position_px.cwiseMax(-0.5).cwiseMin(Eigen::Vector2d(mask_.width_px() - 0.5, mask_.height_px() - 0.5));
  const Eigen::Vector2i pixel =
      NearestPixel(nearest_px).cwiseMin(Eigen::Vector2i(mask_.width_px() - 1, mask_.height_px() - 1));
  double within_px = 0.0;
  if ((labels_[Index(pixel)] != 0) == exterior_is_object_) {
    within_px =
        field_px_[Index(pixel)] - kHalfDiagonalPx - (nearest_px - pixel.cast<double>()).norm() - kRoundingPx;
  }
  const double legs_px = std::hypot((position_px - nearest_px).norm(), std::max(within_px, 0.0));
  return std::max(legs_px, DistanceToBox(differing_px_, position_px));
}

double Silhouette::DistanceWithinWindow(const Eigen::Vector2d& position_px,
                                        const Eigen::Vector2i& pixel) const {
  // Squares beyond the window begin kWindowPx + 0.5 from the centre, and the position is within 0.5 of it.
  constexpr int kSide = 2 * kWindowPx + 1;
  const auto stride = static_cast<std::size_t>(mask_.width_px() + 2 * kWindowPx);
  const std::uint8_t label = labels_[Index(pixel)];
  const std::uint8_t* row = &labels_[Index(pixel) - kWindowPx * stride - kWindowPx];
  const Eigen::Vector2d offset_px = position_px - pixel.cast<double>();
  double across_square[kSide];
  for (int i = 0; i < kSide; ++i) {
    const double across_px = std::max(std::abs(offset_px.x() - (i - kWindowPx)) - 0.5, 0.0);
    across_square[i] = across_px * across_px;
  }
  double nearest_square = kWindowPx * kWindowPx;
  for (int j = 0; j < kSide; ++j, row += stride) {
    const double down_px = std::max(std::abs(offset_px.y() - (j - kWindowPx)) - 0.5, 0.0);
    for (int i = 0; i < kSide; ++i) {
      if (row[i] != label) nearest_square = std::min(nearest_square, across_square[i] + down_px * down_px);
    }
  }
  return std::sqrt(nearest_square);
}

Eigen::Vector2d Silhouette::OutwardDirection(const Eigen::Vector2d& position_px, double span_px) const {
  if (differing_px_.isEmpty()) return Eigen::Vector2d::Zero();
  const auto signed_distance = [&](double dx, double dy) {
    const Eigen::Vector2i pixel = NearestPixel(position_px + Eigen::Vector2d(dx, dy));
    if (!IsPixel(pixel)) return exterior_is_object_ ? -span_px : span_px;
    const double field_px = field_px_[Index(pixel)];
    return labels_[Index(pixel)] != 0 ? 0.5 - field_px : field_px - 0.5;
  };
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& direction : Compass()) {
    for (const double radius_px : {0.5 * span_px, span_px}) {
      const Eigen::Vector2d offset = direction * radius_px;
      sum += direction * signed_distance(offset.x(), offset.y());
    }
  }
  return sum.norm() > 0.0 ? sum.normalized() : sum;
}

}  // namespace elbowroom::recon
