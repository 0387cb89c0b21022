// How far an eye's picture reaches.
#pragma once

namespace elbowroom::recon {

// Tangents of the angles between an eye's axis and the sides of its picture; left and down are negative
// unless the axis lies outside of the picture.
struct EyeTangents {
  double left = -1.0;
  double right = 1.0;
  double up = 1.0;
  double down = -1.0;
};

}  // namespace elbowroom::recon
