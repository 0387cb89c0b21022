// Finds includes of rooms that aren't linked.
#pragma once

#include <filesystem>
#include <vector>

#include "tests/architecture/layer_checker.h"

namespace elbowroom::architecture {

// What a room's sources and their headers include of other rooms must be among its USES or HIDES, or the USES
// of these. Otherwise a program links only as long as something else brings the room along. In the order of
// the files. Throws: core::Error{kFile} when a file can't be read.
[[nodiscard]] std::vector<Violation> CheckLinks(const std::filesystem::path& root);

}  // namespace elbowroom::architecture
