// Cameras are joined to a rig by the boards that they see together.
#pragma once

#include "core/progress.h"
#include "recon/calibration/rig_state.h"

namespace elbowroom::recon {

// Finds poses of all cameras and sets, and which views are numbered from the board's other end. Views whose
// points fit no pose of the board, or that don't agree with their set, aren't used.
//
// For two cameras each shared set gives up to four relative poses (eight for boards that look the same after
// half a turn); the one with which the most sets agree is taken, all being tried. A maximum spanning tree by
// the number of agreeing sets joins the cameras. Each set's board then takes the candidate pose with which
// the most of its views agree.
//
// The rig's frame is the world. Throws: Error{kCamera} naming cameras that don't join, and the view that
// would join them; a world that no view decides; Error{kCancelled}.
void StartRig(const std::stop_token& stop, RigState* state);

}  // namespace elbowroom::recon
