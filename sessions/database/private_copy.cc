#include "sessions/database/private_copy.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "core/error.h"
#include "sessions/database/session_files.h"

namespace elbowroom::sessions {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void FailToCopy(const fs::path& session, const fs::path& folder, const std::string& why) {
  throw core::Error(core::ErrorKind::kFile,
                    fmt::format("session '{}': it can't be put right in its place, so it is read from a "
                                "copy, which can't be made in '{}': {}; free some space there, or set TMPDIR",
                                session.string(), folder.string(), why));
}

}  // namespace

PrivateCopy::PrivateCopy(fs::path original) : original_(std::move(original)) {
  const fs::path parent = fs::temp_directory_path();
  std::string pattern = (parent / "elbowroom-session-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) FailToCopy(original_, parent, std::strerror(errno));
  folder_ = pattern;
  try {
    for (const fs::path& database : {original_, WithSuffix(original_, kSpillSuffix)}) {
      for (const std::string_view suffix : {std::string_view(), kLogSuffix, kRollbackSuffix})
        CopyFile(WithSuffix(database, suffix));
    }
  } catch (...) {
    fs::remove_all(folder_);
    throw;
  }
}

PrivateCopy::~PrivateCopy() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void PrivateCopy::CopyFile(const fs::path& from) const {
  std::error_code failure;
  if (!fs::exists(from, failure)) return;
  const fs::path to = folder_ / from.filename();
  fs::copy_file(from, to, failure);
  if (!failure) fs::permissions(to, fs::perms::owner_read | fs::perms::owner_write, failure);
  if (failure) FailToCopy(original_, folder_, failure.message());
}

}  // namespace elbowroom::sessions
