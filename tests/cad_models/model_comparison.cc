#include "tests/cad_models/model_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace elbowroom::cad_models {
namespace {

// Of the size: files hold decimal numbers, readers single precision, and nodes are placed one upon another.
constexpr double kSinglePrecision = 1e-5;
// Beyond what the tessellation explains: DRAW integrates to 1e-6 of a face's own size.
constexpr double kVolumeShare = 1e-3;

struct Known {
  std::string_view ending;  // of the name
  std::string_view reason;
};
constexpr std::array<Known, 24> kKnown = {{
    {"3DS/CameraRollAnimWithChildObject.3ds",
     "it moves; ours stands where its animation begins, VTK's where the corners were saved"},
    {"3DS/RotatingCube.3DS",
     "it moves; ours stands where its animation begins, VTK's where the corners were saved"},
    {"Collada/box_nested_animation.dae", "its body is under a skin, which pycollada doesn't give as a body"},
    {"OBJ/box_UTF16BE.obj", "UTF-16, which neither VTK nor Blender reads in an OBJ"},
    {"OBJ/number_formats.obj", "the corners of its one triangle are on a line"},
    {"iges/hammer.iges", "38 m across at a tolerance of 0.2 mm; with --tolerance 20 it takes seconds"},
    {"occ/Axis_of_bearing.brep", "one of its solids has no faces; ours leaves it out and says so"},
    {"occ/asahi.brep", "wires alone, no faces"},
    {"occ/edge.brep", "an edge alone, no faces"},
    {"occ/hammer.brep", "38 m across at a tolerance of 0.2 mm; with --tolerance 20 it takes seconds"},
    {"occ/terrain.brep",
     "8 m across at a tolerance of 0.2 mm: 3.3 GB and more than two minutes on a busy machine"},
    {"trimesh_models/metadata.ply",
     "a property after the list of a face's corners; VTK crashes, Blender gives up"},
    {"glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb",
     "corners at infinity; Blender puts them at 0"},
    {"glTF2/IncorrectVertexArrays/Cube.gltf", "it declares more data than its buffer has"},
    {"glTF2/IndexOutOfRange/IndexOutOfRange.gltf",
     "one face names a corner that doesn't exist; ours leaves it out and says so"},
    {"glTF2/draco/2CylinderEngine.gltf",
     "Draco, which neither VTK nor Blender has here; its size is that of its GLB twin"},
    {"glTF2/issue_3269/texcoord_crash.gltf",
     "texture coordinates numbered from 1, against the specification; assimp goes by it"},
    {"wrongTypes/badExtension.gltf",
     "an extension of the wrong type, on a material; assimp refuses the whole"},
    {"wrongTypes/badNumber.gltf", "a number that is none, on a material; assimp refuses the whole"},
    {"wrongTypes/badObject.gltf", "an object that is none, on a material; assimp refuses the whole"},
    {"wrongTypes/badString.gltf", "a text that is none, on a material; assimp refuses the whole"},
    {"wrongTypes/badUint.gltf", "an index that is none, on a material; assimp refuses the whole"},
}};

bool AreSizesEqual(const OurAnswer& ours, const TheirAnswer& theirs) {
  const double most_mm = kSinglePrecision * theirs.size_mm.maxCoeff() + 2.0 * ours.deviation_mm;
  return (ours.size_mm - theirs.size_mm).cwiseAbs().maxCoeff() <= most_mm;
}

bool ArePartsEqual(const OurAnswer& ours, const TheirAnswer& theirs) {
  if (theirs.nodes == 0) return true;  // faces without a body
  return ours.parts == theirs.nodes || (ours.instances == 1 && ours.parts == theirs.pieces);
}

bool AreVolumesEqual(const OurAnswer& ours, const TheirAnswer& theirs) {
  if (!theirs.volume_mm3 || !ours.watertight) return true;
  const double most_mm3 = ours.area_mm2 * ours.deviation_mm + kVolumeShare * std::abs(*theirs.volume_mm3);
  return std::abs(ours.volume_mm3 - *theirs.volume_mm3) <= most_mm3;
}

}  // namespace

std::vector<std::string> DifferencesOf(cad_import::FileFormat format, const OurAnswer& ours,
                                       const TheirAnswer& theirs) {
  std::vector<std::string> differences;
  if (!AreSizesEqual(ours, theirs)) differences.emplace_back("size");
  if (!ArePartsEqual(ours, theirs)) differences.emplace_back("parts");
  if (!cad_import::IsBoundaryRepresentation(format) && theirs.triangles &&
      ours.triangles + ours.dropped_triangles != *theirs.triangles)
    differences.emplace_back("triangles");
  if (!AreVolumesEqual(ours, theirs)) differences.emplace_back("volume");
  return differences;
}

std::string ReasonFor(const std::string& name) {
  const auto found =
      std::ranges::find_if(kKnown, [&](const Known& known) { return name.ends_with(known.ending); });
  return found == kKnown.end() ? "" : std::string(found->reason);
}

}  // namespace elbowroom::cad_models
