// The march that both oracles share: a fine step along a ray, except where nothing can be.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "recon/hull/ray.h"
#include "tests/oracles/picture_labels.h"

namespace elbowroom::oracles {

struct MarchOptions {
  double step_mm = 0.02;
  double from_mm = 0.0;
};

// Where a ray enters and leaves a box, not before `from_mm`; nothing if it misses it.
[[nodiscard]] inline std::optional<std::pair<long double, long double>> ClipToBox(
    const Eigen::AlignedBox3d& box_mm, const recon::Ray& ray, double from_mm) {
  long double enter = from_mm, leave = std::numeric_limits<long double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const long double o = ray.origin_in_world[axis], d = ray.direction_in_world[axis];
    const long double low = box_mm.min()[axis] - o, high = box_mm.max()[axis] - o;
    if (d == 0.0L) {
      if (low > 0.0L || high < 0.0L) return std::nullopt;
      continue;
    }
    enter = std::max(enter, std::min(low / d, high / d));
    leave = std::min(leave, std::max(low / d, high / d));
  }
  if (enter > leave) return std::nullopt;
  return std::pair{enter, leave};
}

// Asks `contains(t)` at every step from `begin` to `end`, less the stretches of which `is_empty(t0, t1)` is
// sure, then bisects the first change to the last bit of a double's worth. Stretches shorter than a step may
// be missed.
template <std::predicate<long double> Contains, std::predicate<long double, long double> IsEmpty>
[[nodiscard]] std::optional<double> FirstAlong(long double begin, long double end, double step_mm,
                                               const Contains& contains, const IsEmpty& is_empty) {
  constexpr std::int64_t kAskEach = 12;  // steps, below which stretches aren't halved any more
  constexpr int kBisections = 48;
  const auto at = [&](std::int64_t i) {
    return std::min(begin + static_cast<long double>(i) * step_mm, end);
  };
  // The first index in [first, last] that is inside.
  const auto search = [&](const auto& self, std::int64_t first,
                          std::int64_t last) -> std::optional<std::int64_t> {
    if (is_empty(at(first), at(last))) return std::nullopt;
    if (last - first < kAskEach) {
      for (std::int64_t i = first; i <= last; ++i)
        if (contains(at(i))) return i;
      return std::nullopt;
    }
    const std::int64_t middle = first + (last - first) / 2;
    const std::optional<std::int64_t> found = self(self, first, middle);
    return found ? found : self(self, middle + 1, last);
  };
  const auto steps = static_cast<std::int64_t>(std::ceil((end - begin) / step_mm));
  const std::optional<std::int64_t> index = search(search, 0, steps);
  if (!index) return std::nullopt;
  if (*index == 0) return static_cast<double>(begin);
  long double outside = at(*index - 1), inside = at(*index);
  for (int i = 0; i < kBisections; ++i) {
    const long double middle = 0.5L * (outside + inside);
    (contains(middle) ? inside : outside) = middle;
  }
  return static_cast<double>(inside);
}

[[nodiscard]] inline Vector3L PointAt(const recon::Ray& ray, long double t_mm) {
  return ray.origin_in_world.cast<long double>() + t_mm * ray.direction_in_world.cast<long double>();
}

}  // namespace elbowroom::oracles
