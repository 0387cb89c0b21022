// Whether two readers agree about a file, and where they don't, why.
#pragma once

#include <string>
#include <vector>

#include "cad_import/formats/file_format.h"
#include "tests/cad_models/model_answers.h"

namespace elbowroom::cad_models {

// What differs: "size", "parts", "triangles", "volume"; nothing: they agree. Both have read it. Sizes of
// meshes may differ by what single precision loses; those of faces by the tolerance at either end. Parts: the
// nodes of files that have several, else connected pieces. Triangles: before healing.
[[nodiscard]] std::vector<std::string> DifferencesOf(cad_import::FileFormat format, const OurAnswer& ours,
                                                     const TheirAnswer& theirs);

// Why they legitimately differ, as people found out; empty: nobody has.
[[nodiscard]] std::string ReasonFor(const std::string& name);

}  // namespace elbowroom::cad_models
