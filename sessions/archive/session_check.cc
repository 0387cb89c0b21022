#include "sessions/archive/session_check.h"

#include <fmt/format.h>

#include <optional>
#include <set>

#include "core/error.h"
#include "sessions/archive/footage_check.h"

namespace elbowroom::sessions {
namespace {

using core::Error;

// More problems of one kind than that are counted only.
constexpr std::size_t kMostOfAKind = 20;

class Checking {
 public:
  Checking(SessionCheck* check, const core::Progress& progress, std::stop_token stop)
      : check_(check), progress_(progress), stop_(std::move(stop)) {}

  void Run() {
    std::optional<SessionReader> session;
    if (!Try([&] { session.emplace(check_->session, stop_); })) return;
    check_->schema = session->file_schema();
    session->Freeze();
    check_->status = session->status();
    if (check_->status != SessionStatus::kComplete)
      check_->notes.push_back(fmt::format("it is {}: its touches aren't written yet", StatusText()));
    std::set<core::SharedMesh> meshes;
    for (const core::Part& part : session->header().layout.parts) meshes.insert(part.mesh);
    check_->meshes = std::ssize(meshes);
    CheckFrames(*session);
    Try([&] { (void)session->events(); });
    Try([&] { (void)session->findings(); });
    Try([&] { (void)session->heat_maps(); });
    Try([&] { CheckFootage(*session); });
  }

 private:
  // Whether it could be done.
  template <typename Work>
  bool Try(const Work& work) {
    try {
      work();
      return true;
    } catch (const Error& error) {
      if (error.kind() == core::ErrorKind::kCancelled) throw;
      check_->problems.emplace_back(error.what());
      return false;
    }
  }

  [[nodiscard]] std::string StatusText() const {
    return check_->status == SessionStatus::kRecording ? "being recorded"
                                                       : std::string(ToString(check_->status));
  }

  void CheckFrames(const SessionReader& session) {
    std::vector<FrameSummary> frames;
    if (!Try([&] { frames = session.frames(); })) return;
    check_->frames = std::ssize(frames);
    std::size_t damaged = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      core::ThrowIfStopped(stop_, "the check");
      progress_.Report(static_cast<std::int64_t>(i) + 1, check_->frames, "checking frames");
      if (i > 0 && frames[i].frame != frames[i - 1].frame + 1)
        check_->gaps.push_back({frames[i - 1].frame + 1, frames[i].frame});
      const auto read = [&] { check_->silhouettes += std::ssize(*session.ReadFrame(frames[i].frame).masks); };
      if (!Try(read) && ++damaged == kMostOfAKind) {
        check_->problems.emplace_back("more frames may be damaged; they weren't looked at");
        break;
      }
    }
    for (const FrameGap& gap : check_->gaps)
      check_->problems.push_back(
          gap.end == gap.first + 1
              ? fmt::format("session '{}': frame {} is missing", session.path().string(), gap.first)
              : fmt::format("session '{}': frames {} to {} are missing", session.path().string(), gap.first,
                            gap.end - 1));
  }

  void CheckFootage(const SessionReader& session) {
    for (const core::FootageFile& file : session.footage()) {
      progress_.Report(++check_->footage_files, 0, "checking footage");
      if (std::optional<std::string> problem = FootageProblem(session.path(), file, stop_))
        check_->problems.push_back(*std::move(problem));
    }
  }

  SessionCheck* check_;
  const core::Progress& progress_;
  std::stop_token stop_;
};

}  // namespace

SessionCheck CheckSession(const std::filesystem::path& session, const core::Progress& progress,
                          const std::stop_token& stop) {
  SessionCheck check;
  check.session = session;
  Checking(&check, progress, stop).Run();
  return check;
}

}  // namespace elbowroom::sessions
