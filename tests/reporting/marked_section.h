// Tables that programs write into documents that people write.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace elbowroom::reporting {

// `document` with all between the lines `<!-- bench:NAME begin -->` and `<!-- bench:NAME end -->` replaced by
// `body` and a blank line on either side; everything else stays byte by byte. `where` names the document in
// messages. Throws: core::Error{kFormat} unless each of the two markers stands there once, in that order.
[[nodiscard]] std::string WithSection(std::string_view document, std::string_view name, std::string_view body,
                                      std::string_view where);

// What stands between those lines. Throws: as above.
[[nodiscard]] std::string SectionOf(std::string_view document, std::string_view name, std::string_view where);

// WithSection on a file, whole or not at all. Throws: as above; core::Error{kFile}.
void WriteSection(const std::filesystem::path& file, std::string_view name, std::string_view body);

}  // namespace elbowroom::reporting
