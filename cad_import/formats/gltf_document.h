// The JSON of a glTF file: what parsers don't read of it, and changes that they need.
#pragma once

#include <string>
#include <string_view>

namespace elbowroom::cad_import {

// What a document says of itself.
struct GltfAsset {
  bool is_version_1 = false;
  // How far its triangles may be from the surface that they stand for: `asset.extras.deviation_mm`, which
  // this program writes. 0: it isn't there, or is no length.
  double deviation_mm = 0.0;
};

// Empty for text that is no glTF document.
[[nodiscard]] GltfAsset AssetOf(std::string_view document);

// The document with a matrix in the place of each node's translation, rotation and scale, which assimp's
// reader of version 1.0 applies in the wrong order (it turns the translation, too). The document is one that
// CheckGltf took. Throws: Error{kFormat} naming `where`: one of the three isn't as many numbers as it should
// be.
[[nodiscard]] std::string WithMatrices(std::string_view document, const std::string& where);

[[nodiscard]] std::string WithDeviation(std::string_view document, double deviation_mm);

}  // namespace elbowroom::cad_import
