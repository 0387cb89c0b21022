// Whether a session file is whole, down to every picture in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/progress.h"
#include "sessions/session_reader.h"

namespace elbowroom::sessions {

// Frames that should be there, between frames that are.
struct FrameGap {
  core::FrameIndex first = 0;
  core::FrameIndex end = 0;  // not included
};

struct SessionCheck {
  std::filesystem::path session;
  std::vector<std::string> problems;  // a line each; none: the session is sound
  std::vector<std::string> notes;     // what is no damage, but good to know
  SessionStatus status = SessionStatus::kComplete;
  std::int64_t schema = 0;  // of the file; 0: not known
  std::int64_t frames = 0;
  std::vector<FrameGap> gaps;
  std::int64_t silhouettes = 0;  // whose checksums were compared
  std::int64_t meshes = 0;       // likewise
  std::int64_t footage_files = 0;
  bool is_sound() const { return problems.empty(); }
};

// Looks at all of it: what SessionReader checks when it opens a file; then every frame with its silhouettes
// and contacts, every event, touch, near miss, remark and heat map; that the frames' numbers have no gap; and
// that the files of the footage are those of their checksums. Goes on after a problem where it can; a file
// that can't be opened is a problem, too. Throws: Error{kCancelled}.
[[nodiscard]] SessionCheck CheckSession(const std::filesystem::path& session, const core::Progress& progress,
                                        const std::stop_token& stop);

}  // namespace elbowroom::sessions
