#include "cad_import/formats/format_modules.h"

#include "core/system/module.h"

namespace elbowroom::cad_import {

BrepReader& LoadedBrepReader() {
  static BrepReader& reader =
      core::FunctionOfModule<decltype(ElbowroomBrepReader)>("brep_reader", "ElbowroomBrepReader")();
  return reader;
}

const MeshFormats& LoadedMeshFormats() {
  static const MeshFormats& formats =
      core::FunctionOfModule<decltype(ElbowroomMeshFormats)>("mesh_formats", "ElbowroomMeshFormats")();
  return formats;
}

}  // namespace elbowroom::cad_import
