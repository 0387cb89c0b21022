#include "core/findings/finding.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace elbowroom::core {
namespace {

// In the order of the enums.
constexpr std::array<std::string_view, 2> kKinds = {"touch", "near miss"};
constexpr std::array<std::string_view, 5> kStatuses = {"new", "active", "reviewed", "approved", "resolved"};
constexpr std::array<std::string_view, 3> kPresences = {"here", "gone", "not checked"};

template <typename Enum, std::size_t kCount>
std::optional<Enum> Parse(const std::array<std::string_view, kCount>& names, std::string_view text) {
  const auto name = std::ranges::find(names, text);
  if (name == names.end()) return std::nullopt;
  return static_cast<Enum>(std::distance(names.begin(), name));
}

std::string HashInHex(const std::string& text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::string_view ToString(FindingKind kind) { return kKinds.at(static_cast<std::size_t>(kind)); }
std::string_view ToString(ReviewStatus status) { return kStatuses.at(static_cast<std::size_t>(status)); }
std::string_view ToString(FindingPresence presence) {
  return kPresences.at(static_cast<std::size_t>(presence));
}

std::optional<FindingKind> ParseFindingKind(std::string_view text) {
  return Parse<FindingKind>(kKinds, text);
}
std::optional<ReviewStatus> ParseReviewStatus(std::string_view text) {
  return Parse<ReviewStatus>(kStatuses, text);
}

ReviewStatus Finding::status() const {
  for (auto remark = remarks.rbegin(); remark != remarks.rend(); ++remark)
    if (remark->status) return *remark->status;
  return ReviewStatus::kNew;
}

FindingId MakeFindingId(std::string_view first_recording_id, FindingKind kind, std::string_view part,
                        FrameIndex begin_frame) {
  const std::string what = fmt::format("{}|{}|{}|{}", first_recording_id, ToString(kind), begin_frame, part);
  return HashInHex(what);
}

bool IsId(std::string_view text) {
  return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::string RemarkId(const FindingId& finding, const ReviewRemark& remark) {
  if (!remark.exchange_id.empty()) return remark.exchange_id;
  return HashInHex(fmt::format("{}|{}|{}|{}|{}", finding, remark.at_utc, remark.by,
                               remark.status ? ToString(*remark.status) : "", remark.comment));
}

}  // namespace elbowroom::core
