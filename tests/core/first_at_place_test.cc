#include "core/mesh_queries/first_at_place.h"

#include <gtest/gtest.h>

#include <cmath>

namespace elbowroom::core {
namespace {

TEST(FirstAtPlace, IsOneForAllThatAreEqualToTheLastBit) {
  TriangleMesh mesh;
  mesh.vertices_mm = {{1.0, 2.0, 3.0}, {0.0, 0.0, 0.0},  {1.0, 2.0, std::nextafter(3.0, 4.0)},
                      {1.0, 2.0, 3.0}, {-0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}};
  EXPECT_EQ(FirstAtPlace(mesh), (std::vector<std::int32_t>{0, 1, 2, 0, 1, 0}));
  EXPECT_TRUE(FirstAtPlace(TriangleMesh()).empty());
}

}  // namespace
}  // namespace elbowroom::core
