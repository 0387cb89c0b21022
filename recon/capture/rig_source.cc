#include "recon/capture/rig_source.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "core/error.h"
#include "recon/footage/recorded_rig.h"
#include "recon/rig_files/source_location.h"

namespace elbowroom::recon {

bool IsLiveRig(const RigFile& rig_file) {
  std::optional<core::CameraIndex> live, recorded;
  for (core::CameraIndex i = 0; i < rig_file.sources.size(); ++i) {
    const CameraSources& sources = rig_file.sources[i];
    const bool is_live = sources.masks.empty() && IsLive(sources.frames);
    (is_live ? live : recorded) = i;
  }
  if (live && recorded) {
    throw core::Error(
        core::ErrorKind::kFormat,
        fmt::format(
            "camera '{}' is live and camera '{}' is recorded; their pictures don't belong together: use "
            "live cameras only, or recordings only",
            rig_file.rig.cameras[*live].name(), rig_file.rig.cameras[*recorded].name()));
  }
  return live.has_value();
}

std::shared_ptr<FrameSetSource> OpenRig(RigFile rig_file, const std::stop_token& stop, LiveTaps taps) {
  if (IsLiveRig(rig_file)) return std::make_shared<LiveRig>(std::move(rig_file), std::move(taps), stop);
  return std::make_shared<RecordedRig>(std::move(rig_file), stop);
}

}  // namespace elbowroom::recon
