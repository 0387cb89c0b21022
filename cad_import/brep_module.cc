#include "cad_import/brep_module.h"

#include "core/module.h"

namespace elbowroom::cad_import {

BrepReader& LoadedBrepReader() {
  static BrepReader& reader =
      core::FunctionOfModule<decltype(ElbowroomBrepReader)>("brep_reader", "ElbowroomBrepReader")();
  return reader;
}

}  // namespace elbowroom::cad_import
