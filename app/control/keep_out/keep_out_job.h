// The volume that real things took in sessions: what CAD must leave free.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/trial_runner.h"
#include "core/progress.h"
#include "recon/swept_volume/swept_volume.h"

namespace elbowroom::control {

struct KeepOutRequest {
  std::vector<std::filesystem::path> sessions;  // at least one; all have one world frame
  double edge_mm = 5.0;                         // > 0
  std::optional<std::string> tool;              // only frames in which it was marked in use
  FrameRange frames;                            // only these, of each session
};

struct KeepOut {
  recon::SweptMesh swept;
  double bound_mm = 0.0;  // SweptVolume::BoundMm
  double seconds = 0.0;   // of all frames that were taken in
  std::int64_t sessions = 0;
  std::int64_t frames = 0;                 // taken in
  std::int64_t frames_without_camera = 0;  // left out: a picture is missing, so the hull is larger
  std::int64_t hulls = 0;  // of the frames: those whose silhouettes differ from the frame's before
  recon::SweptWork work;
  std::int64_t bytes = 0;  // of memory for cells, at most
};

// The union of the hulls of all frames that the request names, over the workspaces of all sessions. A hull
// stands until the next frame; that of a session's last frame for the mean time between frames. Frames
// without a picture of each camera are left out. Reads a session's frames one after the other; memory grows
// with the volume's surface, not with the sessions. Throws: core::Error{kRange}: no frame is left, a tool
// that no session knows, too short an edge (SweptVolume); core::Error{kGeometry}: nothing real in any frame;
// what SessionReader throws; Error{kCancelled}.
[[nodiscard]] KeepOut FindKeepOut(const KeepOutRequest& request, const core::Progress& progress,
                                  const std::stop_token& stop);

}  // namespace elbowroom::control
