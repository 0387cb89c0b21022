// What a head tracker gave over some time: for setting it up without a window.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/head/head_pose_holder.h"
#include "app/control/head/head_settings.h"
#include "app/control/head/headset_watch.h"
#include "recon/footage/frame_set.h"

namespace elbowroom::control {

struct HeadReport {
  double seconds = 0.0;  // that were watched
  HeadCounts counts;
  std::optional<recon::HeadPose> last;
  // Over the accepted poses: the spread of the eyes' place about its mean, RMS. Of a head that holds still it
  // is the tracker's noise. Nothing: fewer than two.
  std::optional<double> spread_mm;
  // Of a cap: what kept it from being found, how often, in words; the median of sigma and of the number of
  // cameras.
  std::map<std::string, int> not_seen;
  std::optional<double> sigma_mm;
  std::optional<double> sigma_rad;
  std::optional<double> cameras;
  std::optional<HeadsetStatus> headset;  // of openxr

  [[nodiscard]] double poses_per_s() const;
};

using OnHeadReport = std::function<void(const HeadReport&)>;  // so far; a few times a second

// Listens to the packets of settings.source, opentrack or freed, or follows the headset of openxr, for so
// long or until `stop`; or until it is clear that there is no headset. `on_port` is told the port once it is
// open. Throws: as HeadTracker; PreconditionError for another source.
[[nodiscard]] HeadReport WatchPackets(const HeadSettings& settings, double seconds,
                                      const std::function<void(int port)>& on_port,
                                      const OnHeadReport& on_report, const std::stop_token& stop);

// Looks for the cap in every frame set of `source`, for so long of its own time, to its end or until `stop`.
// A recorded pose is taken as it is found, without HeadPoseHolder's rules about time. Throws: what reading
// throws; CapWatch.
[[nodiscard]] HeadReport WatchCap(const HeadSettings& settings, recon::FrameSetSource& source, double seconds,
                                  const OnHeadReport& on_report, const std::stop_token& stop);

// "x 12, y -600, z 402 mm; looks 10 degrees right, 5 down; tilted 2 degrees to the right shoulder", in world:
// a head with no turn looks along y.
[[nodiscard]] std::string HeadText(const core::RigidTransform& world_from_head);

}  // namespace elbowroom::control
