// JSON that stands in a page. For .cc files of this room.
#pragma once

#include <string>

namespace elbowroom::sessions {

// `json` (ASCII) without "<", so that nothing in it ends the element that it stands in.
[[nodiscard]] std::string WithoutTags(std::string json);

}  // namespace elbowroom::sessions
