// A study before it begins: STUDY.toml, and which trial each participant does when.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::control {

// Done one after the other in each condition.
struct PlannedTask {
  std::string name;   // empty: the trial file's own task
  std::string block;  // "practice", "timed"; empty: none
  std::filesystem::path trial_file;
};

struct PlannedCondition {
  std::string name;
  std::filesystem::path trial_file;  // of its tasks that name none
};

enum class StudyDesign {
  kBetween,  // each participant does one condition
  kWithin,   // each does all of them, in a balanced order
};

struct StudyPlan {
  std::filesystem::path file;  // that it was read from
  std::string name;
  std::uint64_t seed = 0;
  StudyDesign design = StudyDesign::kBetween;
  // Codes that files can be named after; at least one, each once.
  std::vector<std::string> participants;
  std::vector<PlannedCondition> conditions;  // at least one; their names differ
  std::vector<PlannedTask> tasks;            // at least one
};

struct PlannedTrial {
  std::string participant;
  int order = 0;  // among the participant's trials, from 1
  std::string condition;
  std::string block;
  std::string task;
  std::filesystem::path trial_file;
};

// Reads STUDY.toml (docs/studies.md). Throws: core::Error{kFormat} with file, line and key for what isn't as
// it must be; {kFile} where it can't be read, or a trial file that it names isn't there.
[[nodiscard]] StudyPlan ReadStudyPlan(const std::filesystem::path& path);

// By participant, in the plan's order, then by order. A function of the plan alone: conditions, or orders of
// them, are drawn in blocks (core::DrawInBlocks), so that a participant who is added changes nothing for
// those before.
[[nodiscard]] std::vector<PlannedTrial> PlannedTrials(const StudyPlan& plan);

// How many participants give each condition, or each order of them, equally often: a multiple of this.
[[nodiscard]] std::size_t BlockSizeOf(const StudyPlan& plan);

}  // namespace elbowroom::control
