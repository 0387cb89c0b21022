// Whether this machine's graphics driver computes what its processor does.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/control/view_method.h"

namespace elbowroom::control {

// One computation in OpenGL against the same on the processor.
struct SelfTestLine {
  std::string what;             // "plane sweep, a draw a plane"
  std::int64_t hit_pixels = 0;  // on the processor
  std::int64_t differing_pixels = 0;
  std::int64_t unexplained_pixels = 0;  // of those, more than rounding: 0 where all is well
};

struct SelfTestReport {
  std::string driver;
  std::vector<SelfTestLine> lines;

  [[nodiscard]] bool Passed() const;
};

// The demo's hand before a built-in rig, by OpenGL and by the processor: the plane sweep in both ways of
// OpenGL, in the paper's also with an undistortion grid; the exact views (TestExactViews); the collision with
// the demo's PMT box by the paper's viewports, whose samples count as pixels. Throws: core::Error{kGraphics}
// when nothing can be drawn at all.
[[nodiscard]] SelfTestReport RunSelfTest();

// Compares exact views made by `graphics` with those of recon::ViewHull: perspective without and with a lens,
// from the place of a camera of the rig, and orthographic, each under both `unseen` policies. A difference
// outside of recon::ViewBand is unexplained.
[[nodiscard]] std::vector<SelfTestLine> TestExactViews(const MakeView& graphics);

}  // namespace elbowroom::control
