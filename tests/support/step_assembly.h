// STEP files of assemblies, written by OpenCASCADE's own writer.
#pragma once

#include <TopoDS_Shape.hxx>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/rigid_transform.h"

namespace elbowroom::test_support {

struct StepBody {
  std::string name;
  TopoDS_Shape shape;  // mm
};

struct StepInstance {
  std::string name;
  std::size_t body = 0;
  core::RigidTransform assembly_from_body;
};

// Each body is written once, and referred to by its instances. Throws: core::Error{kFile} naming the file
// that can't be written.
void WriteStepAssembly(const std::filesystem::path& path, const std::string& name,
                       const std::vector<StepBody>& bodies, const std::vector<StepInstance>& instances);

}  // namespace elbowroom::test_support
