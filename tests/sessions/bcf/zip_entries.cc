#include "tests/sessions/bcf/zip_entries.h"

#include <zip.h>

#include <stdexcept>

namespace elbowroom::tests {

std::map<std::string, std::string> ZipEntries(const std::filesystem::path& path) {
  int code = 0;
  zip_t* archive = zip_open(path.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &code);
  if (archive == nullptr) throw std::runtime_error("no zip: " + path.string());
  std::map<std::string, std::string> entries;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive, 0); ++i) {
    zip_stat_t stat;
    zip_stat_index(archive, static_cast<zip_uint64_t>(i), 0, &stat);
    std::string content(stat.size, '\0');
    zip_file_t* file = zip_fopen_index(archive, static_cast<zip_uint64_t>(i), 0);
    if (zip_fread(file, content.data(), content.size()) != static_cast<zip_int64_t>(content.size()))
      throw std::runtime_error("damaged zip: " + path.string());
    zip_fclose(file);
    entries.emplace(stat.name, content);
  }
  zip_discard(archive);
  return entries;
}

void WriteZip(const std::filesystem::path& path, const std::map<std::string, std::string>& entries) {
  int code = 0;
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (archive == nullptr) throw std::runtime_error("can't write: " + path.string());
  for (const auto& [name, content] : entries)
    zip_file_add(archive, name.c_str(), zip_source_buffer(archive, content.data(), content.size(), 0),
                 ZIP_FL_ENC_UTF_8);
  if (zip_close(archive) != 0) throw std::runtime_error("can't write: " + path.string());
}

}  // namespace elbowroom::tests
