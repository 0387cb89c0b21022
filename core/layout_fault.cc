#include "core/layout_fault.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/pairs_of_rule.h"
#include "core/plain_text.h"

namespace elbowroom::core {
namespace {

using Fault = std::optional<LayoutFault>;

// The Error that `validate` throws, as a fault of that entry.
template <typename Validate>
Fault Caught(LayoutEntry entry, std::size_t index, Validate validate) {
  try {
    validate();
  } catch (const Error& error) {
    return LayoutFault{entry, index, "", error.what()};
  }
  return std::nullopt;
}

Fault FaultOfPart(const Layout& layout, PartIndex i) {
  const Part& part = layout.parts[i];
  const auto fault = [&](const char* key, std::string message) {
    return LayoutFault{LayoutEntry::kPart, i, key, std::move(message)};
  };
  if (part.name.empty()) return fault("name", "a [[part]] has no name; give each one a name of its own");
  if (!IsPlain(part.name))
    return fault("name", fmt::format("the name of part {} has a line break or another control character; "
                                     "leave it out",
                                     i + 1));
  if (layout.FindPart(part.name) != i)
    return fault("name", fmt::format("two parts are named '{}'; names must differ", part.name));
  if (!part.mesh) return fault("file", fmt::format("part '{}' has no mesh", part.name));
  if (const auto broken = part.recovery.BrokenRule())
    return fault("recovery", fmt::format("part '{}': recovery: {}", part.name, *broken));
  return Caught(LayoutEntry::kPart, i,
                [&] { ValidateGivesWay(part.gives_way, fmt::format("part '{}'", part.name)); });
}

Fault FaultOfGroup(const Layout& layout, GroupIndex i) {
  const Group& group = layout.groups[i];
  const auto fault = [&](const char* key, std::string message) {
    return LayoutFault{LayoutEntry::kGroup, i, key, std::move(message)};
  };
  if (group.name.empty()) return fault("name", "a [[group]] has no name; give each one a name of its own");
  if (layout.FindPart(group.name))
    return fault("name",
                 fmt::format("group '{0}' is named as the part '{0}'; names must differ", group.name));
  if (layout.FindGroup(group.name) != i)
    return fault("name", fmt::format("two groups are named '{}'; names must differ", group.name));
  if (group.parts.empty())
    return fault("parts", fmt::format("group '{}' has no parts; name at least one", group.name));
  std::set<std::string> seen;
  for (const std::string& part : group.parts) {
    if (!layout.FindPart(part))
      return fault("parts", fmt::format("group '{}': no part is named '{}'; check the spelling of [[part]] "
                                        "names",
                                        group.name, part));
    if (!seen.insert(part).second)
      return fault("parts",
                   fmt::format("group '{}' names part '{}' twice; once is enough", group.name, part));
  }
  return std::nullopt;
}

// Nothing if the name is a part's or a group's.
std::optional<std::string> UnknownName(const Layout& layout, const std::string& name,
                                       const std::string& who) {
  if (layout.FindPart(name) || layout.FindGroup(name)) return std::nullopt;
  return fmt::format("{}: no part is named '{}'; check the spelling of [[part]] names", who, name);
}

Fault FaultOfSpacing(const Layout& layout, SpacingIndex i) {
  const Spacing& spacing = layout.spacings[i];
  const auto fault = [&](const char* key, std::string message) {
    return LayoutFault{LayoutEntry::kSpacing, i, key, std::move(message)};
  };
  const std::string who = fmt::format("spacing '{}'", spacing.name);
  if (layout.FindSpacing(spacing.name) != i)
    return fault("name", fmt::format("two spacings are named '{}'; names must differ", spacing.name));
  if (auto unknown = UnknownName(layout, spacing.moving, who)) return fault("moving", *std::move(unknown));
  if (auto unknown = UnknownName(layout, spacing.reference, who))
    return fault("reference", *std::move(unknown));
  if (layout.SharePart(spacing.moving, spacing.reference))
    return fault("reference", who + ": a part can't move against itself; name another reference");
  const auto ordered = [&](double lower_mm, double upper_mm) {
    return std::isfinite(lower_mm) && std::isfinite(upper_mm) && lower_mm <= upper_mm;
  };
  const auto out_of_order = [&](const char* key) {
    return fault(key, fmt::format("{}: min_mm <= initial_mm <= max_mm must hold, not {} <= {} <= {}", who,
                                  spacing.min_mm, spacing.initial_mm, spacing.max_mm));
  };
  if (!ordered(spacing.min_mm, spacing.max_mm)) return out_of_order("max_mm");
  if (!ordered(spacing.min_mm, spacing.initial_mm) || !ordered(spacing.initial_mm, spacing.max_mm))
    return out_of_order("initial_mm");
  for (SpacingIndex other = 0; other < i; ++other) {
    const Spacing& earlier = layout.spacings[other];
    if (earlier.axis == spacing.axis && layout.SharePart(earlier.moving, spacing.moving))
      return fault("moving",
                   fmt::format("{}: moves '{}' along {}, as spacing '{}' does; only one of them can be met",
                               who, spacing.moving, ToString(spacing.axis), earlier.name));
  }
  return std::nullopt;
}

// The fault of the spacing that closes a circle: the last in the layout of those that are in the circle.
Fault FaultOfCircle(const Layout& layout) {
  const std::vector<SpacingIndex> order = OrderOfPlacement(layout);
  if (order.size() == layout.spacings.size()) return std::nullopt;
  const std::set<SpacingIndex> placed(order.begin(), order.end());
  std::vector<SpacingIndex> way;  // each waits for the next
  SpacingIndex at = 0;
  while (placed.contains(at)) ++at;
  while (std::ranges::find(way, at) == way.end()) {
    way.push_back(at);
    const std::string& reference = layout.spacings[at].reference;
    at = 0;
    while (placed.contains(at) || !layout.SharePart(layout.spacings[at].moving, reference)) ++at;
  }
  way.erase(way.begin(), std::ranges::find(way, at));
  std::string names;
  for (const SpacingIndex i : way)
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", layout.spacings[i].name);
  return LayoutFault{LayoutEntry::kSpacing, *std::ranges::max_element(way), "reference",
                     fmt::format("the spacings {} are circular: each part must hang, through its references, "
                                 "on one that doesn't move",
                                 names)};
}

Fault FaultOfPair(const Layout& layout, std::size_t i) {
  const PairRule& rule = layout.pair_rules[i];
  if (rule.a == rule.b && layout.FindPart(rule.a))
    return LayoutFault{
        LayoutEntry::kPair, i, "b",
        fmt::format("[[pair]] '{0}' and '{0}': a part has no clearance to itself; name two parts", rule.a)};
  if (auto unknown = UnknownName(layout, rule.a, "[[pair]]"))
    return LayoutFault{LayoutEntry::kPair, i, "a", *std::move(unknown)};
  if (auto unknown = UnknownName(layout, rule.b, "[[pair]]"))
    return LayoutFault{LayoutEntry::kPair, i, "b", *std::move(unknown)};
  return std::nullopt;
}

// A rule for groups becomes one rule for each pair of their parts, so the number of these is limited.
Fault FaultOfManyPairs(const Layout& layout) {
  constexpr std::size_t kMostPairs = 500'000;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < layout.pair_rules.size(); ++i) {
    const PairRule& rule = layout.pair_rules[i];
    pairs += layout.PartsNamed(rule.a).size() * layout.PartsNamed(rule.b).size();
    if (pairs > kMostPairs)
      return LayoutFault{
          LayoutEntry::kPair, i, "",
          fmt::format("'{}' and '{}': with this [[pair]] more than {} pairs of parts have a rule; "
                      "name smaller groups",
                      rule.a, rule.b, kMostPairs)};
  }
  return std::nullopt;
}

// The first rule for a pair of parts that has an earlier rule already, if both name equally many of the two
// as parts and no third rule names more.
Fault FaultOfTwoRules(const Layout& layout) {
  std::map<std::pair<PartIndex, PartIndex>, std::vector<std::pair<int, std::size_t>>> rules_of_pair;
  for (std::size_t i = 0; i < layout.pair_rules.size(); ++i) {
    const PairsOfRule rule = PairsOf(layout, layout.pair_rules[i]);
    for (const auto& pair : rule.pairs) rules_of_pair[pair].emplace_back(-rule.parts_named, i);
  }
  Fault fault;
  for (auto& [pair, rules] : rules_of_pair) {
    std::ranges::sort(rules);
    if (rules.size() < 2 || rules[0].first != rules[1].first) continue;
    const std::size_t i = rules[1].second;
    if (fault && fault->index <= i) continue;
    const PairRule &rule = layout.pair_rules[i], &earlier = layout.pair_rules[rules[0].second];
    fault = LayoutFault{LayoutEntry::kPair, i, "",
                        fmt::format("'{}' and '{}': '{}' and '{}' have a rule already, by the [[pair]] "
                                    "'{}' and '{}'; keep one of them",
                                    rule.a, rule.b, layout.parts[pair.first].name,
                                    layout.parts[pair.second].name, earlier.a, earlier.b)};
  }
  return fault;
}

Fault FaultOfStream(const Layout& layout, std::size_t i) {
  const std::string& name = layout.streams[i].name;
  for (std::size_t other = 0; other < i; ++other) {
    if (layout.streams[other].name == name)
      return LayoutFault{LayoutEntry::kStream, i, "name",
                         fmt::format("two streams are named '{}'; names must differ", name)};
  }
  return Caught(LayoutEntry::kStream, i, [&] { ValidateStream(layout.streams[i]); });
}

// The first fault that `of_one` finds.
template <typename OfOne>
Fault FirstOf(const Layout& layout, std::size_t count, OfOne of_one) {
  for (std::size_t i = 0; i < count; ++i)
    if (Fault fault = of_one(layout, i)) return fault;
  return std::nullopt;
}

}  // namespace

std::optional<LayoutFault> FindLayoutFault(const Layout& layout) {
  if (auto fault = FirstOf(layout, layout.parts.size(), FaultOfPart)) return fault;
  if (auto fault = FirstOf(layout, layout.groups.size(), FaultOfGroup)) return fault;
  if (auto fault = FirstOf(layout, layout.spacings.size(), FaultOfSpacing)) return fault;
  if (auto fault = FirstOf(layout, layout.streams.size(), FaultOfStream)) return fault;
  if (auto fault = FirstOf(layout, layout.pair_rules.size(), FaultOfPair)) return fault;
  if (auto fault = FaultOfManyPairs(layout)) return fault;
  if (auto fault = FaultOfTwoRules(layout)) return fault;
  return FaultOfCircle(layout);
}

}  // namespace elbowroom::core
