#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/spread.h"
#include "sessions/report/report_document.h"

namespace elbowroom::sessions {
namespace {

// Of a camera that is missing again and again, only so many stretches are listed.
constexpr std::size_t kMostStretches = 8;

// How far a camera's instants are from those of its frames, in ms; nothing where its picture is missing.
std::vector<double> SkewsMs(const std::vector<StampRow>& frames, core::CameraIndex camera) {
  std::vector<double> skews_ms;
  for (const StampRow& frame : frames)
    if (const auto& stamp = frame.stamps[camera])
      skews_ms.push_back(1e3 * std::abs(stamp->time_s - frame.time_s));
  return skews_ms;
}

// Between the first and the last camera of each frame with two pictures or more, in ms.
std::vector<double> SpansMs(const std::vector<StampRow>& frames) {
  std::vector<double> spans_ms;
  for (const StampRow& frame : frames) {
    std::vector<double> at_s;
    for (const std::optional<core::CameraStamp>& stamp : frame.stamps)
      if (stamp) at_s.push_back(stamp->time_s);
    if (at_s.size() < 2) continue;
    const auto [first, last] = std::ranges::minmax(at_s);
    spans_ms.push_back(1e3 * (last - first));
  }
  return spans_ms;
}

std::int64_t IncompleteFrames(const std::vector<StampRow>& frames) {
  return std::ranges::count_if(frames, [](const StampRow& frame) {
    return std::ranges::any_of(frame.stamps, [](const auto& stamp) { return !stamp; });
  });
}

// "3, 17-19": the frames without the camera's picture. Frames that follow each other in the recording are a
// stretch.
std::string FramesWithout(const std::vector<StampRow>& frames, core::CameraIndex camera) {
  std::vector<std::pair<core::FrameIndex, core::FrameIndex>> stretches;
  bool goes_on = false;
  for (const StampRow& frame : frames) {
    const bool is_missing = !frame.stamps[camera];
    if (is_missing && goes_on) {
      stretches.back().second = frame.frame;
    } else if (is_missing) {
      stretches.emplace_back(frame.frame, frame.frame);
    }
    goes_on = is_missing;
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(stretches.size(), kMostStretches); ++i) {
    const auto& [first, last] = stretches[i];
    text += fmt::format("{}{}", i == 0 ? "" : ", ", first);
    if (last != first) text += fmt::format("\u2013{}", last);
  }
  if (stretches.size() > kMostStretches)
    text += fmt::format(" and {} more stretches", stretches.size() - kMostStretches);
  return text.empty() ? "none" : text;
}

std::string SkewLine(const std::vector<StampRow>& frames) {
  const std::optional<core::Spread> span_ms = core::SpreadOf(SpansMs(frames));
  const std::int64_t incomplete = IncompleteFrames(frames);
  std::string line = span_ms ? fmt::format(
                                   "The cameras of a frame looked within {:.1f} ms of each other (median; "
                                   "{:.1f} ms in 95 % of the frames, {:.1f} ms at most). ",
                                   span_ms->median, span_ms->p95, span_ms->max)
                             : "";
  line += incomplete == 0 ? "No frame lacks a camera."
                          : fmt::format(
                                "{} of {} frames lack a camera: there the hull is too large, and a touch "
                                "counts as undecided.",
                                incomplete, frames.size());
  return line;
}

}  // namespace

std::vector<Block> SkewOfCameras(const ReportData& data) {
  if (data.stamps.empty()) return {};
  DocumentTable table{{{"Camera"},
                       {WithRemark("From the frame\u2019s time", "median"), true},
                       {WithRemark("", "95 % of frames"), true},
                       {WithRemark("", "largest"), true},
                       {"Missing in frames"}},
                      {}};
  for (core::CameraIndex i = 0; i < data.header.rig.cameras.size(); ++i) {
    const std::optional<core::Spread> skew_ms = core::SpreadOf(SkewsMs(data.stamps, i));
    const auto cell = [&](double core::Spread::*value) {
      return skew_ms ? fmt::format("{:.1f} ms", (*skew_ms).*value) : std::string(kNothing);
    };
    table.rows.push_back(
        {{data.header.rig.cameras[i].name(), cell(&core::Spread::median), cell(&core::Spread::p95),
          cell(&core::Spread::max), FramesWithout(data.stamps, i)}});
  }
  return {Paragraph{SkewLine(data.stamps), true}, std::move(table)};
}

}  // namespace elbowroom::sessions
