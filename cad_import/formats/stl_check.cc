#include "cad_import/formats/stl_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>

#include "cad_import/formats/malformed_file.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

constexpr std::uint64_t kStlHeaderBytes = 84;
constexpr std::uint64_t kTriangleBytes = 50;

char Lowered(unsigned char letter) { return static_cast<char>(std::tolower(letter)); }

bool BeginsWithSolid(std::string_view text) {
  constexpr std::string_view kSolid = "solid";
  return text.size() >= kSolid.size() &&
         std::equal(kSolid.begin(), kSolid.end(), text.begin(),
                    [](char a, char b) { return a == Lowered(static_cast<unsigned char>(b)); });
}

std::size_t FirstLetter(std::string_view bytes) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  const std::size_t first = bytes.starts_with(kMark) ? kMark.size() : 0;
  return std::min(bytes.find_first_not_of(" \t\r\n", first), bytes.size());
}

// The triangles that a binary file's header claims.
std::uint64_t ClaimOf(std::string_view bytes) {
  std::uint32_t claimed = 0;
  if (bytes.size() >= kStlHeaderBytes) std::memcpy(&claimed, bytes.data() + 80, sizeof claimed);
  return claimed;
}

// Binary if its size is what its count says, or if it can't be text.
bool IsText(std::string_view bytes) {
  if (bytes.size() >= kStlHeaderBytes && bytes.size() == kStlHeaderBytes + kTriangleBytes * ClaimOf(bytes))
    return false;
  return BeginsWithSolid(bytes.substr(FirstLetter(bytes))) && bytes.find('\0') == std::string_view::npos;
}

void CheckText(std::string_view bytes, const std::string& where) {
  if (bytes.find("facet") == std::string_view::npos)
    FailAsMalformed(where, "the STL file holds no facets; export it again as a surface mesh");
  const std::size_t last_facet = bytes.rfind("endfacet");
  if (last_facet == std::string_view::npos || bytes.find("endsolid", last_facet) == std::string_view::npos)
    FailAsMalformed(where,
                    "the STL file is cut off (it doesn't end with \"endsolid\"); export or copy it again");
}

}  // namespace

std::string PlainStl(std::string bytes) {
  if (!IsText(bytes)) return bytes;
  bytes.erase(0, FirstLetter(bytes));
  if (bytes.find("facet") == std::string::npos)
    std::ranges::transform(bytes, bytes.begin(), [](unsigned char letter) { return Lowered(letter); });
  const auto is_beyond_ascii = [](unsigned char letter) { return letter >= 0x80; };
  std::replace_if(bytes.begin(), std::ranges::find(bytes, '\n'), is_beyond_ascii, '_');
  return bytes;
}

void CheckStl(std::string_view bytes, const std::string& where) {
  if (IsText(bytes)) return CheckText(bytes, where);
  if (bytes.size() < kStlHeaderBytes)
    FailAsMalformed(where, "not an STL file (too short, and not text); export it again");
  const std::uint64_t claimed = ClaimOf(bytes), held = (bytes.size() - kStlHeaderBytes) / kTriangleBytes;
  if (claimed > held) {
    FailAsMalformed(
        where, fmt::format("the STL header claims {} triangles but the file holds {}; it is cut off or not "
                           "STL, export or copy it again",
                           claimed, held));
  }
  if (claimed < held) {
    FailAsMalformed(
        where, fmt::format("the STL header claims {} triangles but the file has room for {}; which is right "
                           "can't be told, export or copy it again",
                           claimed, held));
  }
}

std::size_t BytesAfterTriangles(std::string_view bytes) {
  return IsText(bytes) ? 0 : bytes.size() - kStlHeaderBytes - kTriangleBytes * ClaimOf(bytes);
}

}  // namespace elbowroom::cad_import
