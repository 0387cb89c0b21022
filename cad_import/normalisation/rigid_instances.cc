#include "cad_import/normalisation/rigid_instances.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;

// Files hold transforms in single precision.
constexpr double kRigidTolerance = 1e-5;

// A placement as a rigid motion after a symmetric stretch, L = R S; a mirror is in S.
struct RotationAndStretch {
  Eigen::Matrix3d rotation;
  Eigen::Matrix3d stretch;  // identity where the motion is rigid but for rounding
};
RotationAndStretch PolarDecomposition(const Eigen::Matrix3d& linear) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  Eigen::Matrix3d stretch = rotation.transpose() * linear;
  if (rotation.determinant() < 0.0) {
    rotation = -rotation;
    stretch = -stretch;
  }
  if (stretch.isIdentity(kRigidTolerance)) stretch.setIdentity();
  return {rotation, stretch};
}

// The entries as multiples of about a hundred thousandth of the largest, and last the exponent of that unit:
// stretches that differ by rounding are mostly equal in it.
std::array<std::int64_t, 10> RoundedStretch(const Eigen::Matrix3d& stretch) {
  constexpr int kBits = 17;
  const double largest = stretch.lpNorm<Eigen::Infinity>();
  const int exponent = largest > 0.0 ? std::ilogb(largest) - kBits : 0;
  std::array<std::int64_t, 10> rounded{};
  std::ranges::transform(stretch.reshaped(), rounded.begin(),
                         [&](double number) { return std::llround(std::ldexp(number, -exponent)); });
  rounded.back() = exponent;
  return rounded;
}

RawShape Stretched(const RawShape& shape, const Eigen::Matrix3d& stretch) {
  RawShape result = shape;
  for (Eigen::Vector3d& vertex : result.mesh.vertices_mm) vertex = stretch * vertex;
  result.deviation *=
      stretch.cwiseAbs().rowwise().sum().maxCoeff();  // no less than its largest singular value
  if (stretch.determinant() < 0.0)
    for (auto& triangle : result.mesh.triangles) std::swap(triangle[1], triangle[2]);
  return result;
}

}  // namespace

RigidInstances MakeRigid(const RawScene& scene, const std::string& where) {
  using Key = std::pair<std::size_t, std::array<std::int64_t, 10>>;
  std::map<Key, std::size_t> made;
  RigidInstances result;
  for (const RawInstance& instance : scene.instances) {
    const Eigen::Matrix3d linear = instance.model_from_shape.linear();
    const Eigen::Vector3d place_mm = instance.model_from_shape.translation();
    if (!linear.allFinite() || !place_mm.allFinite()) {
      throw Error(ErrorKind::kGeometry,
                  fmt::format("{}: '{}' isn't placed at a finite point; repair the file before importing it",
                              where, instance.path));
    }
    const auto [rotation, stretch] = PolarDecomposition(linear);
    const Key key{instance.shape, RoundedStretch(stretch)};
    const auto [found, is_new] = made.try_emplace(key, result.shapes.size());
    if (is_new) {
      const RawShape& shape = scene.shapes[instance.shape];
      result.shapes.push_back(stretch.isIdentity(0.0) ? shape : Stretched(shape, stretch));
    }
    result.instances.push_back({instance.path, found->second, {rotation, place_mm}, instance.color});
  }
  return result;
}

}  // namespace elbowroom::cad_import
