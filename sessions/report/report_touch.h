// A row of the report's list: a touch or a near miss.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/contact.h"
#include "sessions/session_reader.h"

namespace elbowroom::sessions {

// The list holds no more rows; the worst come first. The session holds all.
inline constexpr std::size_t kMostTouches = 500;

struct ReportTouch {
  bool is_near_miss = false;
  core::EpisodeId id = 0;  // numbered for themselves: touches, near misses
  core::FindingId finding_id;
  core::PartIndex part = 0;
  core::FrameIndex frame = 0;  // deepest, or closest
  double begin_s = 0.0;
  double time_s = 0.0;  // of `frame`
  double end_s = 0.0;   // of the last frame, which lasts on
  double depth_mm = 0.0;
  double area_mm2 = 0.0;                       // of a touch
  std::optional<core::PartClearance> closest;  // of a near miss
  bool is_sure = true;                         // of a near miss: the part was surely too near
  std::optional<Eigen::Vector3d> at_in_world_mm;
  std::vector<double> spacing_mm;  // then, in the layout's order
  std::vector<std::string> tools;
  std::string status;  // of the review: "new", "approved", ...
};

struct TouchList {
  std::vector<ReportTouch> touches;  // by part, then by time
  std::size_t left_out = 0;
  std::optional<std::size_t> worst;  // the deepest touch, as WorstEpisode
};

// "touch 3", "near miss 2"
[[nodiscard]] std::string NameOf(const ReportTouch& touch);

// The worst kMostTouches: touches before near misses, deeper before shallower, closer before farther.
[[nodiscard]] TouchList TouchesOf(const SessionReader& session);

}  // namespace elbowroom::sessions
