// A map of a YAML file, with what its error messages need: file, line and title.
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
  [[nodiscard]] double NumberOr(const char* key, double otherwise) const;
  [[nodiscard]] int Integer(const char* key, const char* shape) const;

  // `count` numbers (0: any count) of a list, a list of lists, or an !!opencv-matrix. If rows > 0, a matrix
  // must have `rows` rows or `rows` columns.
  [[nodiscard]] std::vector<double> Numbers(const char* key, int rows, std::size_t count,
                                            const char* shape) const;

  // Throws for an unknown key that resembles a known one: with `unsen` the hull would follow another policy
  // than the file's author meant. Other unknown keys are ignored.
  void RefuseMisspelt(std::span<const std::string_view> known) const;

 private:
  [[noreturn]] void FailAt(int line, const std::string& what, core::ErrorKind kind) const;
};

// The file's text as a map. `who` begins the messages, `what` names the kind of file in them. Throws:
// Error{kFile} if it can't be read, Error{kFormat} if it isn't such YAML.
[[nodiscard]] YamlNode ReadYamlFile(const std::filesystem::path& path, const std::string& who,
                                    std::string_view what);

// The same of a text that another program wrote: YAML with or without its first line, JSON, or OpenCV's XML.
[[nodiscard]] YamlNode ParseStorage(std::string_view text, const std::string& who);

}  // namespace elbowroom::recon
