// How the hull's surface is coloured.
#pragma once

namespace elbowroom::recon {

enum class HullAppearance {
  kFlat,        // one colour, the paper's glove
  kByNormal,    // one colour, shaded by the surface's direction
  kOneCamera,   // from the picture of one camera, worn on the head or near the viewer (the paper's way)
  kRigCameras,  // from the pictures of all the rig's cameras that see the point
};

}  // namespace elbowroom::recon
