#include "sessions/bcf/review_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "core/spelling.h"
#include "sessions/database/damage.h"

namespace elbowroom::sessions {
namespace {

using core::ReviewStatus;

// Ours, and what the programs of CAD teams call theirs.
std::optional<ReviewStatus> StatusFrom(std::string_view topic_status) {
  const std::string text = core::LowerCase(topic_status);
  if (const auto own = core::ParseReviewStatus(text)) return own;
  constexpr std::array<std::pair<std::string_view, ReviewStatus>, 9> kOthers = {{
      {"open", ReviewStatus::kActive},
      {"reopened", ReviewStatus::kActive},
      {"re-opened", ReviewStatus::kActive},
      {"in progress", ReviewStatus::kActive},
      {"inprogress", ReviewStatus::kActive},
      {"closed", ReviewStatus::kResolved},
      {"done", ReviewStatus::kResolved},
      {"solved", ReviewStatus::kResolved},
      {"fixed", ReviewStatus::kResolved},
  }};
  const auto other = std::ranges::find(kOthers, text, [](const auto& entry) { return entry.first; });
  return other == kOthers.end() ? std::nullopt : std::optional(other->second);
}

bool HasSaid(const core::Finding& finding, const TopicComment& comment) {
  return std::ranges::any_of(finding.remarks, [&](const core::ReviewRemark& remark) {
    return core::RemarkId(finding.id, remark) == comment.id ||
           (remark.at_utc == comment.at_utc && remark.by == comment.author && remark.comment == comment.text);
  });
}

// It keeps its id, so that the other program knows it again.
core::ReviewRemark RemarkOf(const TopicComment& comment) {
  core::ReviewRemark remark{comment.at_utc, comment.author, {}, comment.text};
  if (core::IsId(comment.id)) remark.exchange_id = comment.id;
  return remark;
}

std::string LastTime(const core::Finding& finding) {
  std::string last;
  for (const core::ReviewRemark& remark : finding.remarks) last = std::max(last, remark.at_utc);
  return last;
}

void TakeStatus(const BcfTopic& topic, const core::Finding& finding, ReviewImport* import) {
  const std::optional<ReviewStatus> status = StatusFrom(topic.status);
  if (!status) {
    import->notes.push_back(
        fmt::format("topic '{}' has the status '{}', which isn't one of ours; left as it is",
                    Quotable(topic.title), Quotable(topic.status)));
    return;
  }
  if (*status == finding.status()) return;
  const std::string at = topic.modified_at_utc.empty() ? topic.created_at_utc : topic.modified_at_utc;
  if (at < LastTime(finding)) {
    import->notes.push_back(
        fmt::format("topic '{}' is '{}' in the file since {}, but was changed here later; left as it is",
                    Quotable(topic.title), core::ToString(*status), Quotable(at)));
    return;
  }
  const std::string& by = topic.modified_by.empty() ? topic.created_by : topic.modified_by;
  import->remarks.push_back({finding.id, { at, by, status, "" }});
}

}  // namespace

std::string TopicStatusOf(ReviewStatus status) {
  std::string text(core::ToString(status));
  text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text;
}

ReviewImport RemarksFrom(std::span<const BcfTopic> topics, std::span<const core::Finding> findings) {
  std::map<std::string_view, const core::Finding*> by_id;
  for (const core::Finding& finding : findings) by_id.emplace(finding.id, &finding);
  ReviewImport import;
  for (const BcfTopic& topic : topics) {
    const auto found = by_id.find(topic.id);
    if (found == by_id.end()) {
      ++import.of_others;
      continue;
    }
    ++import.topics;
    const core::Finding& finding = *found->second;
    for (const TopicComment& comment : topic.comments)
      if (!comment.text.empty() && !HasSaid(finding, comment))
        import.remarks.push_back({finding.id, RemarkOf(comment)});
    TakeStatus(topic, finding, &import);
  }
  std::ranges::stable_sort(import.remarks, {}, [](const FindingRemark& said) { return said.remark.at_utc; });
  return import;
}

}  // namespace elbowroom::sessions
