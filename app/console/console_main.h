// The window, from start to close.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>

#include "app/console/window_picture.h"

namespace elbowroom::console {

struct ConsoleOptions {
  std::filesystem::path trial_file;  // a TRIAL.toml to run at once, or a session (.db) to review; empty: none
  bool demo = false;                 // or the built-in trial
  std::filesystem::path session;     // where the first trial is recorded; empty: in SessionsFolder()
  std::optional<PictureOrder> picture{};  // take one picture of the window, then close
  int argc = 0;                           // for Qt's own options
  char** argv = nullptr;
  std::stop_token stop{};  // closes the window in order: what it records is complete up to there
};

// Opens the window and returns its exit status once it is closed. Throws: core::Error{kGraphics} when there
// is no display to open it on; core::Error{kFile} when the demo's folder can't be made or the ordered picture
// can't be written. Thread: the program's first; once a process.
int RunConsole(const ConsoleOptions& options);

}  // namespace elbowroom::console
