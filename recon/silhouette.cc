#include "recon/silhouette.h"

#include <algorithm>
#include <bit>
#include <cmath>
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

Eigen::Vector2i NearestPixel(const Eigen::Vector2d& position_px) {
  // Far positions are all alike: outside the image.
  const Eigen::Vector2d clamped = position_px.cwiseMax(-1e6).cwiseMin(1e6);
  return {static_cast<int>(std::floor(clamped.x() + 0.5)), static_cast<int>(std::floor(clamped.y() + 0.5))};
}

double DistanceToBox(const Eigen::AlignedBox2d& box, const Eigen::Vector2d& position_px) {
  return box.isEmpty() ? std::numeric_limits<double>::infinity() : box.exteriorDistance(position_px);
}

Eigen::AlignedBox2d SquareOf(int x, int y) {
  return {Eigen::Vector2d(x - 0.5, y - 0.5), Eigen::Vector2d(x + 0.5, y + 0.5)};
}

// The image with a ring of exterior around it: 255 where the label is object.
cv::Mat RingedImage(const core::BitMask& mask, bool exterior_is_object) {
  cv::Mat image(mask.height_px() + 2, mask.width_px() + 2, CV_8U, cv::Scalar(exterior_is_object ? 255 : 0));
  for (int y = 0; y < mask.height_px(); ++y) {
    auto* row = image.ptr<std::uint8_t>(y + 1) + 1;
    for (int x = 0; x < mask.width_px(); ++x) row[x] = mask.At(x, y) ? 255 : 0;
  }
  return image;
}

}  // namespace

Silhouette::Silhouette(core::BitMask mask, bool exterior_is_object)
    : mask_(std::move(mask)), exterior_is_object_(exterior_is_object) {
  for (int y = 0; y < mask_.height_px(); ++y) {
    for (int x = 0; x < mask_.width_px(); ++x) {
      if (mask_.At(x, y) != exterior_is_object) differing_px_.extend(SquareOf(x, y));
    }
  }
  if (differing_px_.isEmpty()) return;
  const cv::Mat object = RingedImage(mask_, exterior_is_object);
  cv::Mat to_background, to_object;
  cv::distanceTransform(object, to_background, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(~object, to_object, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const cv::Mat field = cv::max(to_background, to_object);  // one of the two is zero
  field_px_.assign(field.begin<float>(), field.end<float>());
}

bool Silhouette::IsPixel(const Eigen::Vector2i& pixel) const {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < mask_.width_px() && pixel.y() < mask_.height_px();
}

bool Silhouette::LabelOfPixel(const Eigen::Vector2i& pixel) const {
  return IsPixel(pixel) ? mask_.At(pixel.x(), pixel.y()) : exterior_is_object_;
}

double Silhouette::FieldAt(const Eigen::Vector2i& pixel) const {
  const auto width = static_cast<std::size_t>(mask_.width_px() + 2);
  return field_px_[static_cast<std::size_t>(pixel.y() + 1) * width + static_cast<std::size_t>(pixel.x() + 1)];
}

bool Silhouette::IsInImage(const Eigen::Vector2d& position_px) const {
  return IsPixel(NearestPixel(position_px));
}

bool Silhouette::IsObject(const Eigen::Vector2d& position_px) const {
  return LabelOfPixel(NearestPixel(position_px));
}

PixelLabel Silhouette::LabelAt(const Eigen::Vector2d& position_px) const {
  if (differing_px_.isEmpty()) return {exterior_is_object_, std::numeric_limits<double>::infinity()};
  const Eigen::Vector2i pixel = NearestPixel(position_px);
  if (!IsPixel(pixel)) {
    return {exterior_is_object_, std::max(DistanceFromOutside(position_px) - kPositionRoundingPx, 0.0)};
  }
  const bool label = mask_.At(pixel.x(), pixel.y());
  const double field_px = FieldAt(pixel);
  double distance_px = field_px - kHalfDiagonalPx - (position_px - pixel.cast<double>()).norm() - kRoundingPx;
  if (distance_px < kWindowPx)
    distance_px = std::max(distance_px, DistanceWithinWindow(position_px, pixel, label));
  return {label, std::max(distance_px - kPositionRoundingPx, 0.0)};
}

double Silhouette::DistanceFromOutside(const Eigen::Vector2d& position_px) const {
  // The picture is convex: what lies in it is at least as far as the legs to the picture's nearest position
  // and from there make a right angle.
  const Eigen::Vector2d nearest_px =
      position_px.cwiseMax(-0.5).cwiseMin(Eigen::Vector2d(mask_.width_px() - 0.5, mask_.height_px() - 0.5));
  const Eigen::Vector2i pixel =
      NearestPixel(nearest_px).cwiseMin(Eigen::Vector2i(mask_.width_px() - 1, mask_.height_px() - 1));
  double within_px = 0.0;
  if (mask_.At(pixel.x(), pixel.y()) == exterior_is_object_) {
    within_px = FieldAt(pixel) - kHalfDiagonalPx - (nearest_px - pixel.cast<double>()).norm() - kRoundingPx;
  }
  const double legs_px = std::hypot((position_px - nearest_px).norm(), std::max(within_px, 0.0));
  return std::max(legs_px, DistanceToBox(differing_px_, position_px));
}

double Silhouette::DistanceWithinWindow(const Eigen::Vector2d& position_px, const Eigen::Vector2i& pixel,
                                        bool label) const {
  // Squares beyond the window begin kWindowPx + 0.5 from the centre, and the position is within 0.5 of it.
  double nearest_px = kWindowPx;
  for (int y = pixel.y() - kWindowPx; y <= pixel.y() + kWindowPx; ++y) {
    for (int x = pixel.x() - kWindowPx; x <= pixel.x() + kWindowPx; ++x) {
      if (LabelOfPixel({x, y}) == label) continue;
      const double dx = std::max(std::abs(position_px.x() - x) - 0.5, 0.0);
      const double dy = std::max(std::abs(position_px.y() - y) - 0.5, 0.0);
      nearest_px = std::min(nearest_px, std::hypot(dx, dy));
    }
  }
  return nearest_px;
}

Eigen::Vector2d Silhouette::OutwardDirection(const Eigen::Vector2d& position_px, double span_px) const {
  if (differing_px_.isEmpty()) return Eigen::Vector2d::Zero();
  const auto signed_distance = [&](double dx, double dy) {
    const Eigen::Vector2i pixel = NearestPixel(position_px + Eigen::Vector2d(dx, dy));
    if (!IsPixel(pixel)) return exterior_is_object_ ? -span_px : span_px;
    return mask_.At(pixel.x(), pixel.y()) ? 0.5 - FieldAt(pixel) : FieldAt(pixel) - 0.5;
  };
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  constexpr int kDirections = 16;
  for (int i = 0; i < kDirections; ++i) {
    const double angle_rad = 2.0 * M_PI * i / kDirections;
    const Eigen::Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
    for (const double radius_px : {0.5 * span_px, span_px}) {
      const Eigen::Vector2d offset = direction * radius_px;
      sum += direction * signed_distance(offset.x(), offset.y());
    }
  }
  return sum.norm() > 0.0 ? sum.normalized() : sum;
}

}  // namespace elbowroom::recon
