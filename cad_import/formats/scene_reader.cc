#include "cad_import/formats/scene_reader.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <charconv>
#include <exception>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "cad_import/formats/collada_unit.h"
#include "cad_import/formats/glb_container.h"
#include "cad_import/formats/gltf_document.h"
#include "cad_import/formats/obj_text.h"
#include "cad_import/formats/referenced_files.h"
#include "cad_import/formats/srgb.h"
#include "cad_import/formats/stl_check.h"
#include "cad_import/formats/text_encoding.h"
#include "core/error.h"
#include "core/plain_text.h"
#include "core/units.h"

namespace elbowroom::cad_import {
namespace {

namespace fs = std::filesystem;

using core::Error;
using core::ErrorKind;

// "%20" as the byte that it stands for.
std::string WithoutEscapes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = 0;
    const char* digits = text.data() + i + 1;
    const bool is_escape = text[i] == '%' && i + 2 < text.size() &&
                           std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
    plain += is_escape ? static_cast<char>(byte) : text[i];
    if (is_escape) i += 2;
  }
  return plain;
}

struct Source {
  const fs::path& file;
  FileFormat format;
  const std::string& bytes;  // as they were checked, and mended where they had to be
  bool is_from_bytes = false;
};

// Opens for reading what lies in the file's folder or below, links resolved; refuses all else. For the file
// itself it gives the source's bytes, if `is_from_bytes`.
class ConfinedFiles : public Assimp::DefaultIOSystem {
 public:
  // What was opened and what was refused. It outlives the importer, which owns the ConfinedFiles.
  struct Log {
    std::vector<fs::path> opened;  // beside the file itself
    std::vector<std::string> refused;
    std::vector<std::string> missing;
  };
  ConfinedFiles(const Source& source, Log& log)
      : source_(source), file_(fs::weakly_canonical(source.file)), folder_(source.file), log_(log) {}

  bool Exists(const char* named) const override {
    const fs::path file = FileOf(named);
    return folder_.Holds(file) && DefaultIOSystem::Exists(file.c_str());
  }

  Assimp::IOStream* Open(const char* named, const char* mode) override {
    const fs::path file = FileOf(named);
    if (!std::string_view(mode).starts_with('r') || !folder_.Holds(file)) {
      log_.refused.emplace_back(named);
      return nullptr;
    }
    const fs::path whole = fs::weakly_canonical(file);
    if (whole == file_ && source_.is_from_bytes)
      return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(source_.bytes.data()),
                                        source_.bytes.size());
    Assimp::IOStream* stream = DefaultIOSystem::Open(file.c_str(), mode);
    if (stream == nullptr)
      log_.missing.push_back(file.lexically_proximate(source_.file.parent_path()).string());
    if (stream != nullptr && whole != file_ && std::ranges::find(log_.opened, whole) == log_.opened.end())
      log_.opened.push_back(whole);
    return stream;
  }

 private:
  // glTF names files by URIs: "a%20b.bin" is the file "a b.bin", unless there is one of that very name.
  [[nodiscard]] fs::path FileOf(const char* named) const {
    std::error_code error;
    const bool is_uri = source_.format == FileFormat::kGltf || source_.format == FileFormat::kGlb;
    return is_uri && !fs::exists(named, error) ? fs::path(WithoutEscapes(named)) : fs::path(named);
  }

  const Source& source_;
  fs::path file_;  // canonical
  ReferencedFiles folder_;
  Log& log_;
};

// Keeps what the parser says of faces that it leaves out; assimp's log belongs to the process.
class LeftOutLog {
 public:
  LeftOutLog() {
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Stream(has_left_out_faces_),
                                               Assimp::Logger::Warn);  // the log deletes it
  }
  ~LeftOutLog() { Assimp::DefaultLogger::kill(); }
  LeftOutLog(const LeftOutLog&) = delete;
  LeftOutLog& operator=(const LeftOutLog&) = delete;
  [[nodiscard]] bool HasLeftOutFaces() const { return has_left_out_faces_; }

 private:
  class Stream : public Assimp::LogStream {
   public:
    explicit Stream(bool& has_left_out_faces) : has_left_out_faces_(has_left_out_faces) {}
    void write(const char* message) override {
      if (std::string_view(message).find("faces were dropped") != std::string_view::npos)
        has_left_out_faces_ = true;
    }

   private:
    bool& has_left_out_faces_;
  };

  bool has_left_out_faces_ = false;
};

Eigen::Affine3d ToEigen(const aiMatrix4x4& m) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.affine() << double{m.a1}, double{m.a2}, double{m.a3}, double{m.a4},  //
      double{m.b1}, double{m.b2}, double{m.b3}, double{m.b4},                 //
      double{m.c1}, double{m.c2}, double{m.c3}, double{m.c4};
  return result;
}

