// The names of visual_hull.h for headers that hand a hull on and don't ask it.
#pragma once

namespace elbowroom::recon {

class VisualHull;
struct UndecidedCameras;

}  // namespace elbowroom::recon
