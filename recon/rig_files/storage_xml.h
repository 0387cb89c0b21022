// What OpenCV's FileStorage writes as XML, as the same values that its YAML gives.
#pragma once

#include <string>
#include <string_view>

#include "recon/rig_files/yaml_text.h"

namespace elbowroom::recon {

// Reads a document whose root is <opencv_storage>. An element with elements <_> is a list, one with others a
// map; words between tags are a value, or a list of values if there are several. Attributes are passed over.
// Not supported are document types, CDATA and base64. `who` begins the messages. Throws: Error{kFormat} with
// the line; also for a document nested more than 64 deep or of more than 200,000 values.
[[nodiscard]] YamlNode ParseStorageXml(std::string_view text, const std::string& who);

}  // namespace elbowroom::recon
