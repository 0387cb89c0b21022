// A number and a colour at each vertex of a mesh.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cad_import/model/cad_model.h"

namespace elbowroom::cad_import {

struct VertexField {
  std::string name;              // with its unit, as `dwell_s`: lower case, digits, '_'
  std::vector<double> values;    // one a vertex
  std::vector<ColorRgb> colors;  // likewise
  std::vector<std::pair<std::string, std::string>> notes;  // what the file says of itself; one line each
};

}  // namespace elbowroom::cad_import
