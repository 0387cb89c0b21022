// OpenCASCADE as a module: its 60 libraries take longer to load than a mesh file takes to read.
#pragma once

#include "cad_import/brep_reader.h"

namespace elbowroom::cad_import {

using BrepReader = decltype(ReadBrep);

// ReadBrep, loaded at first. Throws: Error{kFile} if that fails. Thread: any.
[[nodiscard]] BrepReader& LoadedBrepReader();

}  // namespace elbowroom::cad_import

// The module's entry.
extern "C" elbowroom::cad_import::BrepReader& ElbowroomBrepReader();
