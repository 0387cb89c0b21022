// What to do about a camera that doesn't do well.
#pragma once

#include "app/control/cameras/camera_check.h"

namespace elbowroom::control {

// Fills the advice of each camera from what was measured, the most urgent first.
void AddAdvice(RigHealth* health);

}  // namespace elbowroom::control
