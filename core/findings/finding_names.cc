#include "core/findings/finding_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/plain_text.h"

namespace elbowroom::core {
namespace {

constexpr std::size_t kShortestBeginning = 4;

bool IsNamed(const Finding& finding, std::string_view text) {
  if (text.size() >= kShortestBeginning && finding.id.starts_with(text)) return true;
  if (finding.presence != FindingPresence::kHere) return false;
  return text == NameOf(finding) ||
         (finding.kind == FindingKind::kTouch && text == std::to_string(finding.number));
}

}  // namespace

std::string NameOf(const Finding& finding) {
  const std::string kind(ToString(finding.kind));
  return finding.presence == FindingPresence::kHere ? fmt::format("{} {}", kind, finding.number) : kind;
}

const Finding& FindFinding(std::span<const Finding> findings, std::string_view text) {
  std::vector<const Finding*> named;
  for (const Finding& finding : findings)
    if (IsNamed(finding, text)) named.push_back(&finding);
  if (named.size() == 1) return *named.front();
  if (named.empty())
    throw Error(ErrorKind::kRange,
                fmt::format("no touch or near miss is named '{}'; 'elbowroom touches' lists their ids",
                            MadeVisible(text)));
  throw Error(ErrorKind::kRange, fmt::format("'{}' names {} touches and near misses, among them {} and {}; "
                                             "give the whole id",
                                             MadeVisible(text), named.size(), named[0]->id, named[1]->id));
}

}  // namespace elbowroom::core
