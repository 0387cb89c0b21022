// A rig's coverage as a model in space.
#pragma once

#include "app/control/coverage/coverage_job.h"
#include "cad_import/model/cad_model.h"

namespace elbowroom::control {

// In the world's frame: a small cube at every node whose uncertainty is known (of a fine grid, at some of
// them), in one of twelve colours, with the mm in its name; the workspace's edges; a pyramid for each camera,
// open end to where it looks; the next camera; the parts.
[[nodiscard]] cad_import::CadModel CoverageVolume(const CoverageOutcome& outcome);

}  // namespace elbowroom::control
