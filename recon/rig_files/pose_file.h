// Where a part stands, read from a file.
#pragma once

#include <filesystem>

#include "core/rigid_transform.h"

namespace elbowroom::recon {

// world_from_part from OpenCV FileStorage YAML with `rotation_world_from_part` (3 x 3) and
// `translation_world_from_part_mm` (3 x 1). Other keys are ignored. Throws: Error{kFile} if it can't be read;
// Error{kFormat} naming the file if it isn't YAML, or naming the key, too, if that is missing, not of that
// shape, not finite, not a rotation to 1e-6, or a translation of more than core::kLongestLengthMm along an
// axis.
[[nodiscard]] core::RigidTransform ReadPoseFile(const std::filesystem::path& path);

}  // namespace elbowroom::recon
