// How near two virtual parts came to each other in a trial.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/contact.h"
#include "core/ids.h"

namespace elbowroom::sessions {

// Two parts of a pair rule, at that setting of the spacings at which they were closest.
struct PairApproach {
  core::PartIndex a = 0;
  core::PartIndex b = 0;
  double required_mm = 0.0;
  bool authorised_contact = false;
  core::Verdict verdict = core::Verdict::kClear;
  std::optional<double> gap_mm;  // between the surfaces; nothing: their bounds show that the rule is kept
  double at_least_mm = 0.0;      // lower bound of the distance
  std::vector<double> spacing_mm;
  double time_s = 0.0;    // when they were set so first
  double broken_s = 0.0;  // how long the rule wasn't kept, or that wasn't certain
};

struct PairApproaches {
  std::vector<PairApproach> pairs;  // in the order of the parts
  std::size_t settings = 0;         // different ones of the spacings that the trial had
  std::size_t judged = 0;           // of them
};

}  // namespace elbowroom::sessions
