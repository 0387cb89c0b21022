#include "tests/support/hard_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <utility>

namespace elbowroom::test_support {
namespace {

using Eigen::Vector3d;

// A grid of rows x around quads, closed around; at(row, turn) gives its vertices.
core::TriangleMesh Wound(int rows, int around, const std::function<Vector3d(double, double)>& at) {
  core::TriangleMesh mesh;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < around; ++j)
      mesh.vertices_mm.push_back(at(static_cast<double>(i) / rows, 2.0 * M_PI * j / around));
  const auto id = [&](int i, int j) { return static_cast<std::int32_t>(i * around + j % around); };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < around; ++j) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i, j + 1)});
      mesh.triangles.push_back({id(i, j + 1), id(i + 1, j), id(i + 1, j + 1)});
    }
  }
  return mesh;
}

int SideOf(int squares) { return std::max(1, static_cast<int>(std::lround(std::sqrt(squares)))); }

}  // namespace

core::TriangleMesh SphereMesh(double radius_mm, int triangles) {
  const int rows = std::max(3, SideOf(triangles / 4));
  core::TriangleMesh mesh = Wound(rows, 2 * rows, [&](double row, double turn) {
    const double tilt = M_PI * row;
    return Vector3d(radius_mm * std::sin(tilt) * std::cos(turn), radius_mm * std::sin(tilt) * std::sin(turn),
                    radius_mm * std::cos(tilt));
  });
  // At the poles, every other triangle has no area.
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const auto vertex = [&](std::size_t i) { return mesh.vertices_mm[static_cast<std::size_t>(t[i])]; };
    return (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)).norm() < 1e-12 * radius_mm * radius_mm;
  });
  return mesh;
}

core::TriangleMesh ShellMesh(double radius_mm, int triangles) {
  core::TriangleMesh mesh = SphereMesh(radius_mm, triangles);
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

core::TriangleMesh BoreMesh(double radius_mm, double length_mm, int triangles) {
  const int rows = std::max(1, SideOf(triangles / 8));
  return Wound(rows, 4 * rows, [&](double row, double turn) {
    return Vector3d(length_mm * (row - 0.5), radius_mm * std::cos(turn), radius_mm * std::sin(turn));
  });
}

core::TriangleMesh NeedleForestMesh(double side_mm, double height_mm, int triangles) {
  const int needles = std::max(1, SideOf(triangles / 3));
  const double apart_mm = side_mm / needles, thick_mm = apart_mm / 3.0;
  core::TriangleMesh mesh;
  for (int i = 0; i < needles; ++i) {
    for (int j = 0; j < needles; ++j) {
      const Vector3d foot((i + 0.5) * apart_mm - 0.5 * side_mm, (j + 0.5) * apart_mm - 0.5 * side_mm, 0.0);
      const auto first = static_cast<std::int32_t>(mesh.vertices_mm.size());
      for (int k = 0; k < 3; ++k) {
        const double turn = 2.0 * M_PI * k / 3.0;
        mesh.vertices_mm.push_back(foot + 0.5 * thick_mm * Vector3d(std::cos(turn), std::sin(turn), 0.0));
      }
      mesh.vertices_mm.push_back(foot + Vector3d(0.0, 0.0, height_mm));
      for (std::int32_t k = 0; k < 3; ++k)
        mesh.triangles.push_back({first + k, first + (k + 1) % 3, first + 3});
    }
  }
  return mesh;
}

core::TriangleMesh ScanMesh(double side_mm, int triangles, std::uint64_t seed) {
  constexpr double kLinesMoreThanPoints = 2.0;  // as a line scanner's: one direction is finer
  constexpr double kUneven = 0.9;               // of the mean distance of two lines
  constexpr double kBumpMm = 12.0, kBumps = 6.0, kNoiseMm = 0.3;
  const int points = std::max(2, SideOf(static_cast<int>(triangles / (2.0 * kLinesMoreThanPoints))));
  const int lines = static_cast<int>(kLinesMoreThanPoints * points);
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> noise_mm(-kNoiseMm, kNoiseMm);
  const auto across = [&](int i, int count) {
    const double share = static_cast<double>(i) / count;
    return side_mm * (share - kUneven * std::sin(2.0 * M_PI * share) / (2.0 * M_PI) - 0.5);
  };
  core::TriangleMesh mesh;
  for (int i = 0; i <= lines; ++i) {
    for (int j = 0; j <= points; ++j) {
      const double x = across(i, lines), y = across(j, points), turn = 2.0 * M_PI * kBumps / side_mm;
      mesh.vertices_mm.emplace_back(x, y,
                                    kBumpMm * std::sin(turn * x) * std::sin(turn * y) + noise_mm(engine));
    }
  }
  const auto id = [&](int i, int j) { return static_cast<std::int32_t>(i * (points + 1) + j); };
  for (int i = 0; i < lines; ++i) {
    for (int j = 0; j < points; ++j) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  return mesh;
}

}  // namespace elbowroom::test_support
