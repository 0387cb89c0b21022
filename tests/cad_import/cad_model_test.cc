#include "cad_import/model/cad_model.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

namespace elbowroom::cad_import {
namespace {

core::SharedMesh OneTriangle() {
  auto mesh = std::make_shared<core::TriangleMesh>();
  mesh->vertices_mm = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh->triangles = {{0, 1, 2}};
  return mesh;
}

std::vector<std::string> FlatNamesOf(const std::vector<std::string>& names) {
  CadModel model;
  for (const std::string& name : names) {
    model.instances.push_back({name, model.shapes.size(), {}, std::nullopt});
    model.shapes.push_back({name, OneTriangle(), {{name, 0, 1}}, {}});
  }
  std::vector<std::string> flat;
  for (const ImportedPart& part : Flatten(model).parts) flat.push_back(part.name);
  return flat;
}

TEST(CadModel, FlatPartsHaveNamesOfTheirOwn) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(FlatNamesOf({"a", "b", "a", "a"}), (Names{"a", "b", "a 2", "a 3"}));
  EXPECT_EQ(FlatNamesOf({"a", "a", "a 2"}), (Names{"a", "a 3", "a 2"}))
      << "as the file has it, where it can be";
  EXPECT_EQ(FlatNamesOf({"a 2", "a", "a", "a 2"}), (Names{"a 2", "a", "a 3", "a 2 2"}));
}

}  // namespace
}  // namespace elbowroom::cad_import
