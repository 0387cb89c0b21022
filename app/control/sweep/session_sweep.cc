#include "app/control/sweep/session_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "app/control/sweep/kept_hulls.h"
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
  options.from_mm = range.from_mm;
  options.to_mm = range.to_mm;
  options.step_mm = range.step_mm;
  options.review = ReviewOptionsOf(header.trial, header.rig, header.rig_quality);
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

SweptCurves CurvesOf(const std::vector<StretchCurves>& stretches) {
  Curves all, without;
  std::map<std::string, Curves> with;
  for (const StretchCurves& stretch : stretches) {
    for (std::size_t group = 0; group < stretch.tools.size(); ++group) {
      const review::SpacingCurve& curve = stretch.curves[group];
      all.push_back(curve);
      if (stretch.tools[group].empty()) without.push_back(curve);
      for (const std::string& tool : stretch.tools[group]) with[tool].push_back(curve);
    }
  }
  return Joined(all, without, with);
}

SweptCurves Together(const std::vector<SweptCurves>& sessions) {
  if (sessions.size() == 1) return sessions.front();
  Curves all, without;
  std::map<std::string, Curves> with;
  for (const SweptCurves& curves : sessions) {
    all.push_back(curves.all);
    without.push_back(curves.without_tools);
    for (const auto& [tool, curve] : curves.with_tool) with[tool].push_back(curve);
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

SessionSweep::SessionSweep(const std::filesystem::path& session, const SweepRequest& request,
                           const std::stop_token& stop)
    : request_(request), session_(session, stop) {
  session_.Freeze();
  options_ = OptionsOf(session_.header(), request.range);
  judged_.push_back(JudgedAs("", {}));
  for (const SweepRevision& revision : request.revisions)
    judged_.push_back(JudgedAs(revision.name, revision.changes));
  frames_ = SweepFramesOf(session_);
}

SessionSweep::Judged SessionSweep::JudgedAs(const std::string& revision, const ReplayChanges& changes) const {
  try {
    return JudgedWith(changes);
  } catch (const core::Error& error) {
    const std::string of_revision = revision.empty() ? "" : fmt::format(", revision '{}'", revision);
    throw core::Error(error.kind(),
                      fmt::format("'{}'{}: {}", session_.path().string(), of_revision, error.what()));
  }
}

SessionSweep::Judged SessionSweep::JudgedWith(const ReplayChanges& changes) const {
  const core::Layout& recorded = session_.header().layout;
  Judged judged{ReplayLayout(recorded, changes), {}, 0, {}};
  judged.layout = judged.replayed.layout();
  judged.spacing = core::RequireSpacing(judged.layout, request_.range.spacing);
  // A revised part's other extent shifts the limits, which were set for the experimenter's hand.
  core::Spacing& spacing = judged.layout.spacings[judged.spacing];
  if (const auto as_recorded = recorded.FindSpacing(spacing.name)) {
    spacing.min_mm = std::min(spacing.min_mm, recorded.spacings[*as_recorded].min_mm);
    spacing.max_mm = std::max(spacing.max_mm, recorded.spacings[*as_recorded].max_mm);
  }
  review::SpacingStudyOptions options = options_;
  options.spacing = judged.spacing;
  options.Validate(judged.layout);
  judged.parts.moved = review::PartsMovedBy(judged.layout, judged.spacing);
  for (const core::Part& part : judged.layout.parts) judged.parts.names.push_back(part.name);
  if (!judged_.empty()) judged.parts.changed = ChangedIn(judged);
  return judged;
}

std::vector<core::PartIndex> SessionSweep::ChangedIn(const Judged& judged) const {
  const Judged& before = judged_.front();
  const core::SpacingPoses poses_before(before.layout), poses_now(judged.layout);
  std::vector<double> before_mm = before.layout.InitialSpacings();
  std::vector<double> now_mm = judged.replayed.SpacingsFrom(before_mm);
  std::set<core::PartIndex> changed;
  for (const double end_mm : {request_.range.from_mm, request_.range.to_mm}) {
    before_mm[before.spacing] = now_mm[judged.spacing] = end_mm;
    const auto was = poses_before.At(before_mm), is = poses_now.At(now_mm);
    for (core::PartIndex part = 0; part < is.size(); ++part) {
      const auto& recorded = judged.replayed.RecordedOf(part);
      if (!recorded || !recorded->has_same_mesh || !(was[recorded->part] == is[part])) changed.insert(part);
    }
  }
  return {changed.begin(), changed.end()};
}

std::vector<std::vector<std::string>> SessionSweep::ChangesOfRevisions() const {
  std::vector<std::vector<std::string>> changes;
  for (std::size_t k = 1; k < judged_.size(); ++k) changes.push_back(judged_[k].replayed.changes());
  return changes;
}

std::vector<SweptParts> SessionSweep::Parts() const {
  std::vector<SweptParts> parts;
  for (const Judged& judged : judged_) parts.push_back(judged.parts);
  return parts;
}

SessionSweep::MeshHashes SessionSweep::HashMeshes() const {
  MeshHashes hashes;
  for (const Judged& judged : judged_) {
    std::vector<std::string> of_layout;
    for (const core::Part& part : judged.layout.parts) of_layout.push_back(core::ContentHash(*part.mesh));
    hashes.push_back(std::move(of_layout));
  }
  return hashes;
}

SessionSweep::Keys SessionSweep::KeysOf(std::size_t first, std::size_t end, const MeshHashes& hashes,
                                        const SweepCells& cells) const {
  std::set<std::vector<double>> recorded_mm;
  for (std::size_t i = first; i < end; ++i) recorded_mm.insert(frames_.frames[i].spacing_mm);
  const std::vector<double> steps_mm = options_.Steps();
  Keys keys;
  for (std::size_t k = 0; k < judged_.size(); ++k) {
    const Judged& judged = judged_[k];
    const core::SpacingPoses poses(judged.layout);
    std::vector<CellQuestion> questions;
    for (std::size_t part = 0; part < hashes[k].size(); ++part)
      questions.push_back(
          {first, end, hashes[k][part], std::ranges::binary_search(judged.parts.moved, part), {}});
    for (const std::vector<double>& spacing_mm : recorded_mm) {
      std::vector<double> values_mm = judged.replayed.SpacingsFrom(spacing_mm);
      for (const double step_mm : steps_mm) {
        values_mm[judged.spacing] = step_mm;
        const auto world_from_parts = poses.At(values_mm);
        for (std::size_t part = 0; part < questions.size(); ++part)
          questions[part].world_from_part.push_back(world_from_parts[part]);
      }
    }
    std::vector<CellKey> of_layout;
    for (const CellQuestion& question : questions) of_layout.push_back(cells.KeyOf(question));
    keys.push_back(std::move(of_layout));
  }
  return keys;
}

SweepCellsByKey SessionSweep::Ask(std::size_t first, std::size_t end, const Keys& keys,
                                  const std::set<CellKey>& missing, SweepFrameLoader* loader,
                                  const std::stop_token& stop) const {
  const ToolGroups groups = GroupsOf(frames_, first, end);
  review::SpacingStudyOptions options = options_;
  options.groups = groups.tools.size();
  std::vector<review::StudyLayout> layouts;
  std::vector<CellKey> asked;
  std::set<CellKey> left = missing;  // parts that several layouts share are asked in the first of them
  for (std::size_t k = 0; k < judged_.size(); ++k) {
    const Judged& judged = judged_[k];
    review::StudyLayout study{
        &judged.layout, judged.spacing, {}, [&judged](const std::vector<double>& recorded_mm) {
          return judged.replayed.SpacingsFrom(recorded_mm);
        }};
    for (core::PartIndex part = 0; part < keys[k].size(); ++part) {
      if (left.erase(keys[k][part]) == 0) continue;
      study.parts.push_back(part);
      asked.push_back(keys[k][part]);
    }
    if (!study.parts.empty()) layouts.push_back(std::move(study));
  }
  const auto load = [&](std::size_t i) {
    review::StudyFrame frame = loader->Load(first + i);
    frame.group = groups.group_of_frame[i];
    return frame;
  };
  std::vector<review::PartStudy> studies =
      review::StudyParts(layouts, {end - first, load}, options, {}, stop);
  SweepCellsByKey cells;
  for (std::size_t i = 0; i < asked.size(); ++i) cells[asked[i]] = {groups.tools, std::move(studies[i])};
  return cells;
}

SessionPiece SessionSweep::Run(const std::function<void(std::int64_t)>& frames_done,
                               const std::stop_token& stop) const {
  const core::SessionHeader& header = session_.header();
  SessionPiece piece;
  piece.session = {session_.path(),
                   session_.recording_id(),
                   header.started_at_utc,
                   header.trial.participant,
                   frames_.is_simulated,
                   header.trial.estimate_mm,
                   header.trial.required_clearance_mm,
                   frames_.without_camera,
                   {}};
  SweepCells kept(request_.folder, session_, request_.range);
  std::optional<KeptHulls> hulls;
  std::optional<SweepFrameLoader> loader;
  std::vector<std::vector<StretchCurves>> stretches(judged_.size());
  const std::vector<double> steps_mm = options_.Steps();
  const MeshHashes hashes = HashMeshes();
  for (std::size_t first = 0; first < frames_.frames.size(); first += kFramesACell) {
    core::ThrowIfStopped(stop, "the sweep");
    const std::size_t end = std::min(first + kFramesACell, frames_.frames.size());
    const Keys keys = KeysOf(first, end, hashes, kept);
    std::set<CellKey> all, missing;
    for (const std::vector<CellKey>& of_layout : keys) all.insert(of_layout.begin(), of_layout.end());
    for (const CellKey& key : all) {
      if (kept.Find(key) == nullptr) {
        missing.insert(key);
      } else if (!request_.cells_before || request_.cells_before->contains(kept.FileOf(key))) {
        ++piece.cells_from_before;
      }
    }
    if (!missing.empty()) {
      if (!loader) {
        RecordedMotion::HullKeeper keeper;
        if (const auto folder = kept.FolderForHulls(); folder && request_.keeps_hulls) {
          hulls.emplace(*folder);
          keeper = [&hulls](auto silhouettes) { return hulls->Complete(silhouettes); };
        }
        loader.emplace(session_, frames_, std::move(keeper));
      }
      kept.Keep(Ask(first, end, keys, missing, &*loader, stop));
      if (hulls) hulls->Write();
    }
    piece.cells += std::ssize(all);
    std::vector<review::PartStudy> asked;
    for (const CellKey& key : all) asked.push_back(kept.Find(key)->part);
    piece.count += review::CountOf(asked);
    for (std::size_t k = 0; k < judged_.size(); ++k) {
      std::vector<review::PartStudy> parts;
      for (const CellKey& key : keys[k]) parts.push_back(kept.Find(key)->part);
      stretches[k].push_back({kept.Find(keys[k].front())->tools,
                              review::Joined(parts, steps_mm, judged_[k].parts.moved).curves});
    }
    frames_done(static_cast<std::int64_t>(end - first));
  }
  if (loader) {
    piece.hulls = loader->hulls_made();
    piece.hulls_kept = loader->hulls_kept();
  }
  piece.session.curves = CurvesOf(stretches.front());
  for (std::size_t k = 1; k < stretches.size(); ++k)
    piece.session.of_revisions.push_back(CurvesOf(stretches[k]));
  return piece;
}

}  // namespace elbowroom::control
