// The rigs and ready masks of the real data sets, read with OpenCV alone: an independent reader for the
// tests.
#pragma once

#include <optional>
#include <string>

#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {

// Mask frame 0 of every camera; nothing when the folder isn't there.
// Throws: std::runtime_error naming a file that is there but can't be read.
[[nodiscard]] std::optional<RandomScene> ReadSharedScene(const std::string& set);

// Vertices of an ASCII PLY file. Throws: std::runtime_error.
[[nodiscard]] std::vector<Eigen::Vector3d> ReadPlyVertices(const std::string& path_in_shared_data);

}  // namespace elbowroom::recon
