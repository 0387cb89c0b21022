#include "app/control/study/study_block.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "core/error.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

std::vector<std::filesystem::path> SessionsOfBlock(std::span<const std::filesystem::path> sessions,
                                                   const std::string& block, const std::stop_token& stop) {
  std::vector<std::filesystem::path> kept;
  std::set<std::string> blocks;
  for (const std::filesystem::path& path : sessions) {
    const std::string of = sessions::SessionReader(path, stop).header().trial.block;
    if (of == block) kept.push_back(path);
    if (!of.empty()) blocks.insert(of);
  }
  if (!kept.empty()) return kept;
  throw core::Error(
      core::ErrorKind::kRange,
      blocks.empty()
          ? fmt::format("no session is of block '{}': none names a block; leave --block out", block)
          : fmt::format("no session is of block '{}'; choose one that there is: '{}'", block,
                        fmt::join(blocks, "', '")));
}

std::string LeftOutNote(std::size_t kept, std::size_t sessions, const std::string& block) {
  if (kept == sessions) return "";
  return fmt::format("{} of {} sessions are of another block than '{}', or of none: they are left out",
                     sessions - kept, sessions, block);
}

}  // namespace elbowroom::control
