// Touches and near misses as reviewers name and follow them, from a trial to its replays.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/ids.h"

namespace elbowroom::core {

enum class FindingKind { kTouch, kNearMiss };

enum class ReviewStatus { kNew, kActive, kReviewed, kApproved, kResolved };

inline constexpr std::array kReviewStatuses = {ReviewStatus::kNew, ReviewStatus::kActive,
                                               ReviewStatus::kReviewed, ReviewStatus::kApproved,
                                               ReviewStatus::kResolved};

// Where a finding of the session that was replayed is in the replay.
enum class FindingPresence {
  kHere,
  kGone,        // its part and time were judged again, and nothing is there
  kNotChecked,  // they weren't judged again: that says nothing about it
};

[[nodiscard]] std::string_view ToString(FindingKind kind);          // "touch", "near miss"
[[nodiscard]] std::string_view ToString(ReviewStatus status);       // "new", "active", ...
[[nodiscard]] std::string_view ToString(FindingPresence presence);  // "here", "gone", "not checked"
[[nodiscard]] std::optional<FindingKind> ParseFindingKind(std::string_view text);
[[nodiscard]] std::optional<ReviewStatus> ParseReviewStatus(std::string_view text);

// One sets a status, or adds a comment, or both.
struct ReviewRemark {
  std::string at_utc;  // ISO 8601
  std::string by;      // who
  std::optional<ReviewStatus> status;
  std::string comment;
  std::string exchange_id = {};  // 32 hex digits, of the file that it came in; empty: it was made here

  [[nodiscard]] bool operator==(const ReviewRemark&) const = default;
};

struct Finding {
  FindingId id;
  FindingKind kind = FindingKind::kTouch;
  std::string part;  // its name
  double begin_s = 0.0;
  double end_s = 0.0;
  // Of the deepest point, or of the part's witness point. Nothing: an older program didn't record it.
  std::optional<Eigen::Vector3d> place_in_part_mm;
  FindingPresence presence = FindingPresence::kHere;
  EpisodeId number = 0;               // of the episode or near miss; 0 where it isn't here
  std::vector<ReviewRemark> remarks;  // in the order in which they were made

  [[nodiscard]] ReviewStatus status() const;  // the last one that was set; kNew without one
};

// Whether it has the form of an id: 32 digits, 0 to 9 and a to f.
[[nodiscard]] bool IsId(std::string_view text);

// The id of a finding that no session before had. Of `first_recording_id`, kind, part and first frame.
[[nodiscard]] FindingId MakeFindingId(std::string_view first_recording_id, FindingKind kind,
                                      std::string_view part, FrameIndex begin_frame);

// 32 hex digits that tell the remark from others of the finding: its exchange_id, else of who said what, and
// when.
[[nodiscard]] std::string RemarkId(const FindingId& finding, const ReviewRemark& remark);

}  // namespace elbowroom::core
