// The YAML of RIG.yml, VIEW.yml and pose files: what OpenCV's FileStorage writes, and what people write in
// the same form.
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

// A number where the text looks like one, else text.
void PutPlainScalar(std::string_view plain, YamlNode* node);

// Whether the document must begin with %YAML:1.0. Other programs leave that out; so does JSON, which is YAML
// but for this.
enum class YamlHeader { kRequired, kOptional };

// Reads a document, which must be a map. It may hold %YAML:1.0, block and flow lists and maps, quoted and
// plain scalars, and comments; tags such as !!opencv-matrix are passed over. Not supported are anchors, texts
// of several lines, complex keys and base64. `who` begins the messages. Throws: Error{kFormat}, with the line
// if the file is YAML at all; also for a document nested more than 64 deep or of more than 200,000 values.
[[nodiscard]] YamlNode ParseYaml(std::string_view text, const std::string& who,
                                 YamlHeader header = YamlHeader::kRequired);

}  // namespace elbowroom::recon
