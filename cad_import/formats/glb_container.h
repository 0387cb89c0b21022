// GLB, glTF's binary container: a header, then chunks of JSON and of bytes.
#pragma once

#include <string>
#include <string_view>

namespace elbowroom::cad_import {

// Throws: Error{kFormat} naming `where`: as CheckGltf for the document within; not GLB 2, or chunks that
// don't lie inside the file.
void CheckGlb(std::string_view bytes, const std::string& where);

// Some writers leave out the padding that the specification demands. True: the second chunk begins right
// where the JSON ends, and that isn't on a multiple of 4 bytes.
[[nodiscard]] bool LacksPadding(std::string_view glb);

// The same file with padding. CheckGlb must have accepted it, and it must lack padding.
[[nodiscard]] std::string Padded(std::string glb);

// The JSON document of a file that CheckGlb accepted; and that file with another document, padded.
[[nodiscard]] std::string_view JsonOf(std::string_view glb);
[[nodiscard]] std::string WithJson(std::string glb, const std::string& json);

// A whole file of a document and its one buffer, padded. Throws: Error{kRange}: more than the 4 GiB that a
// file can hold.
[[nodiscard]] std::string MakeGlb(const std::string& json, std::string_view buffer);

}  // namespace elbowroom::cad_import
