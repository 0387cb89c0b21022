// The files of a small trial, on disk.
#pragma once

#include <filesystem>

namespace elbowroom::adversary {

// A trial of so many frames on ready masks: a ball comes to a box and goes again, in four cameras of
// 320 x 240. Returns the path of trial.toml in `folder`, which is made.
std::filesystem::path WriteMaskTrial(const std::filesystem::path& folder, int frames);

}  // namespace elbowroom::adversary
