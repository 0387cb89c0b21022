#include "tests/reporting/marked_section.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "core/error.h"
#include "core/system/whole_file.h"

namespace elbowroom::reporting {
namespace {

std::size_t OnlyPlaceOf(std::string_view document, std::string_view marker, std::string_view where) {
  const std::size_t place = document.find(marker);
  const bool is_there_once =
      place != std::string_view::npos && document.find(marker, place + 1) == std::string_view::npos;
  if (is_there_once) return place;
  throw core::Error(
      core::ErrorKind::kFormat,
      fmt::format("{}: the line '{}' must stand there exactly once; put it where the table belongs", where,
                  marker));
}

// Where a section's body begins, behind its first marker, and ends, before its second.
struct BodyPlace {
  std::size_t begin = 0, end = 0;
};

BodyPlace PlaceOf(std::string_view document, std::string_view name, std::string_view where) {
  const std::string begin_marker = fmt::format("<!-- bench:{} begin -->", name);
  const std::string end_marker = fmt::format("<!-- bench:{} end -->", name);
  const BodyPlace place{OnlyPlaceOf(document, begin_marker, where) + begin_marker.size(),
                        OnlyPlaceOf(document, end_marker, where)};
  if (place.begin <= place.end) return place;
  throw core::Error(core::ErrorKind::kFormat,
                    fmt::format("{}: '{}' stands before '{}'; swap them", where, end_marker, begin_marker));
}

}  // namespace

std::string SectionOf(std::string_view document, std::string_view name, std::string_view where) {
  const BodyPlace place = PlaceOf(document, name, where);
  return std::string(document.substr(place.begin, place.end - place.begin));
}

std::string WithSection(std::string_view document, std::string_view name, std::string_view body,
                        std::string_view where) {
  const BodyPlace place = PlaceOf(document, name, where);
  while (body.ends_with('\n')) body.remove_suffix(1);
  return fmt::format("{}\n\n{}\n\n{}", document.substr(0, place.begin), body, document.substr(place.end));
}

void WriteSection(const std::filesystem::path& file, std::string_view name, std::string_view body) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("{}: can't be read; run from a whole checkout", file.string()));
  }
  const std::string document{std::istreambuf_iterator<char>(stream), {}};
  core::WriteWholeFile(file, WithSection(document, name, body, file.string()));
}

}  // namespace elbowroom::reporting
