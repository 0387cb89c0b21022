// docs/segmentation.md, "light": run time beside error when the light changes. docs/light.md, "watch": what
// watching it costs.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "recon/light/light_watch.h"
#include "recon/segmentation/segmentation.h"
#include "tests/accuracy/interleaved_timing.h"
#include "tests/accuracy/measurements.h"
#include "tests/oracles/exposure_oracle.h"
#include "tests/recon/segmentation/lit_scenes.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

using recon::LightChange;
using recon::LitScene;
using recon::Segmenter;
using reporting::ThreeDigits;

constexpr double kNoiseLevels = 0.02 * 255.0;  // the paper's
constexpr int kFrames = 6;

struct Scene {
  LitScene lit;
  std::vector<recon::BackgroundReference> backgrounds;
  std::vector<Segmenter> plain, adaptive;
};

Scene SceneWith(LitScene lit) {
  Scene scene;
  scene.backgrounds = recon::BackgroundsOf(lit, kNoiseLevels);
  recon::SegmentationOptions adaptive;
  adaptive.method = recon::SegmentationMethod::kAdaptive;
  for (const recon::BackgroundReference& background : scene.backgrounds) {
    scene.plain.emplace_back(background, recon::SegmentationOptions());
    scene.adaptive.emplace_back(background, adaptive);
  }
  scene.lit = std::move(lit);
  return scene;
}

// All tables computed anew for the picture's exposure.
core::SoftMask SegmentAnew(const recon::BackgroundReference& background, const cv::Mat& picture) {
  recon::BackgroundReference changed = background;
  changed.mean_bgr = oracles::WithExposure(background.mean_bgr,
                                           oracles::EstimateExposureSlowly(picture, background.mean_bgr));
  return Segmenter(changed, {}).SegmentSoft(picture);
}

std::vector<std::function<void()>> JobsOf(const Scene& scene, const std::vector<cv::Mat>& pictures) {
  const auto of_all = [&pictures](auto segment) {
    return [&pictures, segment] { tbb::parallel_for(std::size_t{0}, pictures.size(), segment); };
  };
  return {of_all([&](std::size_t i) { (void)scene.plain[i].SegmentSoft(pictures[i]); }),
          of_all([&](std::size_t i) { (void)scene.adaptive[i].SegmentSoft(pictures[i]); }),
          of_all([&](std::size_t i) { (void)SegmentAnew(scene.backgrounds[i], pictures[i]); })};
}

// "median / worst" over the scenes of the error under the change, as a multiple of that under steady light.
std::string Ratios(const std::vector<Scene>& scenes, const std::vector<double>& steady, bool is_adaptive,
                   LightChange change) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const Scene& scene = scenes[i];
    const auto& segmenters = is_adaptive ? scene.adaptive : scene.plain;
    ratios.push_back(recon::WrongShare(scene.lit, segmenters, change, kNoiseLevels, kFrames) / steady[i]);
  }
  std::ranges::sort(ratios);
  return fmt::format("{} / {}", ThreeDigits(ratios[ratios.size() / 2]), ThreeDigits(ratios.back()));
}

// Ten seconds at 30 Hz are watched; then a picture more, or a report.
void MeasureWatch(const Scene& scene, const std::vector<cv::Mat>& pictures,
                  const std::filesystem::path& docs) {
  constexpr double kRateHz = 30.0;
  constexpr int kFramesBefore = 300;
  recon::LightWatch watch("cam1", scene.backgrounds[0], false);
  const core::BitMask mask = scene.adaptive[0].Segment(pictures[0]);
  double time_s = 0.0;
  const auto add = [&] { watch.Add(pictures[0], mask, time_s += 1.0 / kRateHz); };
  for (int i = 0; i < kFramesBefore; ++i) add();
  constexpr int kAtOnce = 30;  // a second: one picture in six is also looked at for lasting changes
  const std::function<void()> jobs[] = {[&] {
                                          for (int i = 0; i < kAtOnce; ++i) add();
                                        },
                                        [&] { (void)watch.Report(); }};
  const auto times = TimeInTurns(jobs, 1);
  const reporting::Table table{
      {"step", "1 thread, ms"},
      {{"a picture of 640 x 480 (mean of a second)", ThreeDigits(times[0].median_ms / kAtOnce)},
       {"a report", ThreeDigits(times[1].median_ms)}}};
  reporting::WriteSection(
      docs / "light.md", "watch",
      reporting::ToMarkdown(table) + "\n" + reporting::ToLine(reporting::ThisMachine(docs / "..")));
}

}  // namespace

void MeasureLight(const std::filesystem::path& docs) {
  std::vector<Scene> scenes;
  std::vector<double> steady;
  std::size_t crowded = 0;
  for (LitScene& lit : recon::LitScenes()) {
    fmt::print(stderr, "light: {}\n", lit.name);
    if (lit.name == "crowded") crowded = scenes.size();
    scenes.push_back(SceneWith(std::move(lit)));
    steady.push_back(recon::WrongShare(scenes.back().lit, scenes.back().plain, LightChange::kSteady,
                                       kNoiseLevels, kFrames));
  }
  std::vector<cv::Mat> pictures;
  for (std::size_t i = 0; i < scenes[crowded].lit.view_bgr.size(); ++i) {
    const recon::Light light = recon::LightAt(LightChange::kFlickerAndDrift, i, 1, kFrames);
    pictures.push_back(recon::Exposed(scenes[crowded].lit.view_bgr[i], light, kNoiseLevels, i));
  }
  MeasureWatch(scenes[crowded], pictures, docs);
  const auto jobs = JobsOf(scenes[crowded], pictures);
  const auto one = TimeInTurns(jobs, 1), two = TimeInTurns(jobs, 2);
  reporting::Table table{{"method", "1 thread, ms", "2 threads, ms"}, {}};
  for (const LightChange change : recon::kLightChanges) table.header.emplace_back(ToString(change));
  const std::string names[] = {"`threshold`", "`adaptive`", "all ranges anew for each picture"};
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    std::vector<std::string> row{names[i], ThreeDigits(one[i].median_ms), ThreeDigits(two[i].median_ms)};
    for (const LightChange change : recon::kLightChanges)
      row.push_back(i < 2 ? Ratios(scenes, steady, i == 1, change) : "");
    table.rows.push_back(std::move(row));
  }
  reporting::WriteSection(
      docs / "segmentation.md", "light",
      reporting::ToMarkdown(table) + "\n" + reporting::ToLine(reporting::ThisMachine(docs / "..")));
}

}  // namespace elbowroom::accuracy
