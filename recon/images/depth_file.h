// Encodes depth maps as files.
#pragma once

#include <string>

#include "recon/images/depth_map.h"

namespace elbowroom::recon {

// TIFF, one channel of 32-bit floats: mm along the camera's z axis, 0 where nothing is; every float reads
// back exactly. Throws: PreconditionError when the map is empty or its floats don't match its size;
// Error{kFile} as EncodePicture.
[[nodiscard]] std::string EncodeDepthTiff(const DepthMap& picture);

}  // namespace elbowroom::recon
