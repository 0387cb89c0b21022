#include "cad_import/formats/malformed_file.h"

#include <fmt/format.h>

#include "core/error.h"

namespace elbowroom::cad_import {

void FailAsMalformed(const std::string& where, const std::string& what) {
  throw core::Error(core::ErrorKind::kFormat, fmt::format("{}: {}", where, what));
}

void FailUntilExportedAgain(const std::string& where, const std::string& what) {
  FailAsMalformed(where, what + "; export it again");
}

}  // namespace elbowroom::cad_import
