#include "app/control/sweep/session_sweep.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "app/control/trial_rules.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

// A cell's frames: so few that little is lost with a killed sweep, so many that what a cell's first frames
// show saves most of the questions about the others.
constexpr std::size_t kFramesACell = 256;

// The sets of tools of the frames [first, end), ascending, and which of them each frame has.
struct ToolGroups {
  std::vector<std::vector<std::string>> tools;
  std::vector<std::size_t> group_of_frame;
};

ToolGroups GroupsOf(const SweepFrames& frames, std::size_t first, std::size_t end) {
  std::map<std::vector<std::string>, std::size_t> groups;
  for (std::size_t i = first; i < end; ++i) groups.emplace(frames.frames[i].tools, 0);
  ToolGroups result;
  for (auto& [tools, group] : groups) {
    group = result.tools.size();
    result.tools.push_back(tools);
  }
  for (std::size_t i = first; i < end; ++i)
    result.group_of_frame.push_back(groups.at(frames.frames[i].tools));
  return result;
}

review::SpacingStudyOptions OptionsOf(const core::SessionHeader& header, const SpacingRange& range) {
  review::SpacingStudyOptions options;
  options.spacing = core::RequireSpacing(header.layout, range.spacing);
  options.from_mm = range.from_mm;
  options.to_mm = range.to_mm;
  options.step_mm = range.step_mm;
  options.review = ReviewOptionsOf(header.trial, header.rig, header.rig_quality);
  options.Validate(header.layout);
  return options;
}

using Curves = std::vector<review::SpacingCurve>;

// Curves of frames with no tool, where there are none: the same steps, without frames.
review::SpacingCurve WithoutFrames(const review::SpacingCurve& like) {
  review::SpacingCurve empty;
  for (const review::StudyStep& step : like.steps)
    empty.steps.push_back({step.spacing_mm, std::vector<review::PartAtSpacing>(step.parts.size())});
  if (!empty.steps.empty()) empty.smallest_free_mm = empty.steps.front().spacing_mm;
  return empty;
}

SweptCurves Joined(const Curves& all, const Curves& without, const std::map<std::string, Curves>& with) {
  SweptCurves joined;
  joined.all = review::Together(all);
  joined.without_tools = without.empty() ? WithoutFrames(joined.all) : review::Together(without);
  for (const auto& [tool, curves] : with) joined.with_tool[tool] = review::Together(curves);
  return joined;
}

}  // namespace

SweptCurves CurvesOf(const std::vector<SweepCell>& cells) {
  Curves all, without;
  std::map<std::string, Curves> with;
  for (const SweepCell& cell : cells) {
    for (const auto& [tools, curve] : cell.curves) {
      all.push_back(curve);
      if (tools.empty()) without.push_back(curve);
      for (const std::string& tool : tools) with[tool].push_back(curve);
    }
  }
  return Joined(all, without, with);
}

SweptCurves Together(const std::vector<SweptSession>& sessions) {
  if (sessions.size() == 1) return sessions.front().curves;
  Curves all, without;
  std::map<std::string, Curves> with;
  for (const SweptSession& session : sessions) {
    all.push_back(session.curves.all);
    without.push_back(session.curves.without_tools);
    for (const auto& [tool, curve] : session.curves.with_tool) with[tool].push_back(curve);
  }
  SweptCurves joined = Joined(all, without, with);
  const auto forget_frames = [](review::SpacingCurve& curve) {
    for (review::StudyStep& step : curve.steps)
      for (review::PartAtSpacing& part : step.parts) part.closest_frame.reset();
  };
  forget_frames(joined.all);
  forget_frames(joined.without_tools);
  for (auto& [tool, curve] : joined.with_tool) forget_frames(curve);
  return joined;
}

SessionSweep::SessionSweep(const std::filesystem::path& session, const SpacingRange& range,
                           const std::stop_token& stop)
    : session_(session, stop), range_(range) {
  session_.Freeze();
  options_ = OptionsOf(session_.header(), range);
  frames_ = SweepFramesOf(session_);
}

std::vector<std::string> SessionSweep::PartNames() const {
  std::vector<std::string> names;
  for (const core::Part& part : session_.header().layout.parts) names.push_back(part.name);
  return names;
}

std::vector<core::PartIndex> SessionSweep::MovedParts() const {
  return review::PartsMovedBy(session_.header().layout, options_.spacing);
}

SweepCell SessionSweep::Ask(std::size_t first, std::size_t end, SweepFrameLoader* loader,
                            const std::stop_token& stop) const {
  const ToolGroups groups = GroupsOf(frames_, first, end);
  review::SpacingStudyOptions options = options_;
  options.groups = groups.tools.size();
  const auto load = [&](std::size_t i) {
    review::StudyFrame frame = loader->Load(first + i);
    frame.group = groups.group_of_frame[i];
    return frame;
  };
  review::SpacingStudy study =
      review::StudySpacing(session_.header().layout, {end - first, load}, options, {}, stop);
  SweepCell cell;
  cell.count = study.count;
  for (std::size_t i = 0; i < groups.tools.size(); ++i)
    cell.curves.push_back({groups.tools[i], std::move(study.curves[i])});
  return cell;
}

SessionPiece SessionSweep::Run(const SweepRequest& request,
                               const std::function<void(std::int64_t)>& frames_done,
                               const std::stop_token& stop) const {
  const core::SessionHeader& header = session_.header();
  SessionPiece piece;
  piece.session = {session_.path(),
                   session_.recording_id(),
                   header.trial.participant,
                   header.trial.estimate_mm,
                   header.trial.required_clearance_mm,
                   frames_.without_camera,
                   {}};
  piece.parts = PartNames();
  piece.moved = MovedParts();
  const SweepCells kept(request.folder, session_, range_);
  std::optional<SweepFrameLoader> loader;
  std::vector<SweepCell> cells;
  for (std::size_t first = 0; first < frames_.frames.size(); first += kFramesACell) {
    core::ThrowIfStopped(stop, "the sweep");
    const std::size_t end = std::min(first + kFramesACell, frames_.frames.size());
    auto cell = kept.Find(first, end);
    if (cell) {
      const auto& before = request.cells_before;
      if (!before || before->contains(kept.NameOf(first, end))) ++piece.cells_from_before;
    } else {
      if (!loader) loader.emplace(session_, frames_);
      cell = Ask(first, end, &*loader, stop);
      kept.Keep(first, end, *cell);
    }
    piece.count += cell->count;
    cells.push_back(*std::move(cell));
    frames_done(static_cast<std::int64_t>(end - first));
  }
  piece.cells = std::ssize(cells);
  piece.session.curves = CurvesOf(cells);
  return piece;
}

}  // namespace elbowroom::control
