// The module of the formats that hold meshes.
#include "cad_import/formats/format_modules.h"

const elbowroom::cad_import::MeshFormats& ElbowroomMeshFormats() {
  using namespace elbowroom::cad_import;
  static constexpr MeshFormats kFormats = {&ReadScene, &ReadThreeMf, &EncodeModel};
  return kFormats;
}
