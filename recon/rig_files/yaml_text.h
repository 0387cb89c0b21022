// The YAML of RIG.yml, VIEW.yml and pose files: what OpenCV's FileStorage writes, and people after it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace elbowroom::recon {

enum class YamlKind { kNothing, kInteger, kReal, kText, kList, kMap };

// A value with everything below it.
struct YamlNode {
  YamlKind kind = YamlKind::kNothing;
  int line = 0;                   // where it begins, from 1
  double number = 0.0;            // an integer fits an int
  std::string text;               // without its quotes
  std::vector<std::string> keys;  // of a map, one an item, all different
  std::vector<YamlNode> items;    // of a list or a map

  [[nodiscard]] bool IsNumber() const { return kind == YamlKind::kInteger || kind == YamlKind::kReal; }
  // The value of a map's key; null where it has no such key.
  [[nodiscard]] const YamlNode* Find(std::string_view key) const;
};

// The map that a document is: %YAML:1.0, block and flow lists and maps, quoted and plain scalars, comments;
// tags such as !!opencv-matrix are passed over. Not: anchors, texts of several lines, complex keys, base64.
// `who` begins the messages. Nested at most 64 deep, of at most 200,000 values: what is beyond is damage.
// Throws: Error{kFormat} with the line.
[[nodiscard]] YamlNode ParseYaml(std::string_view text, const std::string& who);

}  // namespace elbowroom::recon
