// The frame of a page: head, style, body.
#pragma once

#include <string>

namespace elbowroom::sessions {

// A whole HTML page that needs no other file. Both arguments are HTML.
[[nodiscard]] std::string HtmlPage(const std::string& title, const std::string& body);

}  // namespace elbowroom::sessions
