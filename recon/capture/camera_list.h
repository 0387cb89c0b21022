// Which live cameras there are.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

namespace elbowroom::recon {

// As RIG.yml names them, with more words in brackets: "gige:Aravis-Fake-GV01 (...)". They are looked for in a
// camera program, within a few seconds. Throws: Error{kCamera} if that fails; Error{kCancelled} on a stop.
[[nodiscard]] std::vector<std::string> FindLiveCameras(const std::stop_token& stop);

}  // namespace elbowroom::recon
