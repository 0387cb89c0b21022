// docs/performance.md, "pictures".
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/scene_composer.h"
#include "app/control/stopwatch.h"
#include "app/control/trial_runner.h"
#include "core/units.h"
#include "recon/gl/scene/scene_renderer.h"
#include "tests/accuracy/measurements.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::accuracy {
namespace {

namespace fs = std::filesystem;
namespace gl = recon::gl;

constexpr core::FrameIndex kFrames = 240;

// The demo's motion, judged.
std::vector<control::SharedFrameResult> JudgedDemo() {
  const test_support::TemporaryFolder folder;
  std::vector<control::SharedFrameResult> results;
  control::TrialOptions options;
  options.session = folder.path() / "s.db";
  options.frames = {0, kFrames};
  options.on_frame = [&](const control::SharedFrameResult& result, const control::RecordedFrames&) {
    results.push_back(result);
  };
  control::TrialControls controls;
  (void)control::RunTrial(control::MakeDemoTrial(control::DemoPlay::kOnce), options, controls, {});
  return results;
}

struct PictureCase {
  std::string what;
  gl::Smoothness smoothness = gl::Smoothness::kOneSample;
  gl::StillThings still_things = gl::StillThings::kKept;
  bool turns = false;  // the eye, by half a degree a picture
  bool moves = false;  // a gap, to and fro by 10 mm, each half second
};

// The same motion, with the gap elsewhere each half second: what a picture shows of it. Verdicts stay.
std::vector<control::SharedFrameResult> WithMovedGap(const std::vector<control::SharedFrameResult>& results) {
  constexpr std::size_t kHalfSecond = 15;
  constexpr double kStepMm = 10.0;
  std::vector<double> gaps_mm = results.front()->layout->InitialSpacings();
  std::vector<control::SharedFrameResult> moved;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (i > 0 && i % kHalfSecond == 0) gaps_mm[0] += i / kHalfSecond % 2 == 1 ? kStepMm : -kStepMm;
    auto result = std::make_shared<control::FrameResult>(*results[i]);
    result->world_from_parts = core::PosesAt(*result->layout, gaps_mm);
    moved.push_back(std::move(result));
  }
  return moved;
}

struct PictureTimes {
  std::vector<double> composing_ms, drawing_ms, processor_ms;
  std::int64_t differing = 0, channels = 0;  // by more than 2 of 255 from the picture drawn anew
  int largest_difference = 0;
  gl::StillCount still;
  gl::SquareCount squares;
};

double At(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void Compare(const recon::Image& a, const recon::Image& b, PictureTimes* times) {
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const int by = std::abs(int{a.rgb[i]} - int{b.rgb[i]});
    times->largest_difference = std::max(times->largest_difference, by);
    times->differing += by > 2 ? 1 : 0;
  }
  times->channels += static_cast<std::int64_t>(a.rgb.size());
}

PictureTimes Draw(const std::vector<control::SharedFrameResult>& results, const PictureCase& of_case,
                  int width_px, int height_px) {
  PictureTimes times;
  control::SceneComposer composer;
  gl::SceneRenderer renderer(gl::PartDetail::kWhole, of_case.still_things);
  gl::SceneRenderer anew(gl::PartDetail::kWhole, gl::StillThings::kDrawnAnew);
  recon::OrbitCamera camera = control::OverviewCamera(*results.front(), width_px, height_px);
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (of_case.turns) camera.azimuth_rad += core::RadiansFromDegrees(0.5);
    control::Stopwatch clock;
    gl::Scene scene = composer.Compose(*results[i], recon::ViewFrom(camera, width_px, height_px));
    scene.smoothness = of_case.smoothness;
    const double composing_ms = clock.LapMs();
    const std::clock_t begin = std::clock();
    const recon::Image picture = renderer.Render(scene);
    const double processor_ms = 1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    const double drawing_ms = clock.LapMs();
    if (i == 0) continue;  // shaders are compiled
    times.composing_ms.push_back(composing_ms);
    times.drawing_ms.push_back(drawing_ms);
    times.processor_ms.push_back(processor_ms);
    if (i % 16 == 0) Compare(picture, anew.Render(scene), &times);
  }
  times.still = renderer.still_count();
  times.squares = renderer.square_count();
  return times;
}

std::string LeftShare(const gl::SquareCount& squares) {
  const std::int64_t all = squares.drawn + squares.left;
  return all == 0
             ? "–"
             : fmt::format("{:.0f} %", 100.0 * static_cast<double>(squares.left) / static_cast<double>(all));
}

}  // namespace

void MeasurePictures(const fs::path& docs) {
  const std::vector<control::SharedFrameResult> results = JudgedDemo();
  const std::vector<PictureCase> cases = {
      {"one sample, what stays is kept"},
      {"one sample, a gap moves twice a second", gl::Smoothness::kOneSample, gl::StillThings::kKept, false,
       true},
      {"one sample, the eye turns", gl::Smoothness::kOneSample, gl::StillThings::kKept, true},
      {"one sample, all drawn anew", gl::Smoothness::kOneSample, gl::StillThings::kDrawnAnew},
      {"one sample, all drawn anew, the eye turns", gl::Smoothness::kOneSample, gl::StillThings::kDrawnAnew,
       true},
      {"four samples", gl::Smoothness::kFourSamples}};
  const std::vector<control::SharedFrameResult> moved = WithMovedGap(results);
  reporting::Table table{{"size", "picture", "hull and scene, ms", "drawing: median", "95 %", "longest",
                          "processor time, ms", "still things drawn, renewed", "squares left when renewed",
                          "largest difference of 255", "differing by more than 2"},
                         {}};
  for (const auto& [width_px, height_px] : {std::pair{800, 520}, {1280, 720}}) {
    for (const PictureCase& of_case : cases) {
      fmt::print(stderr, "pictures: {} x {}, {}\n", width_px, height_px, of_case.what);
      const PictureTimes times = Draw(of_case.moves ? moved : results, of_case, width_px, height_px);
      table.rows.push_back(
          {fmt::format("{} x {}", width_px, height_px), of_case.what,
           fmt::format("{:.1f}", At(times.composing_ms, 0.5)),
           fmt::format("{:.1f}", At(times.drawing_ms, 0.5)),
           fmt::format("{:.1f}", At(times.drawing_ms, 0.95)),
           fmt::format("{:.1f}", At(times.drawing_ms, 1.0)),
           fmt::format("{:.1f}", At(times.processor_ms, 0.5)),
           fmt::format("{}, {} of {}", times.still.drawn, times.still.renewed, results.size()),
           LeftShare(times.squares), fmt::format("{}", times.largest_difference),
           fmt::format("{:.4f} %",
                       100.0 * static_cast<double>(times.differing) / static_cast<double>(times.channels))});
    }
  }
  reporting::WriteSection(docs / "performance.md", "pictures",
                          fmt::format("{}\n{}", reporting::ToMarkdown(table),
                                      reporting::ToLine(reporting::ThisMachine(docs / ".."))));
}

}  // namespace elbowroom::accuracy
