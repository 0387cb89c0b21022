// The camera set-ups that simulations run on. World: origin at the table's centre, table top z = 0, z up.
#pragma once

#include "core/rig.h"

namespace elbowroom::recon {

// The paper's: three cameras (overhead, left of the table, on a diagonal three feet above it), one field of
// 720 x 243, 24 degree lenses without distortion, workspace 5' x 4' x 3'. No point of the workspace is
// further than 3.3 m from a camera, and there a pixel is 5.8 mm high and 2.5 mm wide (the paper's
// "Accuracy"). The paper doesn't say across what its lenses have 24 degrees: we take the height, which gives
// its 5.8 mm.
[[nodiscard]] core::Rig PaperRig();

// Four 640 x 480 cameras, 50 degrees wide, around the table: near overhead, low at the back left (level with
// the rim of a part on the table), level with the hands at the back right, and high in the front. Mild
// distortion.
[[nodiscard]] core::Rig FourCameraRig();

// Eight 1280 x 720 cameras, 60 degrees wide: five near table level all round, two high, one near overhead.
[[nodiscard]] core::Rig EightCameraRig();

}  // namespace elbowroom::recon
