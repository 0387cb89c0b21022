// What reviewers say of touches and near misses, before it is written into a session.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/findings/finding.h"
#include "sessions/bcf/review_import.h"

namespace elbowroom::control {

// Throws: core::Error{kRange}: no name, or too long a name or comment.
void RequireFit(const core::ReviewRemark& remark);

// The name that the user of this program is logged in with; empty: it isn't known.
[[nodiscard]] std::string LoginName();

// What a BCF file that came back says of these findings of the session. Throws: what ReadBcfFile throws;
// core::Error{kRange}: none of its topics is one of them.
[[nodiscard]] sessions::ReviewImport ReadReview(const std::filesystem::path& bcf_file,
                                                const std::filesystem::path& session,
                                                std::span<const core::Finding> findings);

}  // namespace elbowroom::control
