#include "recon/pose_file.h"

#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <string>

#include "core/error.h"
#include "recon/quiet_opencv.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

cv::FileStorage Open(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw Error(ErrorKind::kFile, fmt::format("{}: no such pose file; check the path", path.string()));
  }
  SilenceOpenCv();
  std::string why = "it doesn't open";
  try {
    cv::FileStorage storage(path.string(), cv::FileStorage::READ | cv::FileStorage::FORMAT_YAML);
    if (storage.isOpened()) return storage;
  } catch (const cv::Exception& exception) {
    why = exception.err;
  }
  throw Error(ErrorKind::kFile, fmt::format("{}: not a readable pose file ({}); it must begin with %YAML:1.0",
                                            path.string(), why));
}

cv::Mat_<double> ReadMatrix(const cv::FileStorage& storage, const char* key, int rows, int columns,
                            const std::string& where) {
  const cv::FileNode node = storage[key];
  if (node.empty())
    throw Error(ErrorKind::kFormat, fmt::format("{}: key '{}' is missing; add it", where, key));
  cv::Mat matrix;
  try {
    node >> matrix;
  } catch (const cv::Exception&) {
    matrix.release();
  }
  if (matrix.rows != rows || matrix.cols != columns || matrix.channels() != 1) {
    throw Error(ErrorKind::kFormat, fmt::format("{}: key '{}' must be an !!opencv-matrix of {} x {} numbers",
                                                where, key, rows, columns));
  }
  cv::Mat_<double> numbers = matrix;
  if (!cv::checkRange(numbers)) {
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: key '{}' holds a number that is not finite", where, key));
  }
  return numbers;
}

}  // namespace

core::RigidTransform ReadPoseFile(const std::filesystem::path& path) {
  const std::string where = path.string();
  const cv::FileStorage storage = Open(path);
  const cv::Mat_<double> rotation = ReadMatrix(storage, "rotation_world_from_part", 3, 3, where);
  const cv::Mat_<double> translation = ReadMatrix(storage, "translation_world_from_part_mm", 3, 1, where);
  core::RigidTransform world_from_part;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) world_from_part.rotation(i, j) = rotation(i, j);
    world_from_part.translation_mm[i] = translation(i, 0);
  }
  if (!core::IsRotation(world_from_part.rotation)) {
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: rotation_world_from_part is not a rotation (its rows must be "
                            "orthonormal, determinant +1); correct it",
                            where));
  }
  return world_from_part;
}

}  // namespace elbowroom::recon