std::optional<ColorRgb> ColorOf(const aiScene& scene, const aiMesh& mesh) {
  aiColor3D color;
  if (mesh.mMaterialIndex >= scene.mNumMaterials ||
      scene.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_COLOR_DIFFUSE, color) != aiReturn_SUCCESS) {
    return std::nullopt;
  }
  ColorRgb rgb{color.r, color.g, color.b};
  // A channel that is not a number becomes 0.
  for (float& channel : rgb) channel = channel >= 0.0F ? std::min(channel, 1.0F) : 0.0F;
  return rgb;
}

// The name that assimp gives to what it read from memory counts as none.
std::string NameOf(const aiNode& node) {
  const std::string name = node.mName.C_Str();
  return name.starts_with(AI_MEMORYIO_MAGIC_FILENAME) ? "" : name;
}

// Walks assimp's tree of nodes; nodes that show the same meshes share a shape.
class SceneWalk {
 public:
  SceneWalk(const aiScene& scene, std::string where) : scene_(scene), where_(std::move(where)) {}

  void Visit(const aiNode& node, const Eigen::Affine3d& model_from_parent, const std::string& parent) {
    const Eigen::Affine3d model_from_node = model_from_parent * ToEigen(node.mTransformation);
    const std::string name = NameOf(node);
    const std::string path = parent.empty() ? name : parent + '/' + name;
    const std::span<const unsigned> meshes(node.mMeshes, node.mNumMeshes);
    if (const std::optional<std::size_t> shape = ShapeOf(meshes, name)) {
      result_.instances.push_back(
          {path, *shape, model_from_node, ColorOf(scene_, *scene_.mMeshes[meshes.front()])});
      CheckCount();
    }
    for (const aiNode* child : std::span(node.mChildren, node.mNumChildren))
      Visit(*child, model_from_node, path);
  }

  [[nodiscard]] RawScene& result() { return result_; }

 private:
  // Nothing: no triangles.
  std::optional<std::size_t> ShapeOf(std::span<const unsigned> meshes, const std::string& name) {
    const auto [found, is_new] =
        shapes_.try_emplace(std::vector<unsigned>(meshes.begin(), meshes.end()), std::nullopt);
    if (!is_new) return found->second;
    RawShape shape{name, {}};
    for (const unsigned mesh : meshes) Append(*scene_.mMeshes[mesh], shape.mesh);
    if (shape.mesh.triangles.empty()) return std::nullopt;
    found->second = result_.shapes.size();
    result_.shapes.push_back(std::move(shape));
    return found->second;
  }

  void Append(const aiMesh& source, core::TriangleMesh& target) {
    const auto offset = static_cast<std::int32_t>(target.vertices_mm.size());
    target.vertices_mm.reserve(target.vertices_mm.size() + source.mNumVertices);
    for (const aiVector3D& v : std::span(source.mVertices, source.mNumVertices))
      target.vertices_mm.emplace_back(double{v.x}, double{v.y}, double{v.z});
    target.triangles.reserve(target.triangles.size() + source.mNumFaces);
    for (const aiFace& face : std::span(source.mFaces, source.mNumFaces)) {
      if (face.mNumIndices != 3) {
        ++result_.left_out;
        continue;
      }
      const auto corner = [&](unsigned k) { return static_cast<std::int32_t>(face.mIndices[k]) + offset; };
      target.triangles.push_back({corner(0), corner(1), corner(2)});
    }
  }

  void CheckCount() const {
    if (result_.instances.size() <= kMostInstances) return;
    throw Error(
        ErrorKind::kGeometry,
        fmt::format("{}: its nodes make more than {} parts; export a simpler model", where_, kMostInstances));
  }

  const aiScene& scene_;
  std::string where_;
  std::map<std::vector<unsigned>, std::optional<std::size_t>> shapes_;
  RawScene result_;
};

// The unit that the file states. What assimp made of its axes and its unit is undone in `model_from_scene`.
std::optional<FileUnit> TakeUnit(const aiScene& scene, FileFormat format, Eigen::Affine3d& model_from_scene) {
  switch (format) {
    case FileFormat::kGltf:
    case FileFormat::kGlb:
      return UnitOf(core::LengthUnit::kMetre);
    case FileFormat::kCollada: {
      // assimp made the unit a scale on the root.
      const double metres = ToEigen(scene.mRootNode->mTransformation).linear().col(0).norm();
      if (!(metres > 0.0) || !std::isfinite(metres)) return std::nullopt;
      model_from_scene.linear() /= metres;
      model_from_scene.translation() /= metres;
      return UnitOf(1000.0 * metres);
    }
    case FileFormat::kFbx: {
      float centimetres = 1.0F;
      if (scene.mMetaData != nullptr) scene.mMetaData->Get("UnitScaleFactor", centimetres);
      if (!(centimetres > 0.0F) || !std::isfinite(centimetres)) return std::nullopt;
      return UnitOf(10.0 * double{centimetres});
    }
    case FileFormat::k3ds:
      // assimp turned the root to y up.
      model_from_scene = Eigen::Affine3d(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()));
      return std::nullopt;
    default:
      return std::nullopt;
  }
}

