#include "app/control/study/study_comparisons.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>

#include "core/statistics/effect_size.h"
#include "core/statistics/several_tests.h"

namespace elbowroom::control {
namespace {

// The mean of a measure over each participant's sessions.
class Means {
 public:
  void Add(const std::string& participant, double value) { values_[participant].push_back(value); }
  [[nodiscard]] ByParticipant Take() const {
    ByParticipant means;
    for (const auto& [participant, values] : values_) means[participant] = core::Summarise(values).mean;
    return means;
  }

 private:
  std::map<std::string, std::vector<double>> values_;
};

std::vector<double> ValuesOf(const ByParticipant& means) {
  std::vector<double> values;
  for (const auto& [participant, value] : means) values.push_back(value);
  return values;
}

Comparison Compare(const std::string& measure, const ByCondition::value_type& a,
                   const ByCondition::value_type& b) {
  const std::vector<double> of_a = ValuesOf(a.second), of_b = ValuesOf(b.second);
  Comparison comparison{measure, a.first, b.first, core::Summarise(of_a), core::Summarise(of_b)};
  comparison.means = core::CompareMeans(comparison.of_a, comparison.of_b);
  comparison.effect_size = core::EffectSize(comparison.of_a, comparison.of_b);
  comparison.ranks = core::CompareRanks(of_a, of_b);
  comparison.in_both = static_cast<std::size_t>(
      std::ranges::count_if(a.second, [&](const auto& entry) { return b.second.contains(entry.first); }));
  // Both are in the order of the participants.
  if (comparison.in_both == of_a.size() && comparison.in_both == of_b.size())
    comparison.pairs = core::ComparePairs(of_a, of_b);
  return comparison;
}

// Sets a corrected p of each comparison that has one; all of them are one family.
void Correct(std::vector<Comparison>* comparisons,
             const std::function<std::optional<double>(const Comparison&)>& p_of,
             std::optional<double> Comparison::*corrected_p) {
  std::vector<double> p;
  for (const Comparison& comparison : *comparisons)
    if (const auto of = p_of(comparison)) p.push_back(*of);
  const std::vector<double> corrected = core::CorrectForSeveral(p);
  std::size_t next = 0;
  for (Comparison& comparison : *comparisons)
    if (p_of(comparison)) comparison.*corrected_p = corrected[next++];
}

std::optional<double> PairsOrMeans(const Comparison& comparison) {
  const auto& decides = comparison.pairs ? comparison.pairs : comparison.means;
  return decides ? std::optional(decides->p) : std::nullopt;
}

}  // namespace

std::map<std::string, ByCondition> MeansByCondition(const std::vector<StudySession>& sessions) {
  std::map<std::string, std::map<std::string, Means>> collected;
  for (const StudySession& session : sessions) {
    if (session.condition.empty()) continue;
    for (const auto& [measure, value] : session.measures)
      collected[measure][session.condition].Add(session.participant, value);
  }
  std::map<std::string, ByCondition> by_measure;
  for (const auto& [measure, by_condition] : collected)
    for (const auto& [condition, means] : by_condition) by_measure[measure][condition] = means.Take();
  return by_measure;
}

std::vector<BeyondBaseline> BeyondTheBaseline(const std::map<std::string, ByCondition>& measures,
                                              const std::string& baseline) {
  std::vector<BeyondBaseline> beyond;
  for (const auto& [measure, by_condition] : measures) {
    const auto base = by_condition.find(baseline);
    if (base == by_condition.end()) continue;
    for (const auto& [condition, by_participant] : by_condition) {
      if (condition == baseline) continue;
      for (const auto& [participant, value] : by_participant)
        if (const auto own = base->second.find(participant); own != base->second.end())
          beyond.push_back({participant, condition, measure, value, own->second});
    }
  }
  return beyond;
}

std::map<std::string, ByCondition> DifferencesByCondition(const std::vector<BeyondBaseline>& beyond) {
  std::map<std::string, ByCondition> by_measure;
  for (const BeyondBaseline& row : beyond)
    by_measure[row.measure][row.condition][row.participant] = row.difference();
  return by_measure;
}

std::vector<Comparison> CompareConditions(const std::map<std::string, ByCondition>& measures) {
  std::vector<Comparison> comparisons;
  for (const auto& [measure, by_condition] : measures)
    for (auto a = by_condition.begin(); a != by_condition.end(); ++a)
      for (auto b = std::next(a); b != by_condition.end(); ++b)
        comparisons.push_back(Compare(measure, *a, *b));
  Correct(
      &comparisons, [](const Comparison& c) { return c.means ? std::optional(c.means->p) : std::nullopt; },
      &Comparison::corrected_p);
  Correct(&comparisons, PairsOrMeans, &Comparison::decisive_p);
  return comparisons;
}

const Comparison* SurestOf(const std::vector<Comparison>& comparisons) {
  const Comparison* surest = nullptr;
  for (const Comparison& comparison : comparisons)
    if (comparison.decisive_p && (surest == nullptr || *comparison.decisive_p < *surest->decisive_p))
      surest = &comparison;
  return surest;
}

std::vector<MeasuresCorrelated> CorrelateWithNeed(const std::vector<StudySession>& sessions) {
  constexpr const char* kNeed = "needed_mm";
  std::map<std::string, Means> by_measure;
  for (const StudySession& session : sessions) {
    for (const auto& [measure, value] : session.measures) by_measure[measure].Add(session.participant, value);
    if (session.estimate_before_mm)
      by_measure["estimate_before_mm"].Add(session.participant, *session.estimate_before_mm);
  }
  std::vector<MeasuresCorrelated> correlated;
  const ByParticipant need = by_measure[kNeed].Take();
  for (const auto& [measure, means] : by_measure) {
    if (measure == kNeed || measure == "shortfall_mm") continue;  // the need is in it
    std::vector<double> a, b;
    for (const auto& [participant, value] : means.Take())
      if (const auto needed = need.find(participant); needed != need.end()) {
        a.push_back(value);
        b.push_back(needed->second);
      }
    if (const auto found = core::Correlate(a, b)) correlated.push_back({measure, kNeed, *found});
  }
  return correlated;
}

}  // namespace elbowroom::control
