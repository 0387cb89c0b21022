// The window watched over a long trial: its pictures, its waits, its memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::console {

struct WindowSoakPlan {
  double simulated_s = 60.0;
  double speed = 1.0;  // the frames come so many times faster than 30 a second
  bool turns_eye = false;
  std::filesystem::path session;
};

struct WindowSoakResult {
  double first_picture_ms = 0.0;  // from before the window was made
  double seconds = 0.0;           // measured, after the warm-up
  std::int64_t frames = 0;
  std::vector<double> between_pictures_ms, drawing_ms;
  std::vector<double> ui_waits_ms;     // of an event of the UI thread, a sample each 5 ms
  std::vector<double> resident_bytes;  // after the warm-up, each half second
  int widest_px = 0, highest_px = 0;   // of the view
  std::string driver;
  std::string error;  // one line; empty: none
};

// Plays four seconds of the demo's pictures over and over, 30 a simulated second, in a window whose view has
// 1280 x 720 pixels, where the screen has room for it. A gap is moved twice a simulated second, a tool is
// marked each five. Thread: the QApplication's.
[[nodiscard]] WindowSoakResult SoakWindow(const WindowSoakPlan& plan);

}  // namespace elbowroom::console
