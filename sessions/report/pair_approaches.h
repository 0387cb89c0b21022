// How near virtual parts came to each other in a trial.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/contact.h"
#include "core/ids.h"

namespace elbowroom::sessions {

// Two parts of a pair rule.
struct RuledPair {
  core::PartIndex a = 0;
  core::PartIndex b = 0;
  double required_mm = 0.0;
  bool authorised_contact = false;
};

struct PairDistance {
  core::Verdict verdict = core::Verdict::kClear;
  std::optional<double> gap_mm;  // between the surfaces; nothing: their bounds show that the rule is kept
  double at_least_mm = 0.0;      // lower bound of the distance

  [[nodiscard]] double least_mm() const { return gap_mm.value_or(at_least_mm); }
};

// The pairs where a setting of the spacings puts them.
struct PairSetting {
  std::vector<double> spacing_mm;
  std::vector<PairDistance> distances;  // of each pair
};

struct PairApproaches {
  std::vector<RuledPair> pairs;     // in the order of the parts
  std::vector<PairSetting> judged;  // ascending by spacing_mm, each once
  std::size_t settings = 0;         // that the trial had, judged or not

  // Nothing: not judged.
  [[nodiscard]] const PairSetting* Find(const std::vector<double>& spacing_mm) const;
};

}  // namespace elbowroom::sessions
