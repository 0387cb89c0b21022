#include "app/cli/options/file_ending.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.h"

namespace elbowroom::cli {

void CheckEnding(const char* option, const std::filesystem::path& file,
                 std::initializer_list<const char*> endings) {
  if (file.empty()) return;
  if (std::ranges::any_of(endings, [&](const char* ending) { return file.extension() == ending; })) return;
  throw core::Error(core::ErrorKind::kFile,
                    fmt::format("{} '{}': is written as {} alone; choose a name that ends so", option,
                                file.string(), fmt::join(endings, " or ")));
}

}  // namespace elbowroom::cli
