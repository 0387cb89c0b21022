#include "app/control/keep_out/keep_out_job.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <set>
#include <span>
#include <utility>
#include <variant>

#include "core/error.h"
#include "core/procedure/tools_in_use.h"
#include "core/spelling.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/hull/visual_hull.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;

// Hulls that are added at once. More keep more threads busy, and more hulls in memory.
constexpr std::size_t kHullsAtOnce = 16;

// A session's frames that are taken in, each with how long its hull stands.
struct ChosenFrames {
  std::vector<std::pair<core::FrameIndex, double>> frames;
  std::int64_t without_camera = 0;
};

// By frame, the time to the next one; of the last frame the mean.
std::vector<double> SecondsOf(const std::vector<sessions::FrameSummary>& frames) {
  std::vector<double> seconds(frames.size(), 0.0);
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) seconds[i] = frames[i + 1].time_s - frames[i].time_s;
  if (frames.size() > 1)
    seconds.back() = (frames.back().time_s - frames.front().time_s) / static_cast<double>(frames.size() - 1);
  return seconds;
}

ChosenFrames ChooseFrames(const sessions::SessionReader& session, const KeepOutRequest& request) {
  std::set<core::FrameIndex> incomplete;
  for (const sessions::StampRow& row : session.stamp_rows())
    if (row.LacksCamera()) incomplete.insert(row.frame);
  core::ToolsOfFrames tools(session.events());
  const std::vector<sessions::FrameSummary> frames = session.frames();
  const std::vector<double> seconds = SecondsOf(frames);
  ChosenFrames chosen;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const core::FrameIndex frame = frames[i].frame;
    if (frame < request.frames.first || (request.frames.end && frame >= *request.frames.end)) continue;
    if (request.tool && !std::ranges::binary_search(tools.At(frame), *request.tool)) continue;
    if (incomplete.contains(frame)) {
      ++chosen.without_camera;
    } else {
      chosen.frames.emplace_back(frame, seconds[i]);
    }
  }
  return chosen;
}

// Throws unless a session's trial names the tool, or a mark does.
void RequireKnownTool(const std::string& tool, std::span<const sessions::SessionReader> sessions) {
  std::vector<std::string> known;
  for (const sessions::SessionReader& session : sessions) {
    const auto& tools = session.header().trial.tools;
    known.insert(known.end(), tools.begin(), tools.end());
    for (const core::SessionEvent& event : session.events())
      if (const auto* mark = std::get_if<core::ToolMarked>(&event.what)) known.push_back(mark->tool);
  }
  if (std::ranges::find(known, tool) != known.end()) return;
  throw Error(ErrorKind::kRange,
              fmt::format("--tool: no tool of the sessions is named '{}'; {}", tool,
                          core::SpellingAdvice(tool, known, "use a name of the trial's tools")));
}

std::string NoFrames(const KeepOutRequest& request, const std::vector<ChosenFrames>& chosen,
                     std::span<const sessions::SessionReader> sessions) {
  std::int64_t without_camera = 0;
  for (const ChosenFrames& of_one : chosen) without_camera += of_one.without_camera;
  const std::string who = sessions.size() == 1 ? fmt::format("session '{}'", sessions[0].path().string())
                                               : fmt::format("the {} sessions", sessions.size());
  if (without_camera > 0)
    return fmt::format("{}: each of the {} frames lacks a camera's picture; choose others", who,
                       without_camera);
  std::string range;
  for (const sessions::SessionReader& session : sessions) {
    const auto frames = session.frames();
    if (!frames.empty()) range += fmt::format(" {}:{}", frames.front().frame, frames.back().frame + 1);
  }
  if (range.empty()) return fmt::format("{}: no frame was recorded; record a trial first", who);
  if (request.tool)
    return fmt::format(
        "{}: '{}' was in use in no frame that was asked for; choose another --tool or more --frames", who,
        *request.tool);
  return fmt::format("{}: no frame is in --frames; there are{}", who, range);
}

// Hands the hulls of a session's frames to the volume.
class SessionSweep {
 public:
  SessionSweep(const sessions::SessionReader& session, recon::SweptVolume* volume, KeepOut* result)
      : session_(session),
        rig_(std::make_shared<const core::Rig>(session.header().rig)),
        volume_(volume),
        result_(result) {}

  void Take(core::FrameIndex frame, double seconds, const std::stop_token& stop) {
    const core::FrameRecord record = session_.ReadFrame(frame);
    // Reading a frame checks that its silhouettes have the sizes of the cameras' pictures.
    if (planes_.empty()) planes_ = recon::MakeUndistortedPlanes(*rig_);
    auto hull = recon::NextHull(last_, rig_, planes_, *record.masks).hull;
    ++result_->frames;
    result_->seconds += seconds;
    if (hull == last_) {
      spans_.back().seconds += seconds;
      return;
    }
    if (spans_.size() == kHullsAtOnce) Flush(stop);
    ++result_->hulls;
    spans_.push_back({hull, seconds});
    last_ = std::move(hull);
  }

  void Flush(const std::stop_token& stop) {
    tbb::parallel_for(std::size_t{0}, spans_.size(), [&](std::size_t i) { spans_[i].hull->Prepare(); });
    volume_->Add(spans_, stop);
    spans_.clear();
  }

 private:
  const sessions::SessionReader& session_;
  std::shared_ptr<const core::Rig> rig_;
  recon::UndistortedPlanes planes_;
  std::shared_ptr<const recon::VisualHull> last_;
  std::vector<recon::HullSpan> spans_;  // not yet added
  recon::SweptVolume* volume_;
  KeepOut* result_;
};

Eigen::AlignedBox3d WorkspaceOf(std::span<const sessions::SessionReader> sessions) {
  Eigen::AlignedBox3d workspace_mm;
  for (const sessions::SessionReader& session : sessions)
    workspace_mm.extend(session.header().rig.workspace_mm);
  return workspace_mm;
}

}  // namespace

KeepOut FindKeepOut(const KeepOutRequest& request, const core::Progress& progress,
                    const std::stop_token& stop) {
  core::Require(!request.sessions.empty(), "a session at least");
  std::vector<sessions::SessionReader> sessions;
  for (const auto& path : request.sessions) sessions.emplace_back(path, stop).Freeze();
  if (request.tool) RequireKnownTool(*request.tool, sessions);
  recon::SweptVolume volume(WorkspaceOf(sessions), {.edge_mm = request.edge_mm});
  std::vector<ChosenFrames> chosen;
  KeepOut result;
  result.sessions = std::ssize(sessions);
  std::int64_t total = 0, done = 0;
  for (const sessions::SessionReader& session : sessions) {
    chosen.push_back(ChooseFrames(session, request));
    total += std::ssize(chosen.back().frames);
    result.frames_without_camera += chosen.back().without_camera;
  }
  if (total == 0) throw Error(ErrorKind::kRange, NoFrames(request, chosen, sessions));
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    SessionSweep sweep(sessions[i], &volume, &result);
    for (const auto& [frame, seconds] : chosen[i].frames) {
      sweep.Take(frame, seconds, stop);
      progress.Report(++done, total, "keep-out frames");
    }
    sweep.Flush(stop);
  }
  result.swept = volume.Mesh(progress, stop);
  if (result.swept.mesh.triangles.empty())
    throw Error(
        ErrorKind::kGeometry,
        fmt::format("nothing real is in the workspace in any of the {} frames, so nothing must be kept free",
                    result.frames));
  result.bound_mm = volume.BoundMm();
  result.work = volume.work();
  result.bytes = volume.bytes();
  return result;
}

}  // namespace elbowroom::control
