#include "app/control/study/study_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/control/heat_picture.h"
#include "app/control/study/study_document.h"
#include "core/error.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/images/png_file.h"

namespace elbowroom::control {
namespace {

// Those touched longest at one place first.
std::vector<const PartDwell*> ByLongestTouch(const std::vector<PartDwell>& dwell) {
  std::vector<const PartDwell*> parts;
  for (const PartDwell& part : dwell) parts.push_back(&part);
  const auto longest_s = [](const PartDwell* part) { return std::ranges::max(part->map.dwell_s); };
  std::ranges::stable_sort(parts, std::ranges::greater(), longest_s);
  return parts;
}

std::vector<DwellPicture> DrawDwell(const Study& study, const core::Progress& progress,
                                    const std::stop_token& stop) {
  std::vector<const PartDwell*> parts = ByLongestTouch(study.dwell);
  parts.resize(std::min(parts.size(), kMostDwellPictures));
  std::vector<DwellPicture> pictures;
  if (parts.empty()) return pictures;
  recon::gl::SceneRenderer renderer;
  for (const PartDwell* part : parts) {
    core::ThrowIfStopped(stop, "the report");
    progress.Report(static_cast<std::int64_t>(pictures.size()), static_cast<std::int64_t>(parts.size()),
                    fmt::format("picture of '{}'", part->part));
    pictures.push_back(
        {part->part, part->sessions, recon::EncodePng(HeatPicture(renderer, part->mesh, part->map))});
  }
  return pictures;
}

}  // namespace

sessions::PageAndPdf MakeStudyReport(const Study& study, const core::Progress& progress,
                                     const std::stop_token& stop) {
  const std::vector<DwellPicture> dwell = DrawDwell(study, progress, stop);
  sessions::ChartPainters painters;
  return sessions::MakePageAndPdf(StudyDocument(study, dwell, &painters), progress, stop);
}

}  // namespace elbowroom::control
