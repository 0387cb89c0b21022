// A map of a YAML file, with everything needed to complain about it: file, line, key, what to do.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "recon/rig_files/yaml_text.h"

namespace elbowroom::recon {

// Every reader throws Error{kFormat} that names the file, the line, the title and the key.
struct YamlSection {
  const YamlNode* node = nullptr;  // a map; outlives the section
  std::string file;                // "rig file 'rig.yml'"
  std::string title = {};          // "camera 'cam1'"; empty: the file itself

  [[noreturn]] void Fail(const std::string& what, core::ErrorKind kind = core::ErrorKind::kFormat) const;

  // Null where the key is absent or has no value.
  [[nodiscard]] const YamlNode* Find(const char* key) const;
  // `shape` says what belongs there.
  [[nodiscard]] const YamlNode& Get(const char* key, const char* shape) const;
  [[nodiscard]] std::string TextOr(const char* key, const std::string& otherwise) const;
  [[nodiscard]] int Integer(const char* key, const char* shape) const;

  // `count` numbers, or any count for 0, of a list, a list of lists, or an !!opencv-matrix; the last must
  // have `rows` rows or columns where rows > 0.
  [[nodiscard]] std::vector<double> Numbers(const char* key, int rows, std::size_t count,
                                            const char* shape) const;

  // An unknown key is nobody's business unless it looks like a slip: `unsen` would change the hull unseen.
  void RefuseMisspelt(std::span<const std::string_view> known) const;

 private:
  [[noreturn]] void FailAt(int line, const std::string& what, core::ErrorKind kind) const;
};

// The file's text as a map. `who` begins the messages, `what` names its kind in them.
// Throws: Error{kFile} if it can't be read, Error{kFormat} if it isn't such YAML.
[[nodiscard]] YamlNode ReadYamlFile(const std::filesystem::path& path, const std::string& who,
                                    std::string_view what);

}  // namespace elbowroom::recon
