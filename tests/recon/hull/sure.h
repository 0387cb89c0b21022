// An oracle's answer, when rounding may decide.
#pragma once

namespace elbowroom::recon {

enum class Sure { kNo, kUnsure, kYes };

}  // namespace elbowroom::recon
