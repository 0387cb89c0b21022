#include "recon/rig_files/pose_file.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "core/file_limits.h"
#include "recon/rig_files/yaml_section.h"

namespace elbowroom::recon {
namespace {

std::vector<double> FiniteNumbers(const YamlSection& section, const char* key, int rows, int columns) {
  const std::string shape = fmt::format("an !!opencv-matrix of {} x {} numbers", rows, columns);
  std::vector<double> numbers = section.Numbers(
      key, rows, static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns), shape.c_str());
  const YamlNode* declared = section.Get(key, shape.c_str()).Find("rows");
  if (declared != nullptr && declared->number != rows)
    section.Fail(fmt::format("key '{}' must be {}, not lying on its side", key, shape));
  for (const double number : numbers)
    if (!std::isfinite(number)) section.Fail(fmt::format("key '{}' holds a number that is not finite", key));
  return numbers;
}

}  // namespace

core::RigidTransform ReadPoseFile(const std::filesystem::path& path) {
  const std::string file = path.string();
  const YamlNode document = ReadYamlFile(path, file, "pose file");
  const YamlSection section{&document, file};
  const std::vector<double> rotation = FiniteNumbers(section, "rotation_world_from_part", 3, 3);
  const std::vector<double> translation = FiniteNumbers(section, "translation_world_from_part_mm", 3, 1);
  core::RigidTransform world_from_part;
  world_from_part.rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation.data());
  world_from_part.translation_mm = Eigen::Map<const Eigen::Vector3d>(translation.data());
  if (!core::IsRotation(world_from_part.rotation)) {
    section.Fail(
        "rotation_world_from_part is not a rotation (its rows must be orthonormal, determinant +1); correct "
        "it");
  }
  if (world_from_part.translation_mm.cwiseAbs().maxCoeff() > core::kLongestLengthMm) {
    section.Fail(
        fmt::format("translation_world_from_part_mm is more than {} mm from the origin; check its unit",
                    core::kLongestLengthMm));
  }
  return world_from_part;
}

}  // namespace elbowroom::recon
