#include "app/control/benchmarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <memory>

#include "core/error.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "recon/segmentation/frame_segmenter.h"
#include "recon/synthetic/synthetic_rig.h"
#include "recon/synthetic/view_scene.h"

namespace elbowroom::control {
namespace {

struct NamedRig {
  const char* what;
  recon::ViewSceneRig rig;
};
constexpr std::array<NamedRig, 3> kViewRigs = {
    {{"3 cameras of 640 x 480", recon::ViewSceneRig::kThree},
     {"the paper's 3 cameras of 720 x 243", recon::ViewSceneRig::kPaper},
     {"8 cameras of 1280 x 720", recon::ViewSceneRig::kEight}}};

struct Job {
  std::string what;
  std::function<void()> run;
};

// The input of a frame: masks in memory, and what depends on the calibration alone.
struct MaskedScene {
  explicit MaskedScene(const recon::ViewScene& scene)
      : rig(std::make_shared<const core::Rig>(scene.rig)),
        planes(recon::MakeUndistortedPlanes(*rig)),
        view(scene.view),
        masks(recon::TrueMasks(*rig, scene.objects)) {}

  [[nodiscard]] recon::VisualHull Hull() const { return recon::MakeVisualHull(rig, planes, masks); }

  std::shared_ptr<const core::Rig> rig;
  recon::UndistortedPlanes planes;
  recon::ViewRays view;
  std::vector<core::SoftMask> masks;
};

// Masks in memory to the depth of a 640 x 480 view.
std::vector<Job> ViewJobs() {
  std::vector<Job> jobs;
  for (const NamedRig& named : kViewRigs) {
    jobs.push_back({named.what, [scene = MaskedScene(recon::MakeViewScene(named.rig))] {
                      (void)recon::ViewHull(scene.Hull(), scene.view, {.surfaces = false, .normals = false});
                    }});
  }
  return jobs;
}

// Frames in memory to masks.
std::vector<Job> SegmentationJobs() {
  const recon::ViewScene scene = recon::MakeViewScene(recon::ViewSceneRig::kFour);
  recon::SyntheticRig rig(scene.rig, [objects = scene.objects](double) { return objects; });
  auto segmenter = std::make_shared<const recon::FrameSegmenter>(rig.ReadBackgrounds({}, {}),
                                                                 recon::SegmentationOptions{}, rig.rig());
  const recon::FrameSet frames = rig.Read(0);
  return {{"4 cameras of 640 x 480, detected", [=] { (void)segmenter->Segment(frames); }},
          {"the same, bounded between pixels", [=] { (void)segmenter->SegmentSoft(frames); }}};
}

// Masks in memory to the hull's mesh.
std::vector<Job> HullJobs() {
  const auto scene = std::make_shared<const MaskedScene>(recon::MakeViewScene(recon::ViewSceneRig::kFour));
  std::vector<Job> jobs;
  for (const double edge_mm : {4.0, 2.0}) {
    jobs.push_back({fmt::format("4 cameras, edges of {:.0f} mm", edge_mm),
                    [scene, edge_mm] { (void)recon::MeshHull(scene->Hull(), edge_mm); }});
  }
  return jobs;
}

BenchmarkTiming Time(const Job& job, const core::Progress& progress, const std::stop_token& stop) {
  job.run();
  std::vector<double> times_ms;
  while (times_ms.size() < kBenchmarkRepetitions) {
    core::ThrowIfStopped(stop, "benchmark");
    const auto begin = std::chrono::steady_clock::now();
    job.run();
    times_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    progress.Report(static_cast<std::int64_t>(times_ms.size()), kBenchmarkRepetitions, job.what + ", run");
  }
  std::ranges::sort(times_ms);
  return {job.what, times_ms[times_ms.size() / 2], times_ms.front(), static_cast<int>(times_ms.size())};
}

struct NamedJobs {
  BenchmarkKind kind;
  std::vector<Job> (*make)();
};
// A new benchmark takes one line here, and one in kKinds.
constexpr std::array<NamedJobs, 3> kJobs = {{{{"view", "masks to the depth of a 640 x 480 view"}, ViewJobs},
                                             {{"segmentation", "frames to masks"}, SegmentationJobs},
                                             {{"hull", "masks to a closed mesh"}, HullJobs}}};
constexpr std::array<BenchmarkKind, 3> kKinds = {kJobs[0].kind, kJobs[1].kind, kJobs[2].kind};

}  // namespace

std::span<const BenchmarkKind> Benchmarks() { return kKinds; }

std::vector<BenchmarkTiming> RunBenchmark(std::string_view name, const core::Progress& progress,
                                          std::stop_token stop) {
  const auto found = std::ranges::find(kJobs, name, [](const NamedJobs& named) { return named.kind.name; });
  if (found == kJobs.end()) {
    std::string names;
    for (const BenchmarkKind& kind : kKinds)
      names += fmt::format("{}{}", names.empty() ? "" : ", ", kind.name);
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("there is no benchmark '{}'; there are: {}", name, names));
  }
  std::vector<BenchmarkTiming> timings;
  for (const Job& job : found->make()) {
    core::ThrowIfStopped(stop, "benchmark");
    timings.push_back(Time(job, progress, stop));
  }
  return timings;
}

}  // namespace elbowroom::control
