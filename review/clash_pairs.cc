#include "review/clash_pairs.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/spelling.h"

namespace elbowroom::review {
namespace {

using core::PartIndex;

[[noreturn]] void Fail(const std::string& message) { throw core::Error(core::ErrorKind::kRange, message); }

PartIndex PartNamed(const core::Layout& layout, const std::string& name) {
  if (const auto part = layout.FindPart(name)) return *part;
  std::vector<std::string_view> known;
  for (const core::Part& part : layout.parts) known.emplace_back(part.name);
  Fail(fmt::format("no part is named '{}'; {}", name,
                   core::SpellingAdvice(name, known, "use the name of a [[part]]")));
}

// One flag a part.
std::vector<bool> Members(const core::Layout& layout, const std::vector<std::string>& names) {
  std::vector<bool> is_member(layout.parts.size(), false);
  for (const std::string& name : names) is_member[PartNamed(layout, name)] = true;
  return is_member;
}

void RequireClearance(double required_mm, const std::string& whose) {
  if (!std::isfinite(required_mm) || required_mm < 0.0)
    Fail(fmt::format("{}: the required clearance must be 0 mm or more, not {}", whose, required_mm));
}

using RuleOfPair = std::map<std::pair<PartIndex, PartIndex>, const core::PairRule*>;

RuleOfPair RulesOf(const core::Layout& layout) {
  RuleOfPair rules;
  for (const core::PairRule& rule : layout.pair_rules) {
    const std::string whose = fmt::format("[[pair]] '{}' and '{}'", rule.a, rule.b);
    const PartIndex a = PartNamed(layout, rule.a), b = PartNamed(layout, rule.b);
    if (a == b) Fail(whose + ": a part has no clearance to itself; name two parts");
    RequireClearance(rule.required_clearance_mm, whose);
    if (!rules.emplace(std::minmax(a, b), &rule).second) Fail(whose + ": has two rules; keep one of them");
  }
  return rules;
}

// Whether the pair of two parts is selected.
class Selector {
 public:
  Selector(const core::Layout& layout, const PairSelection& selection)
      : within_(Members(layout, selection.within)),
        between_(Members(layout, selection.between)),
        and_these_(Members(layout, selection.and_these)),
        is_within_(!selection.within.empty()),
        is_between_(!selection.between.empty()) {
    if (is_between_ == selection.and_these.empty())
      Fail("a selection between parts has two sides; name the parts of both");
    if (is_within_ && is_between_)
      Fail("parts are selected either within one set or between two; choose one");
  }

  [[nodiscard]] bool Takes(PartIndex a, PartIndex b) const {
    if (is_within_) return within_[a] && within_[b];
    if (is_between_) return (between_[a] && and_these_[b]) || (between_[b] && and_these_[a]);
    return true;
  }

 private:
  std::vector<bool> within_;
  std::vector<bool> between_;
  std::vector<bool> and_these_;
  bool is_within_ = false;
  bool is_between_ = false;
};

}  // namespace

PairMatrix PairsOf(const core::Layout& layout, const PairSelection& selection, double required_mm) {
  RequireClearance(required_mm, "pairs without a rule");
  const Selector selector(layout, selection);
  const RuleOfPair rules = RulesOf(layout);
  PairMatrix matrix;
  for (PartIndex a = 0; a < layout.parts.size(); ++a) {
    for (PartIndex b = a + 1; b < layout.parts.size(); ++b) {
      if (!selector.Takes(a, b)) continue;
      const auto found = rules.find({a, b});
      if (found == rules.end()) {
        matrix.pairs.push_back({a, b, required_mm, false});
      } else if (found->second->ignore) {
        ++matrix.ignored;
      } else {
        const core::PairRule& rule = *found->second;
        matrix.pairs.push_back({a, b, rule.required_clearance_mm, rule.authorised_contact});
      }
    }
  }
  return matrix;
}

}  // namespace elbowroom::review
