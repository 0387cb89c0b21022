#include "recon/error_budget/normal_cone.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cstddef>

namespace elbowroom::recon {
namespace {

// Normals by their numbers; a set of fewer than three repeats none.
struct NormalSet {
  std::array<std::size_t, 3> at{};
  Eigen::Index size = 0;
};

void TrySet(std::span<const Eigen::Vector3d> normals, const Eigen::Vector3d& direction, const NormalSet& set,
            ConeWeights* best) {
  constexpr double kLeastPivot = 1e-9;  // normals that all but coincide need no set of their own
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> columns(3, set.size);
  for (Eigen::Index i = 0; i < set.size; ++i) columns.col(i) = normals[set.at[static_cast<std::size_t>(i)]];
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  const Eigen::LDLT<Square> squares(Square(columns.transpose() * columns));
  if (squares.vectorD().minCoeff() < kLeastPivot) return;
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> weights =
      squares.solve(columns.transpose() * direction);
  if (weights.minCoeff() < 0.0) return;
  const double residual = (direction - columns * weights).norm();
  // Of sets that are as near, the smaller comes first.
  constexpr double kRounding = 1e-9;
  if (residual > best->residual - kRounding) return;
  best->residual = residual;
  best->weights.assign(normals.size(), 0.0);
  for (Eigen::Index i = 0; i < set.size; ++i) best->weights[set.at[static_cast<std::size_t>(i)]] = weights[i];
}

}  // namespace

ConeWeights WeightsInCone(std::span<const Eigen::Vector3d> normals, const Eigen::Vector3d& direction) {
  ConeWeights best;
  best.weights.assign(normals.size(), 0.0);
  const std::size_t count = normals.size();
  for (std::size_t a = 0; a < count; ++a) TrySet(normals, direction, {{a}, 1}, &best);
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a + 1; b < count; ++b) TrySet(normals, direction, {{a, b}, 2}, &best);
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a + 1; b < count; ++b)
      for (std::size_t c = b + 1; c < count; ++c) TrySet(normals, direction, {{a, b, c}, 3}, &best);
  return best;
}

}  // namespace elbowroom::recon
