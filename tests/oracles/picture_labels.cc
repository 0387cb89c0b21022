#include "tests/oracles/picture_labels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace elbowroom::oracles {
namespace {

constexpr int kLeastObjectValue = 128;
constexpr long double kThreshold = 127.5L;
// The corners of a cell in order around it, as offsets from its first.
constexpr std::array<std::array<int, 2>, 4> kCorners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

Vector2L CornerPosition(int x, int y, int corner) {
  const auto& offset = kCorners[static_cast<std::size_t>(corner & 3)];
  return {static_cast<long double>(x + offset[0]), static_cast<long double>(y + offset[1])};
}

// Positive where p lies left of a to b, as x to the right and y down would have it on paper upside down.
long double Side(const Vector2L& a, const Vector2L& b, const Vector2L& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

long double DistanceToSegment(const Vector2L& a, const Vector2L& b, const Vector2L& p) {
  const Vector2L along = b - a;
  const long double share = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0L, 1.0L);
  return (a + share * along - p).norm();
}

long double DistanceToSquare(int x, int y, const Vector2L& p) {
  const long double dx = std::max(std::abs(p.x() - x) - 0.5L, 0.0L);
  const long double dy = std::max(std::abs(p.y() - y) - 0.5L, 0.0L);
  return std::hypot(dx, dy);
}

}  // namespace

PictureLabels::PictureLabels(const core::SoftMask& mask, BoundaryConvention convention,
                             bool exterior_is_object)
    : width_px_(mask.mask.width_px()),
      height_px_(mask.mask.height_px()),
      convention_(convention),
      exterior_is_object_(exterior_is_object) {
  mask.Validate();
  const core::BitMask boundary = core::BoundaryPixels(mask.mask);
  std::size_t next = 0;
  for (int y = 0; y < height_px_; ++y) {
    for (int x = 0; x < width_px_; ++x) {
      const bool has_level = !mask.levels.empty() && boundary.At(x, y);
      values_.push_back(has_level ? mask.levels[next++] : mask.mask.At(x, y) ? 255 : 0);
    }
  }
}

int PictureLabels::ValueAt(int x, int y) const {
  if (!IsPixel(x, y)) return exterior_is_object_ ? 255 : 0;
  return values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px_) +
                 static_cast<std::size_t>(x)];
}

bool PictureLabels::IsObjectPixel(int x, int y) const { return ValueAt(x, y) >= kLeastObjectValue; }

long double PictureLabels::CrossingShare(int ax, int ay, int bx, int by) const {
  if (!IsPixel(ax, ay) || !IsPixel(bx, by)) return 0.5L;
  const long double a = ValueAt(ax, ay), b = ValueAt(bx, by);
  return (a - kThreshold) / (a - b);
}

bool PictureLabels::IsInPicture(const Vector2L& p) const {
  return p.x() >= -0.5L && p.x() < width_px_ - 0.5L && p.y() >= -0.5L && p.y() < height_px_ - 0.5L;
}

PictureLabels::Cell PictureLabels::CellAt(int x, int y) const {
  std::array<int, 4> value{};
  int objects = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value[i] = ValueAt(x + kCorners[i][0], y + kCorners[i][1]);
    objects += value[i] >= kLeastObjectValue ? 1 : 0;
  }
  const auto is_object = [&](int i) { return value[static_cast<std::size_t>(i & 3)] >= kLeastObjectValue; };
  const auto crossing = [&](int i, int j) -> Vector2L {
    const auto &a = kCorners[static_cast<std::size_t>(i & 3)], &b = kCorners[static_cast<std::size_t>(j & 3)];
    const Vector2L from = CornerPosition(x, y, i), to = CornerPosition(x, y, j);
    return from + CrossingShare(x + a[0], y + a[1], x + b[0], y + b[1]) * (to - from);
  };
  Cell cell{objects == 4, 0, {}};
  // `object_corner` lies on the object's side of the segment.
  const auto add = [&](const Vector2L& a, const Vector2L& b, int corner, bool corner_is_object) {
    const bool is_left = (Side(a, b, CornerPosition(x, y, corner)) > 0.0L) == corner_is_object;
    cell.segment[static_cast<std::size_t>(cell.segments++)] = is_left ? Segment{a, b} : Segment{b, a};
  };
  for (int i = 0; i < 4; ++i) {
    const bool differs_before = is_object(i) != is_object(i + 3),
               differs_after = is_object(i) != is_object(i + 1);
    // A corner alone; in a saddle the two background corners are cut off.
    if (differs_before && differs_after && (objects != 2 || !is_object(i))) {
      add(crossing(i, i + 3), crossing(i, i + 1), i, is_object(i));
    }
    // Two object corners side by side.
    if (objects == 2 && is_object(i) && is_object(i + 1))
      add(crossing(i, i + 3), crossing(i + 1, i + 2), i, true);
  }
  return cell;
}

