#include "cad_import/formats/ply_check.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "cad_import/formats/malformed_file.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

enum class BodyEncoding { kAscii, kLittleEndian, kBigEndian };

struct Property {
  std::size_t count_bytes = 0;  // 0: no list
  std::size_t value_bytes = 0;
};
struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};
struct Header {
  BodyEncoding encoding = BodyEncoding::kAscii;
  std::vector<Element> elements;
  std::size_t body_offset = 0;
};

std::optional<std::size_t> BytesOf(std::string_view type) {
  struct Row {
    std::string_view type;
    std::size_t bytes;
  };
  constexpr std::array<Row, 17> kTypes = {{{"char", 1},
                                           {"uchar", 1},
                                           {"short", 2},
                                           {"ushort", 2},
                                           {"int", 4},
                                           {"uint", 4},
                                           {"float", 4},
                                           {"double", 8},
                                           {"int8", 1},
                                           {"uint8", 1},
                                           {"int16", 2},
                                           {"uint16", 2},
                                           {"int32", 4},
                                           {"uint32", 4},
                                           {"float32", 4},
                                           {"float64", 8},
                                           {"unsigned", 4}}};
  for (const Row& row : kTypes) {
    if (row.type == type) return row.bytes;
  }
  return std::nullopt;
}

// The blank-separated words of one line.
std::vector<std::string_view> WordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlanks = " \t\r";
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::optional<std::uint64_t> CountOf(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Takes the next line off `rest`, which must not be empty.
std::string_view TakeLine(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return line;
}

Property ParseProperty(const std::vector<std::string_view>& words, const std::string& where) {
  const bool is_list = words.size() >= 5 && words[1] == "list";
  const auto value_bytes = BytesOf(words.size() >= 3 ? words[is_list ? 3 : 1] : "");
  const auto count_bytes = is_list ? BytesOf(words[2]) : std::optional<std::size_t>(0);
  if (!value_bytes || !count_bytes)
    FailAsMalformed(where, "the PLY header has a property of an unknown type; export it again");
  if (is_list && (words[2].starts_with("float") || words[2] == "double")) {
    FailAsMalformed(where, "the PLY header counts a list in fractions; export it again");
  }
  return {*count_bytes, *value_bytes};
}

BodyEncoding ParseEncoding(std::string_view word, const std::string& where) {
  if (word == "ascii") return BodyEncoding::kAscii;
  if (word == "binary_little_endian") return BodyEncoding::kLittleEndian;
  if (word == "binary_big_endian") return BodyEncoding::kBigEndian;
  FailAsMalformed(where,
                  "the PLY header names an unknown encoding; export it as ascii or binary_little_endian");
}

Header ParseHeader(std::string_view bytes, const std::string& where) {
  std::string_view rest = bytes;
  if (WordsOf(TakeLine(rest)) != std::vector<std::string_view>{"ply"}) {
    FailAsMalformed(where, "not a PLY file (it doesn't start with \"ply\"); check the extension");
  }
  Header header;
  while (!rest.empty()) {
    const auto words = WordsOf(TakeLine(rest));
    if (words.empty()) continue;
    if (words[0] == "end_header") {
      header.body_offset = bytes.size() - rest.size();
      return header;
    }
    if (words[0] == "format" && words.size() >= 2) header.encoding = ParseEncoding(words[1], where);
    if (words[0] == "element") {
      const auto count = words.size() >= 3 ? CountOf(words[2]) : std::nullopt;
      if (!count) FailAsMalformed(where, "the PLY header has an element without a count; export it again");
      header.elements.push_back({std::string(words[1]), *count, {}});
    }
    if (words[0] == "property") {
      if (header.elements.empty())
        FailAsMalformed(where, "the PLY header has a property of no element; export it again");
      header.elements.back().properties.push_back(ParseProperty(words, where));
    }
  }
  FailAsMalformed(where, "the PLY header is cut off (no \"end_header\"); export or copy the file again");
}

[[noreturn]] void FailCutOff(const std::string& where, const Element& element, std::uint64_t index) {
  FailAsMalformed(
      where,
      fmt::format("the PLY header claims {} of element '{}' but the file ends in number {}; it is cut off, "
                  "export or copy it again",
                  element.count, element.name, index));
}

std::uint64_t IntegerAt(std::string_view bytes, std::size_t at, std::size_t width, BodyEncoding encoding) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < width; ++i) {
    const std::size_t from = encoding == BodyEncoding::kBigEndian ? i : width - 1 - i;
    value = (value << 8U) | static_cast<unsigned char>(bytes[at + from]);
  }
  return value;
}

void WalkBinary(const Header& header, std::string_view body, const std::string& where) {
  std::size_t at = 0;
  for (const Element& element : header.elements) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        if (property.count_bytes > body.size() - at) FailCutOff(where, element, i);
        const std::uint64_t values =
            property.count_bytes == 0 ? 1 : IntegerAt(body, at, property.count_bytes, header.encoding);
        at += property.count_bytes;
        if (values > (body.size() - at) / property.value_bytes) FailCutOff(where, element, i);
        at += static_cast<std::size_t>(values) * property.value_bytes;
      }
    }
  }
}

// One line a record, as every writer does and the parser expects.
void WalkAscii(const Header& header, std::string_view body, const std::string& where) {
  for (const Element& element : header.elements) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::vector<std::string_view> words;
      while (words.empty()) {
        if (body.empty()) FailCutOff(where, element, i);
        words = WordsOf(TakeLine(body));
      }
      std::size_t at = 0;
      for (const Property& property : element.properties) {
        if (at >= words.size()) FailCutOff(where, element, i);
        const auto values =
            property.count_bytes == 0 ? std::optional<std::uint64_t>(1) : CountOf(words[at++]);
        if (!values || *values > words.size() - at) FailCutOff(where, element, i);
        at += static_cast<std::size_t>(*values);
      }
    }
  }
}

}  // namespace

void CheckPly(std::string_view bytes, const std::string& where) {
  const Header header = ParseHeader(bytes, where);
  for (const Element& element : header.elements) {
    if (element.properties.empty() && element.count > 0) {
      FailAsMalformed(where,
                      fmt::format("the PLY element '{}' has no properties; export it again", element.name));
    }
  }
  const std::string_view body = bytes.substr(header.body_offset);
  if (header.encoding == BodyEncoding::kAscii) {
    WalkAscii(header, body, where);
  } else {
    WalkBinary(header, body, where);
  }
}

}  // namespace elbowroom::cad_import
