#include "recon/footage/background_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "core/bounded_queue.h"
#include "core/error.h"
#include "recon/footage/background.h"
#include "recon/footage/image_source.h"
#include "recon/footage/per_camera.h"
#include "recon/rig_files/source_location.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;
using core::FrameIndex;

// A report of a reading thread to the calling one: frames that were added to the work, and frames done.
struct Tick {
  FrameIndex more = 0;
  FrameIndex done = 0;
};
using Ticks = core::BoundedQueue<Tick>;

BackgroundReference ReadOne(const CameraSources& sources, const core::CameraModel& camera, Ticks& ticks,
                            const std::stop_token& stop) {
  if (!sources.masks.empty()) return {};
  if (sources.background.empty()) {
    throw Error(ErrorKind::kFormat, fmt::format("camera '{}': the rig names no background to subtract; add a "
                                                "background video or image, or masks",
                                                camera.name()));
  }
  if (IsLive(sources.background)) {
    throw Error(ErrorKind::kFormat,
                fmt::format("camera '{}': background '{}' must be recorded footage or an image",
                            camera.name(), sources.background));
  }
  const auto source = OpenImageSource(sources.background, camera, stop);
  const FrameIndex used = std::min<FrameIndex>(source->frame_count(), BackgroundAccumulator::kMostFrames);
  ticks.Push({used, 0});
  BackgroundAccumulator accumulator;
  for (FrameIndex i = 0; i < used; ++i) {
    core::ThrowIfStopped(stop, "reading the background");
    const std::optional<SourcePicture> picture = source->Read(i, stop);
    if (!picture) break;
    accumulator.Add(picture->image_bgr);
    ticks.Push({0, 1});
  }
  return accumulator.Reference();
}

// Reports until the last thread closes the queue.
void ReportTicks(Ticks& ticks, const core::Progress& progress) {
  FrameIndex total = 0, done = 0;
  while (const auto tick = ticks.Pop()) {
    total += tick->more;
    done += tick->done;
    progress.Report(done, total, "background");
  }
}

// Closes the queue when the last reader ends, or at once when reporting fails, so that no reader waits for
// room then.
class Closer {
 public:
  Closer(Ticks& ticks, std::atomic<std::size_t>& still_needed) : ticks_(ticks), still_needed_(still_needed) {}
  ~Closer() {
    if (--still_needed_ == 0) ticks_.Close();
  }
  Closer(const Closer&) = delete;
  Closer& operator=(const Closer&) = delete;

 private:
  Ticks& ticks_;
  std::atomic<std::size_t>& still_needed_;
};

}  // namespace

std::vector<BackgroundReference> ReadBackgroundReferences(const RigFile& rig_file,
                                                          const core::Progress& progress,
                                                          std::stop_token stop) {
  const std::size_t n = rig_file.rig.cameras.size();
  core::Require(rig_file.sources.size() == n && n > 0, "a rig file has sources for every camera");
  std::vector<BackgroundReference> references(n);
  constexpr std::size_t kTicksWaiting = 64;
  Ticks ticks(kTicksWaiting, core::WhenFull::kBlock);
  std::atomic<std::size_t> readers = n, reporter = 1;
  RunPerCamera(
      n,
      [&](core::CameraIndex i) {
        const Closer closer(ticks, readers);
        references[i] = ReadOne(rig_file.sources[i], rig_file.rig.cameras[i], ticks, stop);
      },
      [&] {
        const Closer closer(ticks, reporter);
        ReportTicks(ticks, progress);
      });
  return references;
}

}  // namespace elbowroom::recon
