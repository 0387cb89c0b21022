#include "cad_import/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <exception>
#include <map>
#include <utility>

#include "cad_import/mesh_format.h"
#include "cad_import/obj_text.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;
using core::LengthUnit;

// Instances are unrolled: a small file can ask for more than memory holds.
constexpr std::size_t kMostTriangles = 100'000'000;
constexpr double kImplausiblySmallMm = 1.0;
constexpr double kImplausiblyLargeMm = 50'000.0;

// A parser's message as part of one line.
std::string OneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  return text;
}

struct SceneParts {
  std::vector<RawPart> parts;  // in the file's unit until scaled
  std::size_t triangles = 0;
  std::int64_t lines_and_points = 0;
};

using Affine = Eigen::Transform<double, 3, Eigen::AffineCompact>;

Affine ToEigen(const aiMatrix4x4& m) {
  Affine result;
  result.matrix() << double{m.a1}, double{m.a2}, double{m.a3}, double{m.a4},  //
      double{m.b1}, double{m.b2}, double{m.b3}, double{m.b4},                 //
      double{m.c1}, double{m.c2}, double{m.c3}, double{m.c4};
  return result;
}

void AppendMesh(const aiMesh& source, const Affine& file_from_node, core::TriangleMesh& target,
                SceneParts& scene) {
  const auto offset = static_cast<std::int32_t>(target.vertices_mm.size());
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    const aiVector3D& v = source.mVertices[i];
    target.vertices_mm.push_back(file_from_node * Eigen::Vector3d(double{v.x}, double{v.y}, double{v.z}));
  }
  const bool mirrors = file_from_node.linear().determinant() < 0.0;
  for (unsigned i = 0; i < source.mNumFaces; ++i) {
    const aiFace& face = source.mFaces[i];
    if (face.mNumIndices != 3) {
      ++scene.lines_and_points;
      continue;
    }
    const auto corner = [&](unsigned k) { return static_cast<std::int32_t>(face.mIndices[k]) + offset; };
    target.triangles.push_back({corner(0), corner(mirrors ? 2 : 1), corner(mirrors ? 1 : 2)});
  }
}

void AppendNode(const aiScene& scene, const aiNode& node, const Affine& file_from_parent,
                const std::string& where, SceneParts& result) {
  const Affine file_from_node = file_from_parent * ToEigen(node.mTransformation);
  RawPart part{node.mName.C_Str(), {}};
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    AppendMesh(*scene.mMeshes[node.mMeshes[i]], file_from_node, part.mesh, result);
  }
  result.triangles += part.mesh.triangles.size();
  if (result.triangles > kMostTriangles) {
    throw Error(ErrorKind::kGeometry,
                fmt::format("{}: more than {} triangles; export a coarser mesh", where, kMostTriangles));
  }
  if (!part.mesh.triangles.empty()) result.parts.push_back(std::move(part));
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    AppendNode(scene, *node.mChildren[i], file_from_node, where, result);
  }
}

// STL, OBJ and PLY from memory, so that what was checked is what is read; glTF and GLB from the disk, since
// their buffers may be files beside them.
const aiScene* Parse(Assimp::Importer& importer, const std::filesystem::path& path, MeshFormat format,
                     const std::string& bytes) {
  if (CarriesUnit(format)) return importer.ReadFile(path.string(), aiProcess_Triangulate);
  const char* hint = format == MeshFormat::kStl ? "stl" : format == MeshFormat::kObj ? "obj" : "ply";
  return importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, hint);
}

// Everything assimp does, so that no exception, log line or type of its own gets out.
SceneParts Load(const std::filesystem::path& path, MeshFormat format, const std::string& bytes) {
  const std::string where = path.string();
  const auto fail = [&](const std::string& why) {
    return Error(ErrorKind::kFormat, fmt::format("{}: can't be read as {} ({}); export it again", where,
                                                 ToString(format), OneLine(why)));
  };
  Assimp::Importer importer;
  const aiScene* scene = nullptr;
  try {
    scene = Parse(importer, path, format, bytes);
  } catch (const std::exception& exception) {
    throw fail(exception.what());
  }
  if (scene == nullptr) throw fail(importer.GetErrorString());
  SceneParts result;
  if (scene->mRootNode != nullptr) AppendNode(*scene, *scene->mRootNode, Affine::Identity(), where, result);
  return result;
}

// As Load, of an OBJ file's shape alone; faces that the parser lost are told.
SceneParts LoadObj(const std::filesystem::path& path, const std::string& bytes,
                   std::vector<std::string>& warnings) {
  const PlainObj plain = PlainObjOf(bytes, path.string());
  SceneParts result = Load(path, MeshFormat::kObj, plain.text);
  const std::int64_t lost = plain.triangles - static_cast<std::int64_t>(result.triangles);
  if (lost > 0) warnings.push_back(fmt::format("{} triangles of its polygons could not be formed", lost));
  return result;
}

