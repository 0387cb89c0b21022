// The recorded motion judged at other gaps, without a new session: what a reviewer tries with a slider.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/reviewing/reviewed_session.h"
#include "core/contact.h"
#include "core/progress.h"
#include "core/session.h"

namespace elbowroom::control {

// Spacings by name that have one value in all frames, mm.
using HeldGaps = std::map<std::string, double>;

// A part over all frames with a picture of each camera.
struct WhatIfPart {
  bool is_moved = false;  // in some frame it stands elsewhere than in the trial
  std::int64_t touches = 0;
  std::int64_t near_misses = 0;
  std::int64_t frames_in_contact = 0;
  std::int64_t frames_near = 0;
  std::int64_t frames_undecided = 0;
  std::int64_t frames_clear = 0;
  double deepest_mm = 0.0;  // certified lower bound; 0 where it isn't touched
  // In none of the frames is it nearer to the hull than this; 0 where it is touched. Infinite: there is no
  // hull. Searches end once a part is far enough away, so that it may be much farther. Nothing: the trial
  // required no clearance.
  std::optional<double> clearance_mm;

  // Of all frames together: contact, else near, else undecided, else clear, as soon as one frame is so.
  [[nodiscard]] core::Verdict verdict() const;
};

struct WhatIf {
  HeldGaps held_mm;
  core::SessionOutcome outcome;            // with the ids of findings; without heat maps
  std::vector<WhatIfPart> parts;           // in the layout's order
  std::vector<core::FindingId> vanished;   // of the session: those that aren't in the outcome
  std::vector<core::FindingId> eased;      // likewise: touches that are near misses in the outcome
  std::int64_t frames = 0;                 // judged
  std::int64_t frames_without_camera = 0;  // of them: they show neither a touch nor its end
  std::int64_t answers = 0;                // one a part in each frame
  std::int64_t answers_kept = 0;           // of them: neither part nor hull differ from a known one
  double time_s = 0.0;

  [[nodiscard]] double DeepestMm() const;
  [[nodiscard]] std::optional<double> ClearanceMm() const;  // the least of all parts
};

struct WhatIfRequest {
  HeldGaps held_mm;
  // Called with every frame, in order, on any thread; empty: nobody looks at frames.
  std::function<void(const FrameResult&)> on_frame = {};
};

// What `elbowroom replay --spacing NAME=MM` finds: the same rows, touches and near misses (what_if_test).
// Parts that stand where they stood keep their recorded verdicts: these are not judged again, and where all
// parts do, no hull is made. Parts that give way are judged frame after frame from the first one on, and
// none is skipped. Throws: core::Error{kRange}: no such spacing, a value beyond its limits; {kCancelled};
// what SessionReader throws. Thread: any.
[[nodiscard]] WhatIf JudgeMotionAt(const ReviewedSession& session, const WhatIfRequest& request,
                                   const core::Progress& progress, const std::stop_token& stop);

}  // namespace elbowroom::control
