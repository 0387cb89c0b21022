#include "recon/capture/camera_program.h"

#include <utility>
#include <vector>

#include "core/system/module.h"
#include "recon/capture/device/camera_protocol.h"

namespace elbowroom::recon {
namespace {

std::vector<const core::Descriptor*> GivenOf(const core::Descriptor& socket, const SharedSlots* slots) {
  if (slots == nullptr) return {&socket};
  return {&socket, &slots->file()};
}

}  // namespace

CameraProgram::CameraProgram(const SharedSlots* slots) : CameraProgram(slots, core::MakeSocketPair()) {}

// The program's end of the socket is closed here once the program has it.
CameraProgram::CameraProgram(const SharedSlots* slots, core::Pipe ends)
    : socket(std::move(ends.from)),
      child({.program = core::FindProgramBeside(kCameraProgram),
             .arguments = {"elbowroom_camera"},
             .gives = GivenOf(ends.to, slots)}) {}

}  // namespace elbowroom::recon
