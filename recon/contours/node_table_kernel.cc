// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/contours/node_table_kernel.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>
#include <algorithm>
#include <cstddef>

#include "recon/contours/node_table_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Eigen::Array2d;

constexpr std::size_t kNodes = 4;  // in a row, and in a column

void Interpolate(const NodeTable& table, std::span<const Eigen::Vector2d> places, Eigen::Vector2d* found) {
  const Doubles d;
  const std::size_t width = 2 * static_cast<std::size_t>(table.across);
  const double* const nodes = table.nodes->data();
  for (const Eigen::Vector2d& place : places) {
    const int i = std::clamp(static_cast<int>(place.x()), 1, table.across - 3);
    const int j = std::clamp(static_cast<int>(place.y()), 1, table.down - 3);
    // The weights of nodes -1, 0, 1, 2 for a place t past node 0 (Lagrange), across and down at once.
    const Array2d t = place.array() - Array2d(i, j), a = t + 1.0, b = t - 1.0, c = t - 2.0, bc = b * c;
    const Array2d weights[kNodes] = {(-1.0 / 6.0) * (t * bc), 0.5 * (a * bc), -0.5 * (a * t * c),
                                     (1.0 / 6.0) * (a * t * b)};
    // Down first: the two coordinates of four columns are eight numbers side by side.
    const double* const first =
        nodes + static_cast<std::size_t>(j - 1) * width + 2 * static_cast<std::size_t>(i - 1);
    alignas(64) double columns[2 * kNodes];
    for (std::size_t part = 0; part < 2 * kNodes; part += hn::Lanes(d)) {
      auto sum = hn::Mul(hn::Set(d, weights[0].y()), hn::LoadU(d, first + part));
      for (std::size_t v = 1; v < kNodes; ++v)
        sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[v].y()), hn::LoadU(d, first + v * width + part)));
      hn::Store(sum, d, columns + part);
    }
    Array2d sum = weights[0].x() * Eigen::Map<const Array2d, Eigen::Aligned16>(columns);
    for (std::size_t u = 1; u < kNodes; ++u)
      sum += weights[u].x() * Eigen::Map<const Array2d, Eigen::Aligned16>(columns + 2 * u);
    *found++ = sum;
  }
}

}  // namespace
}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(Interpolate);

void InterpolateNodes(const NodeTable& table, std::span<const Eigen::Vector2d> places,
                      Eigen::Vector2d* found) {
  HWY_DYNAMIC_DISPATCH(Interpolate)(table, places, found);
}

}  // namespace elbowroom::recon
#endif
