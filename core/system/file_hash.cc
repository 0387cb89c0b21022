#include "core/system/file_hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/progress.h"

namespace elbowroom::core {

std::array<std::byte, 16> HashOfFile(const std::filesystem::path& path, const std::stop_token& stop) {
  constexpr std::size_t kPieceBytes = 1 << 20;
  const auto fail = [&] {
    throw Error(ErrorKind::kFile, fmt::format("{}: can't be read; check that it is there", path.string()));
  };
  std::error_code ignored;
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path, ignored)) fail();
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  XXH3_128bits_reset(state.get());
  std::vector<char> piece(kPieceBytes);
  while (file) {
    ThrowIfStopped(stop, fmt::format("reading '{}'", path.string()));
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    XXH3_128bits_update(state.get(), piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) fail();
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state.get()));
  std::array<std::byte, 16> hash{};
  static_assert(sizeof canonical == sizeof hash);
  std::memcpy(hash.data(), &canonical, sizeof hash);
  return hash;
}

}  // namespace elbowroom::core
