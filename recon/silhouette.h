// One camera's picture of what is object, and how far any place in it is from a change of mind.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/bit_mask.h"

namespace elbowroom::recon {

// What the image says at one position.
struct PixelLabel {
  bool is_object = false;
  // Certified: every position nearer than this carries the same label. Infinite where nothing differs.
  double distance_px = 0.0;
};

// A mask with its distance field. Convention: pixel (x, y) is the square [x - 0.5, x + 0.5)^2 and all of it
// carries the pixel's bit; positions outside the image carry `exterior_is_object`.
// Immutable. Thread: any.
class Silhouette {
 public:
  // The field costs two exact Euclidean distance transforms; an empty mask costs none.
  Silhouette(core::BitMask mask, bool exterior_is_object);

  [[nodiscard]] const core::BitMask& mask() const { return mask_; }

  [[nodiscard]] bool IsInImage(const Eigen::Vector2d& position_px) const;

  // The label alone, of any finite position; nearest pixel, halves away from minus infinity.
  [[nodiscard]] bool IsObject(const Eigen::Vector2d& position_px) const;

  // The label and its certified reach. In the image exact to 1e-6 px within 2 px of a change, at most 1.5 px
  // short beyond; outside it no shorter than the distance to the image and to the box of all that differs
  // (tests/recon/silhouette_test.cc).
  [[nodiscard]] PixelLabel LabelAt(const Eigen::Vector2d& position_px) const;

  // Direction of the steepest change from object to background around a position, by differences of the
  // distance field over `span_px`; zero where the field is flat.
  [[nodiscard]] Eigen::Vector2d OutwardDirection(const Eigen::Vector2d& position_px, double span_px) const;

 private:
  [[nodiscard]] bool IsPixel(const Eigen::Vector2i& pixel) const;
  [[nodiscard]] std::size_t Index(const Eigen::Vector2i& pixel) const;  // into labels_ and field_px_
  [[nodiscard]] double DistanceFromOutside(const Eigen::Vector2d& position_px) const;
  [[nodiscard]] double DistanceWithinWindow(const Eigen::Vector2d& position_px,
                                            const Eigen::Vector2i& pixel) const;

  core::BitMask mask_;
  bool exterior_is_object_ = false;
  // Of the pixels whose label differs from the exterior's, as a box of their squares; empty if none.
  Eigen::AlignedBox2d differing_px_;
  // The mask as bytes (255: object) with two rings of exterior around it.
  std::vector<std::uint8_t> labels_;
  // On the same grid, distance from a pixel's centre to the nearest centre of the other label; empty if all
  // labels are equal.
  std::vector<float> field_px_;
};

}  // namespace elbowroom::recon
