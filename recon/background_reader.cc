#include "recon/background_reader.h"

#include <fmt/format.h>

#include <atomic>
#include <exception>
#include <thread>

#include "core/bounded_queue.h"
#include "core/error.h"
#include "recon/background.h"
#include "recon/image_source.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;
using core::FrameIndex;

// What the capture threads tell the calling one: frames that were added to the work, and frames done.
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
  const auto source = OpenImageSource(sources.background, camera, stop);
  const auto count = source->frame_count();
  if (!count) {
    throw Error(ErrorKind::kFormat,
                fmt::format("camera '{}': background '{}' must be recorded footage or an image",
                            camera.name(), sources.background));
  }
  const FrameIndex used = std::min<FrameIndex>(*count, BackgroundAccumulator::kMostFrames);
  ticks.Push({used, 0});
  BackgroundAccumulator accumulator;
  for (FrameIndex i = 0; i < used; ++i) {
    core::ThrowIfStopped(stop, "reading the background");
    accumulator.Add(source->Read(i));
    ticks.Push({0, 1});
  }
  return accumulator.Reference();
}

// Until the last thread closes the queue.
void ReportTicks(Ticks& ticks, const core::Progress& progress) {
  FrameIndex total = 0, done = 0;
  while (const auto tick = ticks.Pop()) {
    total += tick->more;
    done += tick->done;
    progress.Report(done, total, "background");
  }
}

}  // namespace

std::vector<BackgroundReference> ReadBackgroundReferences(const RigFile& rig_file,
                                                          const core::Progress& progress,
                                                          std::stop_token stop) {
  const std::size_t n = rig_file.rig.cameras.size();
  core::Require(rig_file.sources.size() == n && n > 0, "a rig file has sources for every camera");
  std::vector<BackgroundReference> references(n);
  std::vector<std::exception_ptr> errors(n);
  constexpr std::size_t kTicksWaiting = 64;
  Ticks ticks(kTicksWaiting, core::WhenFull::kBlock);
  std::atomic<std::size_t> running = n;
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < n; ++i) {
      threads.emplace_back([&, i] {
        try {
          references[i] = ReadOne(rig_file.sources[i], rig_file.rig.cameras[i], ticks, stop);
        } catch (...) {
          errors[i] = std::current_exception();
        }
        if (--running == 0) ticks.Close();
      });
    }
    try {
      ReportTicks(ticks, progress);
    } catch (...) {
      ticks.Close();  // so that no thread waits for room that will not come
      throw;
    }
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return references;
}

}  // namespace elbowroom::recon
