// Cuts triangles across their longest sides, so that repeated cuts make needles short too.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>

namespace elbowroom::review {

// The corners of a triangle, in any frame.
struct Corners {
  Eigen::Vector3d a, b, c;
};

// Sides whose squared lengths differ by a smaller share are equally long: where two are, as in the halves of
// every right triangle, rounding doesn't decide, and a triangle is cut at the same places in every frame.
inline constexpr double kEqualSides = 1e-9;

// The two halves, cut at the middle of the longest side; the first of several.
[[nodiscard]] inline std::pair<Corners, Corners> Bisect(const Corners& t) {
  const double ab = (t.b - t.a).squaredNorm(), bc = (t.c - t.b).squaredNorm(), ca = (t.a - t.c).squaredNorm();
  const double longest = std::max({ab, bc, ca}) * (1.0 - kEqualSides);
  if (ab >= longest) {
    const Eigen::Vector3d m = 0.5 * (t.a + t.b);
    return {{t.a, m, t.c}, {m, t.b, t.c}};
  }
  if (bc >= longest) {
    const Eigen::Vector3d m = 0.5 * (t.b + t.c);
    return {{t.a, t.b, m}, {t.a, m, t.c}};
  }
  const Eigen::Vector3d m = 0.5 * (t.c + t.a);
  return {{t.a, t.b, m}, {m, t.b, t.c}};
}

}  // namespace elbowroom::review
