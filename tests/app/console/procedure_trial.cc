#include "tests/app/console/procedure_trial.h"

#include <fmt/format.h>

#include "tests/app/mask_rig.h"
#include "tests/support/text_file.h"

namespace elbowroom::console {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 3000;

}  // namespace

void WriteProcedureTrial(const fs::path& folder) {
  test_support::WriteBallRig(folder);
  test_support::WriteBoxStl(folder / "box.stl", 40.0);
  for (const char* camera : {"cam1", "cam2", "cam3", "cam4"})
    for (int i = 1; i < kFrames; ++i)
      fs::create_hard_link(folder / camera / "mask_0000.png",
                           folder / camera / fmt::format("mask_{:04d}.png", i));
  test_support::WriteText(folder / "layout.toml", kProcedureLayout);
  test_support::WriteText(folder / "trial.toml", kProcedureTrial);
  test_support::WriteText(folder / "feelings.toml", kProcedureQuestions);
}

}  // namespace elbowroom::console
