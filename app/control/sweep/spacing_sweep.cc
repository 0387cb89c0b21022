#include "app/control/sweep/spacing_sweep.h"

#include <fmt/format.h>

#include <atomic>
#include <optional>
#include <utility>

#include "app/control/parallel_tasks.h"
#include "app/control/sweep/session_sweep.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

// What is compared between sessions before any of them is judged.
struct SessionCheck {
  std::vector<SweptParts> parts;  // of each layout
  std::string recording_id;
};

void RequireSameParts(const SweepRequest& request, const std::vector<SessionCheck>& checks) {
  for (std::size_t i = 1; i < checks.size(); ++i) {
    if (checks[i].parts == checks.front().parts) continue;
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("sessions '{}' and '{}' have parts of other names, or '{}' moves others; replay them "
                    "with one layout, or sweep each alone",
                    request.sessions.front().string(), request.sessions[i].string(), request.range.spacing));
  }
}

void RequireEachOnce(const SweepRequest& request, const std::vector<SessionCheck>& checks) {
  std::map<std::string, std::size_t> by_id;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    if (checks[i].recording_id.empty()) continue;
    const auto [other, is_new] = by_id.emplace(checks[i].recording_id, i);
    if (is_new) continue;
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("sessions '{}' and '{}' are one recording, which would count twice; leave "
                                  "one of them out",
                                  request.sessions[other->second].string(), request.sessions[i].string()));
  }
}

// How many frames there are in all. Throws what is wrong with any session.
std::int64_t CheckSessions(const SweepRequest& request, const std::stop_token& stop) {
  core::Require(!request.sessions.empty(), "a session at least");
  std::vector<SessionCheck> checks(request.sessions.size());
  std::atomic<std::int64_t> frames = 0;
  RunTasks(request.sessions.size(), "the sweep", stop, [&](std::size_t i, const std::stop_token& token) {
    const SessionSweep session(request.sessions[i], request, token);
    checks[i] = {session.Parts(), session.recording_id()};
    frames += session.frame_count();
  });
  RequireSameParts(request, checks);
  RequireEachOnce(request, checks);
  return frames;
}

}  // namespace

void CheckSweep(const SweepRequest& request, const std::stop_token& stop) {
  (void)CheckSessions(request, stop);
}

SpacingSweep SweepSpacing(const SweepRequest& request, const core::Progress& progress,
                          const std::stop_token& stop) {
  const std::int64_t total = CheckSessions(request, stop);
  SharedProgress shared(progress, total, "frames");
  std::vector<SessionPiece> pieces(request.sessions.size());
  std::vector<SweptParts> parts;  // of the first session, and so of each
  std::vector<std::vector<std::string>> changes;
  RunTasks(request.sessions.size(), "the sweep", stop, [&](std::size_t i, const std::stop_token& token) {
    const SessionSweep session(request.sessions[i], request, token);
    pieces[i] = session.Run([&](std::int64_t frames) { shared.Add(frames); }, token);
    if (i > 0) return;
    parts = session.Parts();
    changes = session.ChangesOfRevisions();
  });
  SpacingSweep sweep;
  sweep.parts = parts.front().names;
  sweep.moved = parts.front().moved;
  for (SessionPiece& piece : pieces) {
    sweep.count += piece.count;
    sweep.hulls += piece.hulls;
    sweep.hulls_kept += piece.hulls_kept;
    sweep.cells += piece.cells;
    sweep.cells_from_before += piece.cells_from_before;
    sweep.sessions.push_back(std::move(piece.session));
  }
  const auto together = [&](auto curves_of) {
    std::vector<SweptCurves> curves;
    for (const SweptSession& session : sweep.sessions) curves.push_back(curves_of(session));
    return Together(curves);
  };
  sweep.all = together([](const SweptSession& session) { return session.curves; });
  for (std::size_t k = 0; k < request.revisions.size(); ++k)
    sweep.revisions.push_back(
        {request.revisions[k].name, parts[k + 1].names, parts[k + 1].moved, parts[k + 1].changed, changes[k],
         together([k](const SweptSession& session) { return session.of_revisions[k]; })});
  progress.Report(total, total, "frames");
  return sweep;
}

}  // namespace elbowroom::control
