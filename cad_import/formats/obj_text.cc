#include "cad_import/formats/obj_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

constexpr std::string_view kObjBlanks = " \t\r\v\f";

// Takes the next blank-separated word off `line`; empty at its end.
std::string_view TakeWord(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kObjBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kObjBlanks));
  line.remove_prefix(word.size());
  return word;
}

// Takes the next line, with those that a backslash at its end joins to it.
std::string TakeJoinedLine(std::string_view& rest) {
  std::string line;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    std::string_view piece = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (piece.ends_with('\r')) piece.remove_suffix(1);
    const bool continues = piece.ends_with('\\');
    if (continues) piece.remove_suffix(1);
    line += piece;
    if (!continues) break;
    line += ' ';
  }
  return line;
}

// "7/1/3 8//3 9": the part of each word before its first slash.
int AppendCorners(std::string_view words, std::string& text) {
  int corners = 0;
  for (std::string_view word = TakeWord(words); !word.empty() && word[0] != '#'; word = TakeWord(words)) {
    text += ' ';
    text += word.substr(0, word.find('/'));
    ++corners;
  }
  return corners;
}

}  // namespace

PlainObj PlainObjOf(std::string_view bytes, const std::string& where) {
  if (bytes.find('\0') != std::string_view::npos) {
    throw core::Error(core::ErrorKind::kFormat,
                      fmt::format("{}: not an OBJ file (it holds binary data); check the extension", where));
  }
  PlainObj plain;
  bool has_face = false;
  while (!bytes.empty()) {
    const std::string line = TakeJoinedLine(bytes);
    std::string_view words = line;
    const std::string_view key = TakeWord(words);
    if (key == "f" || key == "l") {
      plain.text += key;
      const int corners = AppendCorners(words, plain.text);
      has_face = has_face || key == "f";
      if (key == "f") plain.triangles += std::max(0, corners - 2);
    } else if (key == "v" || key == "o" || key == "g") {
      plain.text += key;
      plain.text += words;
    } else {
      continue;
    }
    plain.text += '\n';
  }
  if (!has_face) {
    throw core::Error(
        core::ErrorKind::kFormat,
        fmt::format("{}: the OBJ file holds no faces; export it again as a surface mesh", where));
  }
  return plain;
}

}  // namespace elbowroom::cad_import
