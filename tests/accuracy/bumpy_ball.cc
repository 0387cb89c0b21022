#include "tests/accuracy/bumpy_ball.h"

#include <cmath>
#include <numbers>

namespace elbowroom::accuracy {

core::TriangleMesh BumpyBall(int rings) {
  constexpr double kRadiusMm = 100.0, kBumpMm = 5.0, kBumps = 8.0;
  core::TriangleMesh mesh;
  for (int i = 1; i <= rings; ++i) {
    const double from_pole = std::numbers::pi * i / (rings + 1);
    for (int j = 0; j < rings; ++j) {
      const double around = 2.0 * std::numbers::pi * j / rings;
      const double radius_mm = kRadiusMm + kBumpMm * std::sin(kBumps * from_pole) * std::sin(kBumps * around);
      mesh.vertices_mm.emplace_back(radius_mm * std::sin(from_pole) * std::cos(around),
                                    radius_mm * std::sin(from_pole) * std::sin(around),
                                    radius_mm * std::cos(from_pole));
    }
  }
  const auto top = static_cast<std::int32_t>(mesh.vertices_mm.size());
  mesh.vertices_mm.emplace_back(0.0, 0.0, kRadiusMm);
  mesh.vertices_mm.emplace_back(0.0, 0.0, -kRadiusMm);
  for (int j = 0; j < rings; ++j) {
    const int next = (j + 1) % rings, last = (rings - 1) * rings;
    mesh.triangles.push_back({top, j, next});
    for (int first = 0; first < last; first += rings) {
      mesh.triangles.push_back({first + j, first + rings + j, first + next});
      mesh.triangles.push_back({first + next, first + rings + j, first + rings + next});
    }
    mesh.triangles.push_back({top + 1, last + next, last + j});
  }
  return mesh;
}

}  // namespace elbowroom::accuracy
