#include "app/control/reviewing/review_remarks.h"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <vector>

#include "core/error.h"
#include "sessions/bcf/bcf_file.h"

namespace elbowroom::control {
namespace {

// A comment is a note, no document. Reports show all of it.
constexpr std::size_t kLongestCommentBytes = 64 * 1024;
constexpr std::size_t kLongestNameBytes = 200;

}  // namespace

void RequireFit(const core::ReviewRemark& remark) {
  if (remark.by.empty() || remark.by.size() > kLongestNameBytes)
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("give the name of who says it (--by), of at most {} bytes", kLongestNameBytes));
  if (remark.comment.size() > kLongestCommentBytes)
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("the comment (--comment) has {} bytes, and a session takes {}; shorten it",
                                  remark.comment.size(), kLongestCommentBytes));
}

std::string LoginName() {
  const passwd* user = ::getpwuid(::getuid());
  return user != nullptr && user->pw_name != nullptr ? user->pw_name : "";
}

sessions::ReviewImport ReadReview(const std::filesystem::path& bcf_file, const std::filesystem::path& session,
                                  std::span<const core::Finding> findings) {
  const std::vector<sessions::BcfTopic> topics = sessions::ReadBcfFile(bcf_file);
  sessions::ReviewImport import = sessions::RemarksFrom(topics, findings);
  if (import.topics > 0) return import;
  throw core::Error(core::ErrorKind::kRange,
                    fmt::format("{}: none of its {} topics is a touch or near miss of session '{}'; give the "
                                "session that it was made from",
                                bcf_file.string(), topics.size(), session.string()));
}

}  // namespace elbowroom::control
