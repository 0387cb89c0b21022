#include "tests/cad_import/sample_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace elbowroom::cad_import::testing {
namespace {

template <typename Value>
void Put(std::string& bytes, Value value, bool big_endian = false) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big_endian) std::reverse(raw, raw + sizeof value);
  bytes.append(raw, sizeof value);
}

void Put(std::string& bytes, const Eigen::Vector3d& v, bool big_endian = false) {
  for (int i = 0; i < 3; ++i) Put(bytes, static_cast<float>(v[i]), big_endian);
}

const Eigen::Vector3d& Corner(const core::TriangleMesh& mesh, std::int32_t index) {
  return mesh.vertices_mm[static_cast<std::size_t>(index)];
}

std::string PlyHeader(const core::TriangleMesh& mesh, const std::string& encoding) {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment made by hand\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      encoding, mesh.vertices_mm.size(), mesh.triangles.size());
}

}  // namespace

std::string StlText(const core::TriangleMesh& mesh, const std::string& name) {
  std::string text = fmt::format("solid {}\n", name);
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const auto index : triangle) {
      const Eigen::Vector3d& v = Corner(mesh, index);
      text += fmt::format("  vertex {} {} {}\n", v.x(), v.y(), v.z());
    }
    text += " endloop\nendfacet\n";
  }
  return text + fmt::format("endsolid {}\n", name);
}

std::string StlBinary(const core::TriangleMesh& mesh) {
  std::string bytes("made by hand");
  bytes.resize(80, ' ');
  Put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    Put(bytes, Eigen::Vector3d(0, 0, 0));
    for (const auto index : triangle) Put(bytes, Corner(mesh, index));
    Put(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string ObjText(const core::TriangleMesh& mesh) {
  std::string text = "# made by hand\n";
  for (const auto& v : mesh.vertices_mm) text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  return text;
}

std::string PlyText(const core::TriangleMesh& mesh) {
  std::string text = PlyHeader(mesh, "ascii");
  for (const auto& v : mesh.vertices_mm) text += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

std::string PlyBinary(const core::TriangleMesh& mesh, bool big_endian) {
  std::string bytes = PlyHeader(mesh, big_endian ? "binary_big_endian" : "binary_little_endian");
  for (const auto& v : mesh.vertices_mm) Put(bytes, v, big_endian);
  for (const auto& triangle : mesh.triangles) {
    Put(bytes, std::uint8_t{3});
    for (const auto index : triangle) Put(bytes, index, big_endian);
  }
  return bytes;
}

GltfSample Gltf(const core::TriangleMesh& mesh, const std::vector<std::string>& nodes,
                const std::vector<int>& roots, const std::string& uri) {
  GltfSample sample;
  for (const auto& v : mesh.vertices_mm) Put(sample.buffer, v);
  const std::size_t vertex_bytes = sample.buffer.size();
  for (const auto& triangle : mesh.triangles) {
    for (const auto index : triangle) Put(sample.buffer, static_cast<std::uint16_t>(index));
  }
  const std::size_t index_bytes = sample.buffer.size() - vertex_bytes;
  sample.json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
      R"({{"bufferView":1,"componentType":5123,"count":{},"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
      R"("buffers":[{{{}"byteLength":{}}}]}})",
      fmt::join(roots, ","), fmt::join(nodes, ","), mesh.vertices_mm.size(), 3 * mesh.triangles.size(),
      vertex_bytes, vertex_bytes, index_bytes, uri.empty() ? "" : fmt::format(R"("uri":"{}",)", uri),
      sample.buffer.size());
  return sample;
}

std::string Glb(const GltfSample& sample) {
  std::string json = sample.json, buffer = sample.buffer;
  json.resize((json.size() + 3) / 4 * 4, ' ');
  buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  Put(bytes, std::uint32_t{2});
  Put(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  Put(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  Put(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes.append("BIN\0", 4);
  return bytes + buffer;
}

}  // namespace elbowroom::cad_import::testing