std::string SizeText(const Eigen::AlignedBox3d& bounds, double mm_per_unit) {
  const Eigen::Vector3d size_mm = bounds.sizes() * mm_per_unit;
  return fmt::format("{:.4g} x {:.4g} x {:.4g} mm", size_mm.x(), size_mm.y(), size_mm.z());
}

[[noreturn]] void FailWithoutUnit(const SceneParts& scene, MeshFormat format, const std::string& where) {
  Eigen::AlignedBox3d bounds;
  for (const RawPart& part : scene.parts) bounds.extend(core::BoundsOf(part.mesh));
  std::string sizes;
  for (const LengthUnit unit :
       {LengthUnit::kMillimetre, LengthUnit::kCentimetre, LengthUnit::kMetre, LengthUnit::kInch}) {
    sizes += fmt::format("{}{} if in {}", sizes.empty() ? "" : ", ",
                         SizeText(bounds, core::MillimetresPer(unit)), core::ToString(unit));
  }
  throw Error(ErrorKind::kCad,
              fmt::format("{}: {} carries no unit and none was given: its size is {}; pass --unit "
                          "mm|cm|m|in, or `unit` in the layout",
                          where, ToString(format), sizes));
}

// Warns where the caller's word goes against the file's.
LengthUnit UnitOf(const SceneParts& scene, MeshFormat format, const ImportOptions& options,
                  const std::string& where, std::vector<std::string>& warnings) {
  if (CarriesUnit(format)) {
    const LengthUnit unit = options.unit.value_or(LengthUnit::kMetre);
    if (unit != LengthUnit::kMetre) {
      warnings.push_back(fmt::format("{} is in metres by its specification but was read in {}, as asked",
                                     ToString(format), core::ToString(unit)));
    }
    return unit;
  }
  const auto unit = options.unit ? options.unit : options.unit_if_file_has_none;
  if (!unit) FailWithoutUnit(scene, format, where);
  return *unit;
}

void WarnOfSize(const Eigen::AlignedBox3d& bounds_mm, LengthUnit unit, std::vector<std::string>& warnings) {
  const double longest_mm = bounds_mm.sizes().maxCoeff();
  if (longest_mm >= kImplausiblySmallMm && longest_mm <= kImplausiblyLargeMm) return;
  warnings.push_back(fmt::format("its size, {}, is implausible for a payload; is its unit really {}?",
                                 SizeText(bounds_mm, 1.0), core::ToString(unit)));
}

// Every part gets a name of its own: the file's, its stem where it gives none, numbered where it recurs.
void NameParts(std::vector<ImportedPart>& parts, const std::string& file_stem) {
  std::map<std::string, int> uses;
  for (ImportedPart& part : parts) {
    const bool has_name = !part.name.empty() && !part.name.starts_with("<");  // assimp's own: "<STL_BINARY>"
    if (!has_name) part.name = file_stem;
    const int use = ++uses[part.name];
    if (use > 1) part.name += fmt::format(" {}", use);
  }
}

}  // namespace

ImportedMesh ImportMeshFile(const std::filesystem::path& path, const ImportOptions& options) {
  const std::string where = path.string();
  const auto [format, bytes] = ReadCheckedFile(path);
  ImportedMesh result;
  ImportReport& report = result.report;
  SceneParts scene =
      format == MeshFormat::kObj ? LoadObj(path, bytes, report.warnings) : Load(path, format, bytes);
  for (const RawPart& part : scene.parts) core::ValidateMesh(part.mesh, where);
  if (scene.parts.empty()) core::ValidateMesh({}, where);

  report.unit = UnitOf(scene, format, options, where, report.warnings);
  for (RawPart& part : scene.parts) {
    for (Eigen::Vector3d& vertex : part.mesh.vertices_mm) vertex *= core::MillimetresPer(report.unit);
  }
  CleanMesh clean = CleanParts(std::move(scene.parts), where);
  result.mesh = std::move(clean.mesh);
  result.parts = std::move(clean.parts);
  NameParts(result.parts, path.stem().string());

  report.parts = static_cast<int>(result.parts.size());
  report.triangles = static_cast<std::int64_t>(result.mesh.triangles.size());
  report.bounds_mm = core::BoundsOf(result.mesh);
  report.watertight = clean.watertight;
  report.repaired = clean.repaired;
  report.dropped_triangles = clean.dropped_triangles;
  report.warnings.insert(report.warnings.end(), clean.warnings.begin(), clean.warnings.end());
  if (scene.lines_and_points > 0) {
    report.warnings.push_back(fmt::format("{} lines and points were left out", scene.lines_and_points));
  }
  WarnOfSize(report.bounds_mm, report.unit, report.warnings);
  return result;
}

}  // namespace elbowroom::cad_import
