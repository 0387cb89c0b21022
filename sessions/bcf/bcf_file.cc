#include "sessions/bcf/bcf_file.h"

#include <fmt/format.h>
#include <zip.h>

#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "sessions/bcf/bcf_xml.h"

namespace elbowroom::sessions {
namespace {

using core::Error;
using core::ErrorKind;

// Limits of what is read: far beyond a review, and small enough for any machine.
constexpr zip_int64_t kMostEntries = 200'000;
constexpr zip_uint64_t kLongestMarkup = 16 << 20;
constexpr std::size_t kMostBytes = std::size_t{512} << 20;  // of all markups together

struct CloseArchive {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
using Archive = std::unique_ptr<zip_t, CloseArchive>;

[[noreturn]] void FailToPack(std::string_view why) {
  throw Error(ErrorKind::kFile, fmt::format("the BCF file can't be packed: {}", why));
}

// An archive in memory. libzip reads what is added only when the archive is closed, so that all of it stays
// here until then.
class Packing {
 public:
  Packing() {
    zip_error_t error;
    zip_error_init(&error);
    source_ = zip_source_buffer_create(nullptr, 0, 0, &error);
    if (source_ == nullptr) FailToPack(zip_error_strerror(&error));
    zip_source_keep(source_);
    archive_.reset(zip_open_from_source(source_, ZIP_TRUNCATE, &error));
    if (!archive_) {
      zip_source_free(source_);
      zip_source_free(source_);
      FailToPack(zip_error_strerror(&error));
    }
  }
  ~Packing() {
    archive_.reset();
    zip_source_free(source_);
  }
  Packing(const Packing&) = delete;
  Packing& operator=(const Packing&) = delete;

  void Add(const std::string& name, std::string content, bool is_packed_already = false) {
    contents_.push_back(std::make_unique<std::string>(std::move(content)));
    zip_source_t* source =
        zip_source_buffer(archive_.get(), contents_.back()->data(), contents_.back()->size(), 0);
    const zip_int64_t entry =
        source == nullptr ? -1 : zip_file_add(archive_.get(), name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (entry < 0) {
      zip_source_free(source);
      FailToPack(zip_strerror(archive_.get()));
    }
    const auto index = static_cast<zip_uint64_t>(entry);
    // One time for all files: the same topics give the same bytes.
    constexpr zip_uint16_t kTime = 0, kDate = (1 << 5) | 1;  // 1980-01-01, in the form of DOS
    zip_file_set_dostime(archive_.get(), index, kTime, kDate, 0);
    if (is_packed_already) zip_set_file_compression(archive_.get(), index, ZIP_CM_STORE, 0);
  }

  std::string Bytes() {
    if (zip_close(archive_.get()) != 0) FailToPack(zip_strerror(archive_.get()));
    (void)archive_.release();
    zip_stat_t stat;
    if (zip_source_stat(source_, &stat) != 0 || zip_source_open(source_) != 0)
      FailToPack(zip_error_strerror(zip_source_error(source_)));
    std::string bytes(stat.size, '\0');
    const zip_int64_t got = zip_source_read(source_, bytes.data(), bytes.size());
    zip_source_close(source_);
    if (got != static_cast<zip_int64_t>(bytes.size())) FailToPack("it is cut short");
    return bytes;
  }

 private:
  zip_source_t* source_ = nullptr;
  Archive archive_;
  std::vector<std::unique_ptr<std::string>> contents_;
};

Archive OpenArchive(const std::filesystem::path& path) {
  int code = 0;
  zip_t* archive = zip_open(path.c_str(), ZIP_RDONLY, &code);
  if (archive != nullptr) return Archive(archive);
  if (code == ZIP_ER_NOENT || code == ZIP_ER_OPEN || code == ZIP_ER_READ)
    throw Error(ErrorKind::kFile, fmt::format("{}: can't be read; check the path", path.string()));
  throw Error(ErrorKind::kFormat,
              fmt::format("{}: it is no BCF file (no zip); export it again", path.string()));
}

// Nothing where there is no such entry.
std::optional<std::string> ContentOf(zip_t* archive, zip_uint64_t index, const std::string& where) {
  zip_stat_t stat;
  if (zip_stat_index(archive, index, 0, &stat) != 0) return std::nullopt;
  if (stat.size > kLongestMarkup)
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: it has {} bytes, which no markup has", where, stat.size));
  std::string content(stat.size, '\0');
  zip_file_t* file = zip_fopen_index(archive, index, 0);
  const zip_int64_t got = file == nullptr ? -1 : zip_fread(file, content.data(), content.size());
  // Reading beyond the end compares the checksum.
  char beyond = 0;
  const bool is_whole = got == static_cast<zip_int64_t>(content.size()) && zip_fread(file, &beyond, 1) == 0;
  if (file != nullptr) zip_fclose(file);
  if (!is_whole)
    throw Error(ErrorKind::kFormat, fmt::format("{}: it is damaged; export the file again", where));
  return content;
}

void RequireKnownVersion(zip_t* archive, const std::filesystem::path& path) {
  const zip_int64_t entry = zip_name_locate(archive, "bcf.version", 0);
  const std::string where = fmt::format("{}: bcf.version", path.string());
  const auto xml = entry < 0 ? std::nullopt : ContentOf(archive, static_cast<zip_uint64_t>(entry), where);
  if (!xml)
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: it is no BCF file (it has no bcf.version); export it again", path.string()));
  const std::string version = VersionFromXml(*xml, where);
  if (version != "2.1" && version != "2.0")
    throw Error(ErrorKind::kFormat, fmt::format("{}: it is of BCF version '{}'; export it as version 2.1",
                                                path.string(), version));
}

}  // namespace

std::string PackBcf(std::span<const BcfTopic> topics) {
  Packing packing;
  packing.Add("bcf.version", VersionXml());
  for (const BcfTopic& topic : topics) {
    const std::string folder = GuidFrom(topic.id) + "/";
    packing.Add(folder + "markup.bcf", MarkupXml(topic));
    if (!topic.camera) continue;
    packing.Add(folder + "viewpoint.bcfv", ViewpointXml(topic));
    if (!topic.snapshot_png.empty())
      packing.Add(folder + "snapshot.png", {topic.snapshot_png.begin(), topic.snapshot_png.end()}, true);
  }
  return packing.Bytes();
}

std::vector<BcfTopic> ReadBcfFile(const std::filesystem::path& path) {
  const Archive archive = OpenArchive(path);
  RequireKnownVersion(archive.get(), path);
  const zip_int64_t entries = zip_get_num_entries(archive.get(), 0);
  std::size_t bytes = 0;
  std::vector<BcfTopic> topics;
  for (zip_int64_t i = 0; i < entries; ++i) {
    const char* name = zip_get_name(archive.get(), static_cast<zip_uint64_t>(i), 0);
    if (name == nullptr || !std::string_view(name).ends_with("/markup.bcf")) continue;
    const std::string where = fmt::format("{}: {}", path.string(), name);
    const auto xml = ContentOf(archive.get(), static_cast<zip_uint64_t>(i), where);
    bytes += xml ? xml->size() : 0;
    if (bytes > kMostBytes || i > kMostEntries)
      throw Error(ErrorKind::kFormat, fmt::format("{}: it holds more than any review does", path.string()));
    if (xml) topics.push_back(TopicFromXml(*xml, where));
  }
  return topics;
}

}  // namespace elbowroom::sessions
