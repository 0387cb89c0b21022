// What a session and a summary are told of a trial's pair rules.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/control/pairs/pair_judge.h"
#include "core/layout.h"
#include "core/session.h"

namespace elbowroom::control {

// A pair rule over a trial. A setting that wasn't judged counts as the one before it.
struct PairTotal {
  review::PairClash closest;                      // where the parts were nearest to each other
  double closest_time_s = 0.0;                    // when that began
  core::Verdict verdict = core::Verdict::kClear;  // at the end
  bool was_broken = false;                        // at any time
  double broken_s = 0.0;                          // how long the rule wasn't kept, or that wasn't certain
};

// Fed the verdicts in the order of their settings. Thread: one.
class PairRecord {
 public:
  static constexpr std::size_t kMostNotes = 32;

  // The layout must outlive it.
  explicit PairRecord(const core::Layout& layout) : layout_(layout) {}

  // Notes for the session: of each rule that is broken by another verdict than before, or is kept again. They
  // have the frame of their setting, which may be before the last frame so far. Of one setting kMostNotes at
  // most, and one with the number of the others.
  [[nodiscard]] std::vector<core::SessionEvent> Add(const PairVerdicts& verdicts);

  // One a pair, up to the time of the last frame. None before the first verdicts.
  [[nodiscard]] std::vector<PairTotal> Totals(double end_s) const;

 private:
  const core::Layout& layout_;
  std::vector<PairTotal> totals_;
  double since_s_ = 0.0;
};

// "pair rule broken: 'a' and 'b' near, 3.20 mm apart, 10 mm required", or "pair rule kept again: 'a' and 'b'
// clear, at least 12.00 mm apart, 10 mm required". Distances are rounded down.
[[nodiscard]] std::string PairNoteOf(const core::Layout& layout, const review::PairClash& pair);

// Whether a PairRecord wrote it.
[[nodiscard]] bool IsPairNote(const core::SessionEvent& event);

}  // namespace elbowroom::control
