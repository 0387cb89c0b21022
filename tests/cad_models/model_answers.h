// What two readers say of one CAD file.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace elbowroom::cad_models {

// Ours. All but `error`, `time_ms` and `peak_mb` are empty when there is an error.
struct OurAnswer {
  std::string error;  // the line that a user gets
  std::int64_t parts = 0;
  std::int64_t instances = 0;
  std::int64_t shapes = 0;
  std::int64_t triangles = 0;
  std::int64_t dropped_triangles = 0;
  std::string unit;
  Eigen::Vector3d size_mm = Eigen::Vector3d::Zero();
  bool watertight = false;
  double deviation_mm = 0.0;
  double volume_mm3 = 0.0;
  double area_mm2 = 0.0;
  std::vector<std::string> warnings;
  double time_ms =
      0.0;  // of the whole import, child and all: the median of three, or the one where that is long
  double peak_mb = 0.0;  // resident memory of the child; no less than what its parent had when it started it
};

// What ServeOurAnswer printed, in a process of its own, so that nothing of one file is left for the next.
// `program`: this one.
[[nodiscard]] OurAnswer AskOurs(const std::filesystem::path& program, const std::filesystem::path& file);

// Imports the file and prints the answer. Numbers without a unit are millimetres.
void ServeOurAnswer(const std::filesystem::path& file);

// Another reader's; see second_reader.py.
struct TheirAnswer {
  std::string reader;
  std::string error;
  Eigen::Vector3d size_mm = Eigen::Vector3d::Zero();
  std::int64_t nodes = 0;
  std::optional<std::int64_t> pieces;
  std::optional<std::int64_t> triangles;
  std::optional<double> volume_mm3;
};

// Throws: core::Error{kFile} naming what to install, where Python or one of its modules is missing.
[[nodiscard]] TheirAnswer AskTheirs(const std::filesystem::path& script, const std::filesystem::path& file);

}  // namespace elbowroom::cad_models
