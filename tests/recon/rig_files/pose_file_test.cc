#include "recon/rig_files/pose_file.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;

std::string Matrix(const std::string& key, int rows, int columns, const std::string& numbers) {
  return key + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
         "\n   cols: " + std::to_string(columns) + "\n   dt: d\n   data: [ " + numbers + " ]\n";
}
const std::string kRotation = Matrix("rotation_world_from_part", 3, 3, "0., -1., 0., 1., 0., 0., 0., 0., 1.");
const std::string kTranslation = Matrix("translation_world_from_part_mm", 3, 1, "100., -20.5, 3.");

class PoseFile : public ::testing::Test {
 protected:
  core::RigidTransform Read(const std::string& text) {
    test_support::WriteText(folder_ / "pose.yml", text);
    return ReadPoseFile(folder_ / "pose.yml");
  }
  // The message of the error that the text must lead to: one line that names the file.
  std::string ErrorOf(ErrorKind kind, const std::string& text) {
    try {
      (void)Read(text);
    } catch (const core::Error& error) {
      std::string message = error.what();
      EXPECT_EQ(static_cast<int>(error.kind()), static_cast<int>(kind)) << message;
      EXPECT_NE(message.find("pose.yml"), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message;
    }
    ADD_FAILURE() << "no error for: " << text;
    return "";
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(PoseFile, AQuarterTurnAboutZWithAShift) {
  const core::RigidTransform world_from_part = Read("%YAML:1.0\n---\n" + kRotation + kTranslation);
  EXPECT_EQ(world_from_part * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(98, -19.5, 6));
}

TEST_F(PoseFile, OtherKeysAndSinglePrecisionAreFine) {
  std::string text = "%YAML:1.0\n---\nnote: \"bench\"\n" + kRotation + kTranslation;
  text.replace(text.find("dt: d"), 5, "dt: f");
  EXPECT_EQ(Read(text).translation_mm.x(), 100.0);
}

TEST_F(PoseFile, MissingAndMisshapenKeysAreNamed) {
  const std::string head = "%YAML:1.0\n---\n";
  const auto names = [](const std::string& message, const std::string& what) {
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  names(ErrorOf(ErrorKind::kFormat, head + kTranslation), "'rotation_world_from_part' is missing");
  names(ErrorOf(ErrorKind::kFormat, head + kRotation), "'translation_world_from_part_mm' is missing");
  names(ErrorOf(ErrorKind::kFormat,
                head + kRotation + Matrix("translation_world_from_part_mm", 1, 3, "1., 2., 3.")),
        "3 x 1");
  names(ErrorOf(ErrorKind::kFormat,
                head + kRotation + Matrix("translation_world_from_part_mm", 3, 1, "1., 2.")),
        "'translation_world_from_part_mm'");
  names(ErrorOf(ErrorKind::kFormat, head + kRotation + "translation_world_from_part_mm: \"here\"\n"),
        "'translation_world_from_part_mm'");
  names(ErrorOf(ErrorKind::kFormat,
                head + kRotation + Matrix("translation_world_from_part_mm", 3, 1, "1., .Nan, 3.")),
        "not finite");
  names(ErrorOf(ErrorKind::kFormat,
                head + kRotation + Matrix("translation_world_from_part_mm", 3, 1, "1., 1e300, 3.")),
        "check its unit");
  names(ErrorOf(ErrorKind::kFormat,
                head + kRotation +
                    "translation_world_from_part_mm: !!opencv-matrix\n   rows: 1000000000\n   cols: "
                    "1000000000\n   dt: d\n   data: [ 1. ]\n"),
        "1000000000 x 1000000000");
}

TEST_F(PoseFile, WhatIsNoRotationIsRefused) {
  for (const char* numbers : {"1., 0., 0., 0., 1., 0., 0., 0., -1.", "1.1, 0., 0., 0., 1., 0., 0., 0., 1.",
                              "0., 0., 0., 0., 0., 0., 0., 0., 0."}) {
    const std::string message =
        ErrorOf(ErrorKind::kFormat,
                "%YAML:1.0\n---\n" + Matrix("rotation_world_from_part", 3, 3, numbers) + kTranslation);
    EXPECT_NE(message.find("is not a rotation"), std::string::npos) << message;
  }
}

TEST_F(PoseFile, FilesThatAreNoYamlAreErrorsAndSayNothingElse) {
  ::testing::internal::CaptureStderr();
  EXPECT_THROW((void)ReadPoseFile(folder_ / "none.yml"), core::Error);
  EXPECT_THROW((void)ReadPoseFile(folder_.path()), core::Error);
  (void)ErrorOf(ErrorKind::kFormat, "not yaml: [");
  (void)ErrorOf(ErrorKind::kFormat, "");
  (void)ErrorOf(ErrorKind::kFormat,
                "%YAML:1.0\n---\nrotation_world_from_part: !!opencv-matrix\n   rows: 3\n   cols: [");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace elbowroom::recon
