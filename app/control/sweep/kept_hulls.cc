#include "app/control/sweep/kept_hulls.h"

#include <tbb/parallel_for.h>
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <string_view>
#include <utility>

#include "app/control/sweep/sweep_cells.h"
#include "core/error.h"
#include "core/system/file_sync.h"
#include "core/system/whole_file.h"
#include "recon/contours/contour_map.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFormat = "elbowroom-hulls-1\n";  // a file begins with it; then records follow

// Before the packed bytes of one contour.
struct RecordHeader {
  std::array<std::uint64_t, 2> key;
  std::uint64_t bytes;
};

std::string_view BytesOf(const RecordHeader& header) {
  return {reinterpret_cast<const char*>(&header), sizeof header};
}

using HashState = std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)>;

std::array<std::uint64_t, 2> HashOf(std::uint64_t camera, const core::SoftMask& soft_mask) {
  const HashState state(XXH3_createState(), &XXH3_freeState);
  XXH3_128bits_reset(state.get());
  const auto add = [&](auto items) { XXH3_128bits_update(state.get(), items.data(), items.size_bytes()); };
  const std::array<std::uint64_t, 1> of_camera{camera};
  add(std::span(of_camera));
  add(std::span(soft_mask.mask.words()));
  add(std::span(soft_mask.levels));
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  return {hash.high64, hash.low64};
}

}  // namespace

std::string Packed(const recon::ContourMap& contour) {
  constexpr int kLevel = 1;  // quick, and little larger than what level 3 makes
  const std::string bytes = contour.Bytes();
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress2(context.get(), packed.data(), packed.size(), bytes.data(), bytes.size());
  core::Require(ZSTD_isError(size) == 0U, "zstd packs what fits its own bound");
  packed.resize(size);
  return packed;
}

std::shared_ptr<const recon::ContourMap> Unpacked(const std::string& packed) {
  constexpr std::uint64_t kLargest = std::uint64_t{1} << 30U;  // far beyond the grid of any picture
  const std::uint64_t size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size > kLargest) return nullptr;  // and what isn't known
  std::string bytes(size, '\0');
  if (ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size()) != size) return nullptr;
  return recon::ContourMap::FromBytes(bytes);
}

KeptHulls::KeptHulls(fs::path folder) : folder_(std::move(folder)) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder_, none))
    // A file that is being written has an extension.
    if (entry.is_regular_file() && !entry.path().has_extension()) AddFile(entry.path());
}

void KeptHulls::AddFile(const fs::path& path) {
  std::error_code none;
  const auto size = static_cast<std::int64_t>(fs::file_size(path, none));
  std::ifstream file(path, std::ios::binary);
  std::string format(kFormat.size(), '\0');
  if (!file.read(format.data(), std::ssize(format)) || format != kFormat) return;
  std::int64_t offset = std::ssize(kFormat);
  RecordHeader header;
  while (file.seekg(offset) && file.read(reinterpret_cast<char*>(&header), sizeof header)) {
    offset += static_cast<std::int64_t>(sizeof header);
    if (header.bytes > static_cast<std::uint64_t>(size - offset)) return;
    const auto bytes = static_cast<std::int64_t>(header.bytes);
    places_.emplace(header.key, Place{path, offset, bytes});
    offset += bytes;
  }
}

std::string KeptHulls::ReadPacked(const Key& key) const {
  if (const auto waiting = waiting_.find(key); waiting != waiting_.end()) return waiting->second;
  const auto place = places_.find(key);
  if (place == places_.end()) return "";
  std::string packed(static_cast<std::size_t>(place->second.bytes), '\0');
  std::ifstream file(place->second.file, std::ios::binary);
  if (!file.seekg(place->second.offset) || !file.read(packed.data(), std::ssize(packed))) return "";
  return packed;
}

bool KeptHulls::Complete(std::span<const std::shared_ptr<const recon::Silhouette>> silhouettes) {
  // Where a camera sees nothing, no contour is needed (recon::VisualHull).
  const auto excludes_all = [](const std::shared_ptr<const recon::Silhouette>& silhouette) {
    return !silhouette->shows_object() && !silhouette->exterior_is_object();
  };
  if (std::ranges::any_of(silhouettes, excludes_all)) return true;
  std::vector<std::pair<Key, std::string>> made(silhouettes.size());
  tbb::parallel_for(std::size_t{0}, silhouettes.size(), [&](std::size_t i) {
    const recon::Silhouette& silhouette = *silhouettes[i];
    if (silhouette.is_traced()) return;  // the last frame's
    const Key key = HashOf(i, silhouette.soft_mask());
    const std::string packed = ReadPacked(key);
    auto labels = packed.empty() ? nullptr : Unpacked(packed);
    if (labels) {
      silhouette.TakeLabels(std::move(labels));
    } else {
      made[i] = {key, Packed(silhouette.labels())};
    }
  });
  bool all_kept = true;
  for (auto& [key, packed] : made) {
    if (packed.empty()) continue;
    all_kept = false;
    waiting_.insert_or_assign(key, std::move(packed));
  }
  return all_kept;
}

void KeptHulls::Write() {
  if (waiting_.empty()) return;
  core::MakeFolder(folder_);
  std::string bytes(kFormat);
  std::string keys;
  std::vector<std::pair<Key, Place>> places;
  for (const auto& [key, packed] : waiting_) {
    const RecordHeader header{key, packed.size()};
    bytes += BytesOf(header);
    keys += BytesOf(header);
    places.push_back({key, {{}, std::ssize(bytes), std::ssize(packed)}});
    bytes += packed;
  }
  const fs::path file = folder_ / HashOfText(keys);
  core::WriteWholeFile(file, bytes);
  for (auto& [key, place] : places) {
    place.file = file;
    places_.insert_or_assign(key, std::move(place));
  }
  waiting_.clear();
}

}  // namespace elbowroom::control
