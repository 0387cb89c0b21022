// The values of a session: what was set up, and what happened frame by frame.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/contact.h"
#include "core/heat_map.h"
#include "core/ids.h"
#include "core/layout.h"
#include "core/picture_loss.h"
#include "core/questionnaire.h"
#include "core/rig.h"
#include "core/rig_quality.h"
#include "core/rigid_transform.h"
#include "core/soft_mask.h"

namespace elbowroom::core {

inline constexpr int kWidestScale = 1000;  // no end of a scale is farther from 0

// A question with a scale of whole numbers, both ends included. No two of a trial have the same `when` and
// `item`.
struct SurveyItem {
  AskedWhen when = AskedWhen::kAfter;
  std::string item;
  int least = 1;
  int most = 7;  // > least

  [[nodiscard]] bool operator==(const SurveyItem&) const = default;
};

// TRIAL.toml without its paths.
struct TrialInfo {
  std::string participant;
  std::string task;
  double estimate_mm = 0.0;  // the participant's guess of the space needed, before the trial; 0: none
  double required_clearance_mm = 0.0;  // of parts to the hull; 0: only contact is judged
  std::vector<std::string> tools;
  // Of rig and parts; verdicts on clearance allow for it, unless the rig's quality gives what is computed.
  double uncertainty_mm = 0.0;
  std::string condition = {};           // what is varied between trials: "tongs"; empty: nothing
  int order = 0;                        // the trial is the participant's first, second, ...; 0: not given
  std::vector<std::string> steps = {};  // of the procedure, in order; their names differ
  std::vector<SurveyItem> survey = {};
  std::vector<Questionnaire> questionnaires = {};
  std::string block = {};  // to which part of a study the trial belongs: "practice"; empty: none
};

struct SpacingChanged {
  std::string spacing;
  double from_mm = 0.0;
  double to_mm = 0.0;
  [[nodiscard]] bool operator==(const SpacingChanged&) const = default;
};
struct ToolMarked {
  std::string tool;
  bool in_use = false;
  [[nodiscard]] bool operator==(const ToolMarked&) const = default;
};
struct Note {
  std::string text;  // of people, or of the program: "ended at the shortest source: cam03"
  [[nodiscard]] bool operator==(const Note&) const = default;
};
struct StepMarked {
  std::string step;    // one of the trial's
  bool begun = false;  // or ended
  [[nodiscard]] bool operator==(const StepMarked&) const = default;
};
// A point in time that the experimenter wants to find again.
struct Bookmark {
  std::string name;  // may be empty
  [[nodiscard]] bool operator==(const Bookmark&) const = default;
};
struct EstimateGiven {
  AskedWhen when = AskedWhen::kAfter;
  double estimate_mm = 0.0;  // > 0
  [[nodiscard]] bool operator==(const EstimateGiven&) const = default;
};
struct SurveyAnswered {
  AskedWhen when = AskedWhen::kAfter;
  std::string item;  // with `when` one of the trial's survey
  int answer = 0;    // on its scale
  [[nodiscard]] bool operator==(const SurveyAnswered&) const = default;
};
struct QuestionnaireAnswered {
  AskedWhen when = AskedWhen::kAfter;
  std::string questionnaire;  // with `when` one of the trial's
  std::string item;           // the id of one of its items
  ItemAnswer answer;          // one that the item can have
  [[nodiscard]] bool operator==(const QuestionnaireAnswered&) const = default;
};
using EventContent = std::variant<SpacingChanged, ToolMarked, Note, StepMarked, Bookmark, EstimateGiven,
                                  SurveyAnswered, QuestionnaireAnswered>;

// The change holds from frame `frame` on: one that arrives between two frames has the number of the later.
struct SessionEvent {
  FrameIndex frame = 0;
  double time_s = 0.0;
  EventContent what;
  [[nodiscard]] bool operator==(const SessionEvent&) const = default;
};

// The session that a replay was made from.
struct SessionOrigin {
  std::string file;                // as it was given
  std::string recording_id;        // of that session
  std::string first_recording_id;  // of the session that cameras or footage gave: another one for the replay
                                   // of a replay
  std::string replayed_at_utc;     // ISO 8601
  std::vector<std::string> changes;  // in words; empty: nothing was changed
};

struct SessionHeader {
  TrialInfo trial;
  Rig rig;
  RigQuality rig_quality;
  Layout layout;
  std::string started_at_utc;                   // ISO 8601
  std::map<std::string, std::string> settings;  // segmentation and the like, as text
  std::map<std::string, std::string> versions;  // software and drivers
  std::optional<SessionOrigin> origin = {};     // of a replay
};

// Which picture of its camera a frame took, and when that was taken.
struct CameraStamp {
  std::uint64_t picture = 0;  // the camera's own count of its pictures: what is missing in it was lost
  double time_s = 0.0;        // of the middle of its exposure, on the clock of FrameRecord::time_s

  [[nodiscard]] bool operator==(const CameraStamp&) const = default;
};

// Of a frame, one a camera: whether the picture of one is missing. No stamps at all: none is.
[[nodiscard]] inline bool LacksCamera(const std::vector<std::optional<CameraStamp>>& stamps) {
  return std::ranges::any_of(stamps, [](const auto& stamp) { return !stamp; });
}

using SharedMasks = std::shared_ptr<const std::vector<SoftMask>>;

struct FrameRecord {
  FrameIndex frame = 0;
  double time_s = 0.0;  // of capture, from the first frame
  SharedMasks masks;    // one a camera
  // One a camera; nothing for a camera whose picture is missing in this frame: its mask is all object then.
  // Empty: the cameras have no stamps, and look at one instant as far as is known.
  std::vector<std::optional<CameraStamp>> stamps;
  std::vector<PictureLoss> losses;    // that became known since the frame before
  std::vector<double> spacing_mm;     // in the layout's order
  std::vector<PartContact> contacts;  // one a part, in the layout's order
  // How pushed parts were moved from the poses that layout and spacings give them: one a part, in the
  // layout's order. Empty if none was pushed.
  std::vector<RigidTransform> rest_from_parts;

  // Whether the picture of a camera is missing. The hull is larger then than with all cameras.
  [[nodiscard]] bool LacksCamera() const { return core::LacksCamera(stamps); }
};

// A file with pictures that silhouettes come from, or the RIG.yml that plays them.
struct FootageFile {
  std::string file;  // relative to the session's folder
  std::int64_t bytes = 0;
  std::array<std::byte, 16> content_hash = {};  // 128-bit XXH3
};

// The results that are written at a session's end.
struct SessionOutcome {
  std::vector<ContactEpisode> episodes;
  std::vector<NearMiss> near_misses;
  std::vector<HeatMap> heat_maps;  // of the parts that were touched, in the layout's order
};

}  // namespace elbowroom::core
