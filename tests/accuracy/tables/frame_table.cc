// docs/performance.md, "frames": whole frames of the demo, pictures in memory, stage by stage.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>

#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"
#include "app/control/scene_composer.h"
#include "app/control/trial_rules.h"
#include "core/error.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "tests/accuracy/measurements.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

using Clock = std::chrono::steady_clock;

// Pictures that are kept to be played over and over.
constexpr core::FrameIndex kFramesKept = 360;
constexpr int kEmptyFrames = 30;

// One frame's times, ms.
struct FrameTimes {
  double segmentation = 0.0, contours = 0.0, contacts = 0.0, view = 0.0;
  double whole = 0.0;  // the last two side by side
};

std::vector<recon::FrameSet> Kept(recon::FrameSetSource* source, core::FrameIndex count) {
  std::vector<recon::FrameSet> frames;
  for (core::FrameIndex i = 0; i < count; ++i) frames.push_back(source->Read(i));
  return frames;
}

// A pipeline and the operator's view, which is kept as long as the hull is.
class Player {
 public:
  explicit Player(const control::TrialSetup& setup)
      : pipeline_(setup.source->rig(), setup.layout, setup.source->ReadBackgrounds({}, {}),
                  setup.segmentation,
                  control::ReviewOptionsOf(setup.info, setup.source->rig(), setup.rig_quality)) {
    for (const core::Spacing& spacing : setup.layout.spacings) spacing_mm_.push_back(spacing.initial_mm);
  }

  FrameTimes Play(const recon::FrameSet& frames) {
    double view_ms = 0.0;
    const auto see = [&](const std::shared_ptr<const recon::VisualHull>& hull) {
      const auto begin = Clock::now();
      if (rays_ && hull != hull_)
        view_ = recon::ViewHull(*hull, *rays_, {.surfaces = false}, std::move(view_));
      hull_ = hull;
      view_ms = Ms(begin);
    };
    const auto begin = Clock::now();
    const control::SharedFrameResult result = pipeline_.Process(frames, spacing_mm_, see);
    const double whole_ms = Ms(begin);
    if (!rays_) {
      const recon::OrbitCamera camera = control::OverviewCamera(*result, 640, 480);
      rays_.emplace(recon::CameraOf(recon::ViewFrom(camera, 640, 480)));
    }
    hit_pixels_ += view_.hit_pixels;
    const control::StageTimes& times = result->times;
    return {times.segmentation_ms, times.hull_ms, times.contacts_ms, view_ms, whole_ms};
  }

  [[nodiscard]] std::int64_t hit_pixels() const { return hit_pixels_; }

 private:
  static double Ms(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  }

  control::FramePipeline pipeline_;
  std::vector<double> spacing_mm_;
  std::optional<recon::ViewRays> rays_;
  std::shared_ptr<const recon::VisualHull> hull_;
  recon::HullView view_;
  std::int64_t hit_pixels_ = 0;
};

template <typename Part>
double PartQuantile(const std::vector<FrameTimes>& times, double share, const Part& part) {
  std::vector<double> values;
  for (const FrameTimes& frame : times) values.push_back(part(frame));
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

std::vector<std::string> RowOf(const std::string& what, const std::vector<FrameTimes>& times) {
  const auto median = [&](auto part) { return fmt::format("{:.2f}", PartQuantile(times, 0.5, part)); };
  const auto whole = [](const FrameTimes& t) { return t.whole; };
  return {what,
          fmt::format("{}", times.size()),
          median([](const FrameTimes& t) { return t.segmentation; }),
          median([](const FrameTimes& t) { return t.contours; }),
          median([](const FrameTimes& t) { return t.contacts; }),
          median([](const FrameTimes& t) { return t.view; }),
          median(whole),
          fmt::format("{:.2f}", PartQuantile(times, 0.99, whole)),
          fmt::format("{:.2f}", PartQuantile(times, 1.0, whole))};
}

std::vector<FrameTimes> PlayAll(Player* player, const std::vector<recon::FrameSet>& frames, int count) {
  std::vector<FrameTimes> times;
  for (int i = 0; i < count; ++i) {
    recon::FrameSet next = frames[static_cast<std::size_t>(i) % frames.size()];
    next.index = i;
    times.push_back(player->Play(next));
  }
  return times;
}

// The least that can be done with pictures in memory: every byte is read once, in order, a strip a task.
std::vector<FrameTimes> ReadAll(const std::vector<recon::FrameSet>& frames, int count) {
  constexpr std::size_t kStrips = 4;  // a picture
  std::vector<FrameTimes> times;
  std::atomic<std::uint64_t> found{0};  // so that nothing is left out
  for (int i = 0; i < count; ++i) {
    const std::vector<recon::CameraFrame>& cameras =
        frames[static_cast<std::size_t>(i) % frames.size()].cameras;
    const auto begin = Clock::now();
    tbb::parallel_for(std::size_t{0}, cameras.size() * kStrips, [&](std::size_t strip) {
      const cv::Mat& image = cameras[strip / kStrips].image_bgr;
      const std::size_t words = image.total() * image.elemSize() / sizeof(std::uint64_t) / kStrips;
      const auto* first = image.ptr<std::uint64_t>() + strip % kStrips * words;
      found |= std::accumulate(first, first + words, std::uint64_t{0}, std::bit_or<>());
    });
    times.push_back({.whole = std::chrono::duration<double, std::milli>(Clock::now() - begin).count()});
  }
  core::Require(found != 0, "pictures aren't black");
  return times;
}

}  // namespace

void MeasureFrames(const std::filesystem::path& docs, int count) {
  core::Require(count > 0, "at least one frame");
  const control::TrialSetup setup = control::MakeDemoTrial(control::DemoPlay::kForever);
  fmt::print(stderr, "frames: drawing {} of them\n", kFramesKept);
  const std::vector<recon::FrameSet> frames = Kept(setup.source.get(), kFramesKept);
  recon::SyntheticRig nothing(recon::FourCameraRig(),
                              [](double) { return std::vector<recon::SyntheticObject>(); });
  const std::vector<recon::FrameSet> empty = Kept(&nothing, kEmptyFrames);
  const std::vector<recon::FrameSet> still{frames[kFramesKept / 2]};
  reporting::Table table{{"scene", "frames", "masks, ms", "contours, ms", "contacts and clearance, ms",
                          "view, ms", "whole frame, ms", "99 %, ms", "longest, ms"},
                         {}};
  for (const int threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    const std::string on_threads = fmt::format("{} thread{}", threads, threads > 1 ? "s" : "");
    const auto play = [&](const std::string& what, const std::vector<recon::FrameSet>& shown, int played) {
      fmt::print(stderr, "frames: {}, {}\n", what, on_threads);
      Player player(setup);
      (void)PlayAll(&player, shown, 20);
      table.rows.push_back(RowOf(what + ", " + on_threads, PlayAll(&player, shown, played)));
    };
    play("the demo's motion", frames, count);
    play("the same pictures again", still, std::max(count / 10, 1));
    play("an empty table, with noise", empty, std::max(count / 10, 1));
    table.rows.push_back(RowOf(fmt::format("nothing but reading these pictures, {}", on_threads),
                               ReadAll(empty, std::max(count / 10, 1))));
  }
  reporting::WriteSection(
      docs / "performance.md", "frames",
      reporting::ToMarkdown(table) + "\n" + reporting::ToLine(reporting::ThisMachine(docs / "..")));
}

}  // namespace elbowroom::accuracy
