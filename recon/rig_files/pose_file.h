// Where a part stands, read from a file.
#pragma once

#include <filesystem>

#include "core/rigid_transform.h"

namespace elbowroom::recon {

// world_from_part from OpenCV FileStorage YAML with `rotation_world_from_part` (3 x 3) and
// `translation_world_from_part_mm` (3 x 1). Other keys are ignored.
// Throws: Error{kFile} (missing, not YAML), Error{kFormat} naming the file and the key: missing, not of that
// shape, not finite, not a rotation to 1e-6.
[[nodiscard]] core::RigidTransform ReadPoseFile(const std::filesystem::path& path);

}  // namespace elbowroom::recon
