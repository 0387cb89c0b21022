// The readers and writers of other programs' formats, as modules: their libraries take longer to load than a
// model takes to come from the cache, and no file needs all of them.
#pragma once

#include "cad_import/formats/brep_reader.h"
#include "cad_import/formats/mesh_writer.h"
#include "cad_import/formats/scene_reader.h"
#include "cad_import/formats/three_mf_reader.h"

namespace elbowroom::cad_import {

using BrepReader = decltype(ReadBrep);
struct MeshFormats {
  decltype(&ReadScene) read_scene;
  decltype(&ReadThreeMf) read_three_mf;
  decltype(&EncodeModel) encode;
};

// Both load their module at the first call. Throw: Error{kFile} if that fails. Thread: any.
[[nodiscard]] BrepReader& LoadedBrepReader();
[[nodiscard]] const MeshFormats& LoadedMeshFormats();

}  // namespace elbowroom::cad_import

// The modules' entries.
extern "C" elbowroom::cad_import::BrepReader& ElbowroomBrepReader();
extern "C" const elbowroom::cad_import::MeshFormats& ElbowroomMeshFormats();
