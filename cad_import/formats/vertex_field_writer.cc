#include "cad_import/formats/vertex_field_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "cad_import/formats/file_format.h"
#include "cad_import/formats/glb_container.h"
#include "cad_import/formats/srgb.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "the formats are little-endian");
constexpr double kMmPerMetre = 1000.0;

template <typename T>
void Append(std::string* bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes->append(raw, sizeof value);
}

std::uint8_t ByteOf(float share) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
}

std::string OneLineOf(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

std::string EncodePly(const core::TriangleMesh& mesh, const VertexField& field) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\n";
  for (const auto& [key, text] : field.notes) bytes += fmt::format("comment {}: {}\n", key, OneLineOf(text));
  bytes += fmt::format(
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nproperty float {}\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      mesh.vertices_mm.size(), field.name, mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    for (const double coordinate : mesh.vertices_mm[i]) Append(&bytes, static_cast<float>(coordinate));
    for (const float channel : field.colors[i]) Append(&bytes, ByteOf(channel));
    Append(&bytes, static_cast<float>(field.values[i]));
  }
  for (const auto& triangle : mesh.triangles) {
    Append(&bytes, std::uint8_t{3});
    for (const std::int32_t vertex : triangle) Append(&bytes, vertex);
  }
  return bytes;
}

// The binary chunk of a GLB file: views of it, one after the other, and what they hold.
class GlbData {
 public:
  // glTF's numbers for the types of an accessor's components.
  enum Component { kFloat = 5126, kByte = 5121, kIndex = 5125 };
  enum Target { kVertices = 34962, kTriangles = 34963 };

  // `write` appends the bytes; a multiple of 4. Returns the accessor, to which more may be added.
  template <typename Write>
  Json& Add(Component component, const char* type, std::size_t count, Target target, const Write& write) {
    const std::size_t begin = bytes_.size();
    write(&bytes_);
    views_.push_back(
        {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes_.size() - begin}, {"target", target}});
    accessors_.push_back(
        {{"bufferView", views_.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
    return accessors_.back();
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] const Json& views() const { return views_; }
  [[nodiscard]] const Json& accessors() const { return accessors_; }

 private:
  std::string bytes_;
  Json views_ = Json::array(), accessors_ = Json::array();
};

Eigen::Vector3f InMetres(const Eigen::Vector3d& vertex_mm) { return (vertex_mm / kMmPerMetre).cast<float>(); }

void AddPositions(const core::TriangleMesh& mesh, GlbData* data) {
  Eigen::AlignedBox3f bounds;
  Json& accessor = data->Add(GlbData::kFloat, "VEC3", mesh.vertices_mm.size(), GlbData::kVertices,
                             [&](std::string* bytes) {
                               for (const Eigen::Vector3d& vertex : mesh.vertices_mm) {
                                 const Eigen::Vector3f in_metres = InMetres(vertex);
                                 bounds.extend(in_metres);
                                 for (const float coordinate : in_metres) Append(bytes, coordinate);
                               }
                             });
  accessor["min"] = {bounds.min().x(), bounds.min().y(), bounds.min().z()};
  accessor["max"] = {bounds.max().x(), bounds.max().y(), bounds.max().z()};
}

void AddColors(const VertexField& field, GlbData* data) {
  Json& accessor =
      data->Add(GlbData::kByte, "VEC4", field.colors.size(), GlbData::kVertices, [&](std::string* bytes) {
        for (const ColorRgb& color : field.colors) {
          for (const float channel : color) Append(bytes, ByteOf(LinearFromSrgb(channel)));
          Append(bytes, std::uint8_t{255});
        }
      });
  accessor["normalized"] = true;
}

std::string UpperCase(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return text;
}

std::string EncodeGlb(const core::TriangleMesh& mesh, const VertexField& field, const std::string& name) {
  GlbData data;
  AddPositions(mesh, &data);
  AddColors(field, &data);
  data.Add(GlbData::kFloat, "SCALAR", field.values.size(), GlbData::kVertices, [&](std::string* bytes) {
    for (const double value : field.values) Append(bytes, static_cast<float>(value));
  });
  data.Add(GlbData::kIndex, "SCALAR", 3 * mesh.triangles.size(), GlbData::kTriangles,
           [&](std::string* bytes) {
             for (const auto& triangle : mesh.triangles)
               for (const std::int32_t vertex : triangle) Append(bytes, static_cast<std::uint32_t>(vertex));
           });
  Json extras = Json::object();
  for (const auto& [key, text] : field.notes) extras[key] = text;
  const Json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}}};
  const Json primitive = {{"attributes", {{"POSITION", 0}, {"COLOR_0", 1}, {"_" + UpperCase(field.name), 2}}},
                          {"indices", 3},
                          {"material", 0}};
  const Json node = {{"name", name}, {"mesh", 0}}, buffer = {{"byteLength", data.bytes().size()}};
  const Json scene = {{"nodes", Json::array({0})}};
  const Json shape = {{"name", name}, {"primitives", Json::array({primitive})}, {"extras", extras}};
  const Json document = {{"asset", {{"version", "2.0"}, {"generator", "elbowroom"}, {"extras", extras}}},
                         {"scene", 0},
                         {"scenes", Json::array({scene})},
                         {"nodes", Json::array({node})},
                         {"meshes", Json::array({shape})},
                         {"materials", Json::array({material})},
                         {"accessors", data.accessors()},
                         {"bufferViews", data.views()},
                         {"buffers", Json::array({buffer})}};
  return MakeGlb(document.dump(-1, ' ', false, Json::error_handler_t::replace), data.bytes());
}

}  // namespace

std::string EncodeField(const core::TriangleMesh& mesh, const VertexField& field,
                        const std::filesystem::path& path) {
  core::ValidateMesh(mesh, path.string());
  core::Require(field.values.size() == mesh.vertices_mm.size() && field.colors.size() == field.values.size(),
                "a value and a colour for each vertex");
  return FindFormat(path) == FileFormat::kPly ? EncodePly(mesh, field)
                                              : EncodeGlb(mesh, field, path.stem().string());
}

std::string StlHeader(const VertexField& field) {
  constexpr std::size_t kHeaderBytes = 80;
  std::string header = "elbowroom";  // "solid" would be read as a text file
  for (const auto& [key, text] : field.notes) header += fmt::format("; {}: {}", key, OneLineOf(text));
  header.resize(kHeaderBytes, ' ');
  return header;
}

}  // namespace elbowroom::cad_import