// STL, OBJ, PLY and COLLADA from memory, so that what was checked is what is read. The others may have files
// beside them.
const aiScene* Parse(Assimp::Importer& importer, const Source& source) {
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // assimp would make up a shape for cameras, lights and bones in a file that has none.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const unsigned steps = aiProcess_Triangulate;
  const FileFormat format = source.format;
  if (format == FileFormat::kStl || format == FileFormat::kObj || format == FileFormat::kPly ||
      format == FileFormat::kCollada)
    return importer.ReadFileFromMemory(source.bytes.data(), source.bytes.size(), steps,
                                       std::string(ExtensionOf(format)).c_str());
  return importer.ReadFile(source.file.string(), steps);
}

RawScene Load(const Source& source) {
  const fs::path& file = source.file;
  const FileFormat format = source.format;
  ConfinedFiles::Log log;
  const LeftOutLog left_out;
  Assimp::Importer importer;
  importer.SetIOHandler(new ConfinedFiles(source, log));  // the importer deletes it
  const aiScene* scene = nullptr;
  std::string why;
  try {
    scene = Parse(importer, source);
    if (scene == nullptr) why = importer.GetErrorString();
  } catch (const std::exception& exception) {
    why = exception.what();
  }
  if (!log.refused.empty()) throw RefersElsewhere(file, core::Blanked(log.refused.front()));
  if (scene == nullptr && !log.missing.empty()) {
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: it refers to '{}', which can't be opened; put that file there",
                            file.string(), core::Blanked(log.missing.front())));
  }
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw Error(ErrorKind::kFormat, fmt::format("{}: can't be read as {} ({}); export it again",
                                                file.string(), ToString(format), core::Blanked(why)));
  }
  SceneWalk walk(*scene, file.string());
  Eigen::Affine3d model_from_scene = Eigen::Affine3d::Identity();
  const std::optional<FileUnit> unit = TakeUnit(*scene, format, model_from_scene);
  walk.Visit(*scene->mRootNode, model_from_scene, "");
  if (format == FileFormat::kGltf || format == FileFormat::kGlb)
    for (RawInstance& instance : walk.result().instances)
      if (instance.color) std::ranges::transform(*instance.color, instance.color->begin(), SrgbFromLinear);
  walk.result().unit = unit;
  walk.result().referred = std::move(log.opened);
  if (left_out.HasLeftOutFaces())
    walk.result().warnings.emplace_back("faces that name vertices that don't exist were left out");
  return std::move(walk.result());
}

// Reads the shape alone, and warns of faces that the parser lost.
RawScene ReadObj(const fs::path& file, const std::string& text) {
  const PlainObj plain = PlainObjOf(text, file.string());
  RawScene scene = Load({file, FileFormat::kObj, plain.text});
  const std::int64_t triangles = PlacedTriangles(scene);
  if (plain.triangles > triangles)
    scene.warnings.push_back(
        fmt::format("{} triangles of its polygons could not be formed", plain.triangles - triangles));
  return scene;
}

}  // namespace

RawScene ReadScene(const fs::path& file, FileFormat format, std::string bytes) {
  if (format == FileFormat::kCollada || format == FileFormat::kObj) bytes = ToUtf8(std::move(bytes));
  if (format == FileFormat::kObj) return ReadObj(file, bytes);
  const bool has_bad_unit = format == FileFormat::kCollada && MendUnit(&bytes);
  const std::size_t surplus = format == FileFormat::kStl ? BytesAfterTriangles(bytes) : 0;
  bytes.resize(bytes.size() - surplus);
  const bool lacks_padding = format == FileFormat::kGlb && LacksPadding(bytes);
  if (lacks_padding) bytes = Padded(std::move(bytes));
  GltfAsset asset;  // of other formats: none
  if (format == FileFormat::kGltf || format == FileFormat::kGlb)
    asset = AssetOf(format == FileFormat::kGlb ? JsonOf(bytes) : bytes);
  if (format == FileFormat::kGltf && asset.is_version_1) bytes = WithMatrices(bytes, file.string());
  RawScene scene = Load({file, format, bytes, lacks_padding || format == FileFormat::kGltf});
  for (RawShape& shape : scene.shapes)
    shape.deviation = asset.deviation_mm / core::MillimetresPer(core::LengthUnit::kMetre);
  if (surplus > 0)
    scene.warnings.push_back(fmt::format("{} bytes after its last triangle were passed over", surplus));
  if (has_bad_unit) {
    scene.unit.reset();
    scene.warnings.emplace_back("its unit isn't a length and was passed over");
  }
  if (lacks_padding)
    scene.warnings.emplace_back(
        "its chunks don't end on multiples of 4 bytes, as GLB demands; they were read all the same");
  return scene;
}

}  // namespace elbowroom::cad_import
