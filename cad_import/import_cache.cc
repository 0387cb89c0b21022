#include "cad_import/import_cache.h"

#include <fmt/format.h>
#include <Standard_Version.hxx>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "cad_import/mapped_file.h"
#include "cad_import/model/file_unit.h"
#include "core/error.h"
#include "core/system/whole_file.h"

namespace elbowroom::cad_import {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".cad";

std::string Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool AreUnchanged(std::span<const ReferredFile> referred, const fs::path& folder) {
  return std::ranges::all_of(referred, [&](const ReferredFile& file) {
    std::error_code error;
    return fs::is_regular_file(folder / file.path, error) && HashOfFile(folder / file.path) == file.hash;
  });
}

}  // namespace

ImportCache::ImportCache(fs::path folder, std::int64_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {}

std::optional<ImportCache> ImportCache::OfUser() {
  if (const std::string folder = Variable("ELBOWROOM_CACHE"); !folder.empty()) {
    if (folder == "off") return std::nullopt;
    return ImportCache(folder);
  }
  for (const auto& [base, below] : {std::pair("XDG_CACHE_HOME", ""), std::pair("HOME", ".cache")})
    if (const std::string folder = Variable(base); !folder.empty())
      return ImportCache(fs::path(folder) / below / "elbowroom/import");
  return std::nullopt;
}

std::string ImportCache::KeyOf(const fs::path& file, const ImportOptions& options) {
  const std::string text =
      fmt::format("{} {} {} {} {:a} {} {}", kPackedModelVersion, HashOfFile(file), file.filename().string(),
                  NameOrDash(options.unit) + NameOrDash(options.unit_if_file_has_none),
                  options.tolerance_mm.value_or(0.0), OCC_VERSION_COMPLETE, ASSIMP_VERSION);
  return HashOf(std::as_bytes(std::span(text)));
}

std::optional<CadModel> ImportCache::Find(const std::string& key, const fs::path& file) const {
  try {
    // Entries are replaced by others, never written to.
    const std::optional<MappedFile> entry = MappedFile::At(PathOf(key));
    if (!entry) return std::nullopt;
    PackedModel packed = Unpack(entry->bytes(), PathOf(key).string());
    if (!AreUnchanged(packed.referred, fs::weakly_canonical(file).parent_path())) return std::nullopt;
    std::error_code ignored;
    fs::last_write_time(PathOf(key), fs::file_time_type::clock::now(), ignored);  // as the oldest go first
    return std::move(packed.model);
  } catch (const core::Error&) {
    return std::nullopt;  // damaged: it is made again
  }
}

void ImportCache::Keep(const std::string& key, std::span<const std::byte> packed) const {
  if (static_cast<std::int64_t>(packed.size()) > most_bytes_ / 4) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return;
  try {
    core::WriteWholeFile(PathOf(key), {reinterpret_cast<const char*>(packed.data()), packed.size()});
    DropOldest();
  } catch (const core::Error&) {
    // A full disk, or no permission to write: the next import takes as long as this one.
  }
}

fs::path ImportCache::PathOf(const std::string& key) const { return folder_ / (key + kExtension); }

void ImportCache::DropOldest() const {
  struct Entry {
    fs::file_time_type used;
    std::int64_t bytes;
    fs::path path;
  };
  std::vector<Entry> entries;
  std::int64_t sum = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    if (entry.path().extension() != kExtension) continue;
    const auto bytes = entry.file_size(error);
    const auto used = error ? fs::file_time_type{} : entry.last_write_time(error);
    if (error) continue;  // another program has dropped it
    entries.push_back({used, static_cast<std::int64_t>(bytes), entry.path()});
    sum += entries.back().bytes;
  }
  std::ranges::sort(entries, {}, &Entry::used);
  for (const Entry& entry : entries) {
    if (sum <= most_bytes_) return;
    fs::remove(entry.path, error);
    sum -= entry.bytes;
  }
}

}  // namespace elbowroom::cad_import
