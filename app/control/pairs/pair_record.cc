#include "app/control/pairs/pair_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

namespace elbowroom::control {
namespace {

constexpr std::string_view kBroken = "pair rule broken: ", kKeptAgain = "pair rule kept again: ",
                           kMore = "more pair rules broken or kept again: ";

// What is a nanometre short of a hundredth is that hundredth.
double RoundedDown(double distance_mm) {
  return std::floor((distance_mm + review::kTouchMm) * 100.0) / 100.0;
}

std::string DistanceText(const review::PairClash& pair) {
  if (pair.contained) return "one inside the other";
  return fmt::format("{}{:.2f} mm apart", pair.gap ? "" : "at least ", RoundedDown(pair.at_least_mm));
}

}  // namespace

std::string PairNoteOf(const core::Layout& layout, const review::PairClash& pair) {
  return fmt::format("{}'{}' and '{}' {}, {}, {:g} mm required", IsBroken(pair) ? kBroken : kKeptAgain,
                     layout.parts[pair.demand.a].name, layout.parts[pair.demand.b].name,
                     core::ToString(pair.verdict), DistanceText(pair), pair.demand.required_mm);
}

bool IsPairNote(const core::SessionEvent& event) {
  const auto* note = std::get_if<core::Note>(&event.what);
  if (note == nullptr) return false;
  return std::ranges::any_of(std::array{kBroken, kKeptAgain, kMore},
                             [&](std::string_view beginning) { return note->text.starts_with(beginning); });
}

std::vector<core::SessionEvent> PairRecord::Add(const PairVerdicts& verdicts) {
  std::vector<core::SessionEvent> notes;
  const auto add = [&](std::string text) {
    notes.push_back({verdicts.setting.frame, verdicts.setting.time_s, core::Note{std::move(text)}});
  };
  int more = 0;
  const bool is_first = totals_.empty();
  totals_.resize(verdicts.pairs.size());
  for (std::size_t i = 0; i < totals_.size(); ++i) {
    const review::PairClash& pair = verdicts.pairs[i];
    PairTotal& total = totals_[i];
    const bool was_broken = !is_first && core::BreaksPairRule(total.verdict, pair.demand.authorised_contact);
    if (was_broken) total.broken_s += verdicts.setting.time_s - since_s_;
    if (was_broken != IsBroken(pair) || (was_broken && total.verdict != pair.verdict)) {
      if (notes.size() < kMostNotes) {
        add(PairNoteOf(layout_, pair));
      } else {
        ++more;
      }
    }
    if (is_first || pair.at_least_mm < total.closest.at_least_mm) {
      total.closest = pair;
      total.closest_time_s = verdicts.setting.time_s;
    }
    total.verdict = pair.verdict;
    total.was_broken = total.was_broken || IsBroken(pair);
  }
  since_s_ = verdicts.setting.time_s;
  if (more > 0) add(fmt::format("{}{}", kMore, more));
  return notes;
}

std::vector<PairTotal> PairRecord::Totals(double end_s) const {
  std::vector<PairTotal> totals = totals_;
  for (PairTotal& total : totals)
    if (core::BreaksPairRule(total.verdict, total.closest.demand.authorised_contact))
      total.broken_s += end_s - since_s_;
  return totals;
}

}  // namespace elbowroom::control