bool PictureLabels::LabelAt(const Vector2L& p) const {
  if (convention_ == BoundaryConvention::kPixelSquares) {
    if (!IsInPicture(p)) return exterior_is_object_;
    return IsObjectPixel(static_cast<int>(std::floor(p.x() + 0.5L)),
                         static_cast<int>(std::floor(p.y() + 0.5L)));
  }
  if (!(p.x() > -1.0L && p.y() > -1.0L && p.x() < width_px_ && p.y() < height_px_))
    return exterior_is_object_;
  const Cell cell = CellAt(static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())));
  if (cell.segments == 0) return cell.is_object;
  for (int i = 0; i < cell.segments; ++i) {
    const Segment& segment = cell.segment[static_cast<std::size_t>(i)];
    if (Side(segment.a, segment.b, p) < 0.0L) return false;
  }
  return true;
}

long double PictureLabels::SquaresDistance(const Vector2L& p, bool label) const {
  long double nearest = std::numeric_limits<long double>::infinity();
  const Vector2L in_picture = {std::clamp(p.x(), -0.5L, width_px_ - 0.5L),
                               std::clamp(p.y(), -0.5L, height_px_ - 0.5L)};
  // Across the picture's border.
  if (IsInPicture(p) && label != exterior_is_object_) {
    nearest = std::min({p.x() + 0.5L, width_px_ - 0.5L - p.x(), p.y() + 0.5L, height_px_ - 0.5L - p.y()});
  }
  const int x0 = static_cast<int>(std::floor(in_picture.x() + 0.5L));
  const int y0 = static_cast<int>(std::floor(in_picture.y() + 0.5L));
  for (int y = y0 - 1; y <= y0 + 1; ++y) {
    for (int x = x0 - 1; x <= x0 + 1; ++x) {
      if (IsPixel(x, y) && IsObjectPixel(x, y) != label)
        nearest = std::min(nearest, DistanceToSquare(x, y, p));
    }
  }
  return nearest;
}

// Up to a pixel.
long double PictureLabels::BoundaryDistance(const Vector2L& p) const {
  if (convention_ == BoundaryConvention::kPixelSquares) return SquaresDistance(p, LabelAt(p));
  long double nearest = std::numeric_limits<long double>::infinity();
  if (!(p.x() > -2.0L && p.y() > -2.0L && p.x() < width_px_ + 1.0L && p.y() < height_px_ + 1.0L))
    return nearest;
  const int x0 = static_cast<int>(std::floor(p.x())), y0 = static_cast<int>(std::floor(p.y()));
  for (int y = y0 - 1; y <= y0 + 1; ++y) {
    for (int x = x0 - 1; x <= x0 + 1; ++x) {
      const Cell cell = CellAt(x, y);
      for (int i = 0; i < cell.segments; ++i) {
        const Segment& segment = cell.segment[static_cast<std::size_t>(i)];
        nearest = std::min(nearest, DistanceToSegment(segment.a, segment.b, p));
      }
    }
  }
  return nearest;
}

bool PictureLabels::IsObject(const Vector2L& position_px, double grow_px) const {
  const bool label = LabelAt(position_px);
  if (grow_px == 0.0 || label == (grow_px > 0.0)) return label;
  core::Require(std::abs(grow_px) <= 0.5, "a boundary is moved by half a pixel at most");
  return BoundaryDistance(position_px) <= std::abs(static_cast<long double>(grow_px)) ? !label : label;
}

PictureLabels OutlineLabels(int width_px, int height_px, BoundaryConvention convention) {
  core::SoftMask all{core::BitMask(width_px, height_px), {}};
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x) all.mask.Set(x, y, true);
  return {all, convention, false};
}

}  // namespace elbowroom::oracles
