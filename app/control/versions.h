// The versions that a session and `--version` give.
#pragma once

#include <map>
#include <string>

namespace elbowroom::control {

[[nodiscard]] std::string ProgramVersion();                           // "0.1.0"
[[nodiscard]] std::map<std::string, std::string> SoftwareVersions();  // component to version

}  // namespace elbowroom::control
