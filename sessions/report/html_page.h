// The frame of a page: head, style, body.
#pragma once

#include <string>

namespace elbowroom::sessions {

// A whole HTML page that needs no other file, and may load none (Content-Security-Policy). Title and body are
// HTML. With `data_json` (PageDataJson) it runs the script of reports, and no other.
[[nodiscard]] std::string HtmlPage(const std::string& title, const std::string& body,
                                   const std::string& data_json = "");

}  // namespace elbowroom::sessions
