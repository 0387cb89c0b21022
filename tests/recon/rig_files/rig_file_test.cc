#include "recon/rig_files/rig_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "tests/recon/footage/made_footage.h"
#include "tests/support/text_file.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using ::testing::AllOf;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::TestFolder;
using testing::WriteText;

// design.md's form: flow maps on one line; matrices as flat lists, lists of rows and !!opencv-matrix.
const std::string kFlowRig = R"(%YAML:1.0
---
rig_name: "bench"
workspace_mm: [-1,-2,-3,1.5,2,3]
unseen: "abstain"
cameras:
  - { name: "cam1", image_width: 644, image_height: 486, camera_matrix: [ 500, 0, 320, 0, 501.5, 240, 0, 0, 1 ], distortion_model: "plumb_bob", distortion_coefficients: [ -0.1, 0.01, 0, 0, 0 ], rotation_cam_from_world: [ [ 1, 0, 0 ], [ 0, 1, 0 ], [ 0, 0, 1 ] ], translation_cam_from_world_mm: [ 1, 2, 3 ], frames: "cam1/video.avi", background: "device:0", masks: "/abs/mask_%04d.png" }
  - { name: "cam2", image_width: 644, image_height: 486, camera_matrix: [ 500, 0, 320, 0, 501.5, 240, 0, 0, 1 ], distortion_model: "fisheye", distortion_coefficients: [ 0.01, 0, 0, 0 ], rotation_cam_from_world: [ 1, 0, 0, 0, 1, 0, 0, 0, 1 ], translation_cam_from_world_mm: [ 1, 2, 3.25 ], frames: "rtsp://host/stream" }
)";

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// What reading `text` as RIG.yml says.
std::string RigError(ErrorKind kind, const std::string& text) {
  const TestFolder folder;
  WriteText(folder.path() / "rig.yml", text);
  std::string message = ErrorOf(kind, [&] { (void)ReadRigFile(folder.path() / "rig.yml"); });
  EXPECT_THAT(message, HasSubstr("rig.yml"));
  return message;
}

TEST(RigFile, ReadsFlowMaps) {
  const TestFolder folder;
  WriteText(folder.path() / "rig.yml", kFlowRig);
  const RigFile rig_file = ReadRigFile(folder.path() / "rig.yml");
  EXPECT_EQ(rig_file.rig.name, "bench");
  EXPECT_EQ(rig_file.rig.unseen, core::UnseenPolicy::kAbstain);
  EXPECT_EQ(rig_file.rig.workspace_mm.max(), Eigen::Vector3d(1.5, 2, 3));
  ASSERT_EQ(rig_file.rig.cameras.size(), 2U);
  const core::CameraCalibration& first = rig_file.rig.cameras[0].calibration();
  EXPECT_EQ(first.image_width_px, 644);
  EXPECT_EQ(first.camera_matrix(1, 1), 501.5);
  EXPECT_EQ(first.distortion_coefficients, (std::vector<double>{-0.1, 0.01, 0, 0, 0}));
  EXPECT_EQ(rig_file.rig.cameras[1].calibration().distortion_model, core::DistortionModel::kFisheye);
  EXPECT_EQ(rig_file.rig.cameras[1].cam_from_world().translation_mm.z(), 3.25);
  EXPECT_EQ(rig_file.sources[0].frames, folder.File("cam1/video.avi"));
  EXPECT_EQ(rig_file.sources[0].background, "device:0");
  EXPECT_EQ(rig_file.sources[0].masks, "/abs/mask_%04d.png");
  EXPECT_EQ(rig_file.sources[1].frames, "rtsp://host/stream");
  EXPECT_EQ(rig_file.sources[1].background, "");
}

TEST(RigFile, WritesWhatItReadsBackBitForBit) {
  const TestFolder folder;
  RigFile written =
      testing::PlainRig({{folder.File("cam1/%04d.png"), "device:3", ""}, {"", "", "/elsewhere/m.png"}});
  core::CameraCalibration odd = written.rig.cameras[1].calibration();
  odd.name = R"(cam "two" \ back)";
  odd.camera_matrix(0, 0) = 1.0 / 3.0 * 1e3;
  odd.distortion_model = core::DistortionModel::kRationalPolynomial;
  odd.distortion_coefficients = {0.1, 1e-300, -1.0 / 7.0, 1e-5, 0.0, -0.0, 0.30000000000000004, 1e-17};
  odd.cam_from_world = core::FromPositionAndRollPitchYaw({5e6, -1.0 / 3.0, 1e-22}, {10.0, 20.0, 30.0});
  written.rig.cameras[1] = core::CameraModel(odd);
  written.rig.workspace_mm.min().x() = -1e-7;
  WriteRigFile(written, folder.path() / "rig.yml");
  const RigFile read = ReadRigFile(folder.path() / "rig.yml");
  const core::CameraCalibration& back = read.rig.cameras[1].calibration();
  EXPECT_EQ(back.name, odd.name);
  EXPECT_EQ(back.camera_matrix, odd.camera_matrix);
  EXPECT_EQ(back.distortion_coefficients, odd.distortion_coefficients);
  EXPECT_EQ(back.distortion_model, odd.distortion_model);
  EXPECT_EQ(back.cam_from_world, odd.cam_from_world);
  EXPECT_EQ(read.rig.workspace_mm.min(), written.rig.workspace_mm.min());
  EXPECT_EQ(read.sources, written.sources);
}

const core::RigGauge kSomeGauge{"2026-11-30T12:00:00Z", 10.0, 10.0 + 1.0 / 3.0, 1.0 / 3.0, 0.7, 27, true};

TEST(RigFile, KeepsAGaugeBitForBit) {
  const TestFolder folder;
  RigFile written = testing::PlainRig({{"", "", ""}});
  WriteRigFile(written, folder.path() / "rig.yml");
  EXPECT_FALSE(ReadRigFile(folder.path() / "rig.yml").gauge);
  written.gauge = kSomeGauge;
  for (const bool passed : {true, false}) {
    written.gauge->passed = passed;
    WriteRigFile(written, folder.path() / "rig.yml");
    EXPECT_EQ(ReadRigFile(folder.path() / "rig.yml").gauge, written.gauge);
  }
}

TEST(RigFile, TakesAGaugeWithoutChangingTheRest) {
  const TestFolder folder;
  const auto path = folder.path() / "rig.yml";
  const std::string with_remark = kFlowRig + "# mind the tripod\nhome_made: 3\n";
  WriteText(path, with_remark);
  SaveGauge(kSomeGauge, path);
  EXPECT_EQ(ReadRigFile(path).gauge, kSomeGauge);
  const std::string once = test_support::ReadText(path);
  EXPECT_TRUE(once.starts_with(with_remark)) << once;
  core::RigGauge other = kSomeGauge;
  other.passed = false;
  other.places = 3;
  SaveGauge(other, path);
  EXPECT_EQ(ReadRigFile(path).gauge, other);
  EXPECT_TRUE(test_support::ReadText(path).starts_with(with_remark));
  SaveGauge(kSomeGauge, path);
  EXPECT_EQ(test_support::ReadText(path), once);
}

TEST(RigFile, TakesAGaugeWhereNothingCanBeAppended) {
  const TestFolder folder;
  const auto path = folder.path() / "rig.yml";
  WriteRigFile(testing::PlainRig({{folder.File("cam1/%04d.png"), "", ""}}), path);
  const RigFile before = ReadRigFile(path);
  WriteText(path, test_support::ReadText(path) + "...\n");
  SaveGauge(kSomeGauge, path);
  const RigFile after = ReadRigFile(path);
  EXPECT_EQ(after.gauge, kSomeGauge);
  EXPECT_EQ(after.sources, before.sources);
}

TEST(RigFile, RefusesAGaugeOfWhichAPartIsMissing) {
  const std::string gauge =
      "gauge: { made: \"today\", true_diameter_mm: 10, diameter_mm: 10.1, error_mm: 0.1, bound_mm: 0.5, "
      "places: 27, passed: true }\n";
  const TestFolder folder;
  WriteText(folder.path() / "rig.yml", kFlowRig + gauge);
  EXPECT_EQ(ReadRigFile(folder.path() / "rig.yml").gauge,
            (core::RigGauge{"today", 10.0, 10.1, 0.1, 0.5, 27, true}));
  const std::pair<const char*, const char*> defects[] = {{"passed: true", "passed: perhaps"},
                                                         {", passed: true", ""},
                                                         {"bound_mm: 0.5, ", ""},
                                                         {"places: 27", "places: 2.5"},
                                                         {"error_mm: 0.1", "error_mm: small"},
                                                         {"diameter_mm: 10.1", "diametre_mm: 10.1"}};
  for (const auto& [from, to] : defects) {
    const std::string message = RigError(ErrorKind::kFormat, Replaced(kFlowRig + gauge, from, to));
    EXPECT_THAT(message, HasSubstr("gauge")) << from;
  }
}

TEST(RigFile, WritesNothingWhereItCannotWriteAll) {
  const TestFolder folder;
  const RigFile rig_file = testing::PlainRig({{"a.avi", "", ""}});
  const std::string message =
      ErrorOf(ErrorKind::kFile, [&] { WriteRigFile(rig_file, folder.path() / "absent" / "rig.yml"); });
  EXPECT_THAT(message, HasSubstr("absent"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(RigFile, NamesWhatIsWrongWithTheFile) {
  const TestFolder folder;
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { (void)ReadRigFile(folder.path() / "none.yml"); }),
              AllOf(HasSubstr("none.yml"), HasSubstr("no such rig file")));
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { (void)ReadRigFile(folder.path()); }),
              HasSubstr("isn't a file"));
  EXPECT_THAT(RigError(ErrorKind::kFormat, ""), HasSubstr("not an OpenCV YAML file"));
  EXPECT_THAT(RigError(ErrorKind::kFormat, "\x01\x02 nothing of the kind"),
              HasSubstr("not an OpenCV YAML file"));
  EXPECT_THAT(RigError(ErrorKind::kFormat, "%YAML:1.0\n---\nworkspace_mm: [1, 2\n  cameras: }{"),
              HasSubstr("line 4: ',' or ']' must stand here"));
  EXPECT_THAT(RigError(ErrorKind::kFormat, kFlowRig.substr(0, kFlowRig.size() / 2)), HasSubstr("rig.yml"));
}

TEST(RigFile, NamesCameraAndKeyOfEveryDefect) {
  struct Defect {
    std::string from, to;
    ErrorKind kind;
    std::vector<std::string> says;
  };
  const std::string matrix = "camera_matrix: [ 500, 0, 320, 0, 501.5, 240, 0, 0, 1 ]";
  const std::string rotation = "rotation_cam_from_world: [ [ 1, 0, 0 ], [ 0, 1, 0 ], [ 0, 0, 1 ] ]";
  const Defect defects[] = {
      {"workspace_mm: [-1,-2,-3,1.5,2,3]", "", ErrorKind::kFormat, {"workspace_mm", "missing"}},
      {"[-1,-2,-3,1.5,2,3]", "[-1,-2,-3,1.5,2]", ErrorKind::kFormat, {"workspace_mm", "5 numbers"}},
      {"[-1,-2,-3,1.5,2,3]", "[-1,-2,-3,1.5,2,-3]", ErrorKind::kRange, {"workspace_mm"}},
      {"[-1,-2,-3,1.5,2,3]", "[-1,-2,-3,1.5,2,.Inf]", ErrorKind::kRange, {"workspace_mm"}},
      {"[-1,-2,-3,1.5,2,3]", "[-1,-2,\"x\",1.5,2,3]", ErrorKind::kFormat, {"workspace_mm", "numbers"}},
      {"unseen: \"abstain\"", "unseen: \"ignore\"", ErrorKind::kFormat, {"unseen", "ignore"}},
      {"name: \"cam2\"", "name: \"cam1\"", ErrorKind::kFormat, {"'cam1'", "twice"}},
      {"name: \"cam1\", ", "", ErrorKind::kFormat, {"camera number 1", "name"}},
      {"name: \"cam1\"", "name: 7", ErrorKind::kFormat, {"camera number 1", "name", "quotes"}},
      {"image_width: 644, ", "", ErrorKind::kFormat, {"'cam1'", "image_width", "missing"}},
      {"image_width: 644", "image_width: 64.4", ErrorKind::kFormat, {"'cam1'", "image_width", "whole"}},
      {"image_width: 644", "image_width: 0", ErrorKind::kCamera, {"'cam1'", "image size"}},
      {"image_width: 644", "image_width: 100000", ErrorKind::kCamera, {"'cam1'", "more than a picture"}},
      {"image_width: 644", "image_width: 4294967295", ErrorKind::kFormat, {"line 7", "image_width", "whole"}},
      {"[ 500, 0, 320,", "[ 1e308, 0, 320,", ErrorKind::kCamera, {"'cam1'", "camera_matrix"}},
      {"[ 500, 0, 320,", "[ 1e-320, 0, 320,", ErrorKind::kCamera, {"'cam1'", "focal length"}},
      {"[ -0.1, 0.01, 0, 0, 0 ]", "[ 1e300, 0, 0, 0, 0 ]", ErrorKind::kCamera, {"'cam1'", "coefficient"}},
      {"_mm: [ 1, 2, 3 ]", "_mm: [ 1, 2, 1e300 ]", ErrorKind::kCamera, {"'cam1'", "translation", "unit"}},
      {"[-1,-2,-3,1.5,2,3]", "[-1,-2,-3,1.5,2,1e300]", ErrorKind::kRange, {"workspace_mm", "unit"}},
      {matrix + ", ", "", ErrorKind::kFormat, {"'cam1'", "camera_matrix", "missing"}},
      {matrix,
       "camera_matrix: [ 500, 0, 320, 0 ]",
       ErrorKind::kFormat,
       {"'cam1'", "camera_matrix", "4 numbers"}},
      {matrix,
       "camera_matrix: [ 0, 0, 320, 0, 501.5, 240, 0, 0, 1 ]",
       ErrorKind::kCamera,
       {"'cam1'", "singular"}},
      {matrix,
       "camera_matrix: [ .Nan, 0, 320, 0, 501.5, 240, 0, 0, 1 ]",
       ErrorKind::kCamera,
       {"'cam1'", "finite"}},
      {"\"plumb_bob\"", "\"brown\"", ErrorKind::kFormat, {"'cam1'", "distortion_model", "brown"}},
      {"distortion_model: \"plumb_bob\", ",
       "",
       ErrorKind::kFormat,
       {"'cam1'", "distortion_model", "missing"}},
      {"[ -0.1, 0.01, 0, 0, 0 ]", "[ -0.1, 0.01, 0 ]", ErrorKind::kCamera, {"'cam1'", "coefficients", "3"}},
      {"[ 0.01, 0, 0, 0 ]", "[ 0.01, 0, 0, 0, 0 ]", ErrorKind::kCamera, {"'cam2'", "coefficients", "5"}},
      {rotation,
       "rotation_cam_from_world: [ [ 1, 0, 0 ], [ 0, 1.01, 0 ], [ 0, 0, 1 ] ]",
       ErrorKind::kCamera,
       {"'cam1'", "rotation"}},
      {rotation,
       "rotation_cam_from_world: [ [ 1, 0, 0 ], [ 0, 1, 0 ], [ 0, 0, -1 ] ]",
       ErrorKind::kCamera,
       {"'cam1'", "rotation"}},
      {"translation_cam_from_world_mm: [ 1, 2, 3 ]",
       "translation_cam_from_world_mm: [ 1, 2 ]",
       ErrorKind::kFormat,
       {"'cam1'", "translation_cam_from_world_mm", "2 numbers"}},
      {"frames: \"cam1/video.avi\"", "frames: 5", ErrorKind::kFormat, {"'cam1'", "frames", "text"}},
  };
  for (const Defect& defect : defects) {
    SCOPED_TRACE(defect.from + " -> " + defect.to);
    const std::string message = RigError(defect.kind, Replaced(kFlowRig, defect.from, defect.to));
    for (const std::string& word : defect.says) EXPECT_THAT(message, HasSubstr(word));
  }
}

TEST(RigFile, RefusesARigWithoutCameras) {
  const std::string start = "%YAML:1.0\n---\nworkspace_mm: [-1,-2,-3,1.5,2,3]\n";
  EXPECT_THAT(RigError(ErrorKind::kFormat, start), HasSubstr("'cameras' is missing"));
  EXPECT_THAT(RigError(ErrorKind::kCamera, start + "cameras: []\n"), HasSubstr("no cameras"));
  EXPECT_THAT(RigError(ErrorKind::kFormat, start + "cameras: \"none\"\n"), HasSubstr("must be a list"));
  EXPECT_THAT(RigError(ErrorKind::kFormat, start + "cameras: [ 1 ]\n"), HasSubstr("camera number 1"));
}

TEST(RigFile, RefusesMoreCamerasThanAHullTakes) {
  std::string text = "%YAML:1.0\n---\nworkspace_mm: [-1,-2,-3,1.5,2,3]\ncameras:\n";
  for (int i = 0; i < 10'000; ++i) text += "  - { name: \"cam\" }\n";
  EXPECT_THAT(RigError(ErrorKind::kFormat, text), HasSubstr("at most 255"));
}

TEST(RigFile, ChecksTheShapeOfAnOpenCvMatrix) {
  const TestFolder folder;
  WriteRigFile(testing::PlainRig({{"a.avi", "", ""}}), folder.path() / "rig.yml");
  std::ifstream file(folder.path() / "rig.yml");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(
      RigError(ErrorKind::kFormat, Replaced(text, "rows: 3\n         cols: 3", "rows: 3\n         cols: 4")),
      AllOf(HasSubstr("camera_matrix"), HasSubstr("3 x 4")));
  EXPECT_THAT(
      RigError(ErrorKind::kFormat, Replaced(text, "rows: 3\n         cols: 3", "rows: 1\n         cols: 9")),
      AllOf(HasSubstr("camera_matrix"), HasSubstr("1 x 9")));
}

TEST(ViewFile, TakesTheKeysAtTheTopOrInAListOfOne) {
  const TestFolder folder;
  const std::string keys =
      kFlowRig.substr(kFlowRig.find("{ name"), kFlowRig.find("}\n") + 1 - kFlowRig.find("{ name"));
  WriteText(folder.path() / "list.yml", "%YAML:1.0\n---\ncameras:\n  - " + keys + "\n");
  std::string block = keys.substr(2, keys.size() - 4);
  for (std::size_t at = 0; (at = block.find(", ", at)) != std::string::npos; ++at) {
    if (std::isalpha(static_cast<unsigned char>(block[at + 2])) != 0) block.replace(at, 2, "\n");
  }
  WriteText(folder.path() / "top.yml", "%YAML:1.0\n---\n" + block + "\n");
  std::string below = block;
  for (std::size_t at = 0; (at = below.find('\n', at)) != std::string::npos; at += 3)
    below.insert(at + 1, "  ");
  WriteText(folder.path() / "below.yml", "%YAML:1.0\n---\ncamera:\n  " + below + "\n");
  for (const char* name : {"list.yml", "top.yml", "below.yml"}) {
    const ViewFile file = ReadViewFile(folder.path() / name);
    EXPECT_FALSE(file.is_orthographic);
    const core::CameraModel& view = file.camera;
    EXPECT_EQ(view.name(), "cam1") << name;
    EXPECT_EQ(view.calibration().camera_matrix(1, 1), 501.5) << name;
  }
  WriteText(folder.path() / "two.yml", "%YAML:1.0\n---\ncameras:\n  - " + keys + "\n  - " + keys + "\n");
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { (void)ReadViewFile(folder.path() / "two.yml"); }),
              AllOf(HasSubstr("two.yml"), HasSubstr("exactly one")));
  WriteText(folder.path() / "bare.yml", "%YAML:1.0\n---\nimage_width: 5\n");
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { (void)ReadViewFile(folder.path() / "bare.yml"); }),
              AllOf(HasSubstr("bare.yml"), HasSubstr("image_height")));
}

TEST(ViewFile, OfMorePixelsThanCanBeDrawnIsRefused) {
  const TestFolder folder;
  std::string keys =
      kFlowRig.substr(kFlowRig.find("{ name"), kFlowRig.find("}\n") + 1 - kFlowRig.find("{ name"));
  keys = Replaced(Replaced(keys, "image_width: 644", "image_width: 10000"), "image_height: 486",
                  "image_height: 9000");
  WriteText(folder.path() / "view.yml", "%YAML:1.0\n---\ncamera: " + keys + "\n");
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { (void)ReadViewFile(folder.path() / "view.yml"); }),
              AllOf(HasSubstr("line 3"), HasSubstr("10000 x 9000")));
}

TEST(ViewFile, MayBeOrthographicWithoutALens) {
  const TestFolder folder;
  const std::string keys = R"(%YAML:1.0
---
image_width: 320
image_height: 240
camera_matrix: [2, 0, 159.5, 0, 2, 119.5, 0, 0, 1]
distortion_model: "plumb_bob"
distortion_coefficients: [0, 0, 0, 0, 0]
rotation_cam_from_world: [1, 0, 0, 0, 1, 0, 0, 0, 1]
translation_cam_from_world_mm: [0, 0, 500]
)";
  WriteText(folder.path() / "ortho.yml", keys + "projection: \"orthographic\"\n");
  const ViewFile view = ReadViewFile(folder.path() / "ortho.yml");
  EXPECT_TRUE(view.is_orthographic);
  EXPECT_EQ(view.camera.calibration().camera_matrix(0, 0), 2.0);
  const auto expect_refused = [&](const std::string& text, const std::string& word) {
    WriteText(folder.path() / "bad.yml", text);
    EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { (void)ReadViewFile(folder.path() / "bad.yml"); }),
                AllOf(HasSubstr("bad.yml"), HasSubstr(word)));
  };
  expect_refused(keys + "projection: \"fish\"\n", "perspective");
  expect_refused(keys + "projecton: \"orthographic\"\n", "did you mean 'projection'");
  std::string bent = keys + "projection: \"orthographic\"\n";
  bent.replace(bent.find("[0, 0, 0, 0, 0]"), 2, "[1");
  expect_refused(bent, "no lens");
  expect_refused(keys + "camera: {}\ncameras: [ {} ]\n", "both");
}

// Before the calibration a file names cameras alone.
TEST(RigFile, UncalibratedItIsGoodForPicturesAlone) {
  const TestFolder folder;
  const std::string file = folder.File("cameras.yml"), copy = folder.File("copy.yml");
  WriteText(file,
            "%YAML:1.0\n---\ncameras:\n  - { name: \"cam1\", image_width: 64, image_height: 48, frames: "
            "\"gige:one\", capture: { rate_hz: 20 } }\n");
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { (void)ReadRigFile(file); }),
              HasSubstr("camera 'cam1': not calibrated yet"));
  const RigFile rig_file = ReadRigFile(file, RigUse::kPictures);
  EXPECT_FALSE(rig_file.is_calibrated);
  EXPECT_EQ(rig_file.rig.cameras[0].width_px(), 64);
  EXPECT_EQ(rig_file.sources[0].capture.rate_hz, 20.0);
  WriteRigFile(rig_file, copy);
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { (void)ReadRigFile(copy); }), HasSubstr("not calibrated yet"));
  const RigFile again = ReadRigFile(copy, RigUse::kPictures);
  EXPECT_FALSE(again.is_calibrated);
  EXPECT_EQ(again.sources, rig_file.sources);
  // What says something of a calibration must say all of it.
  WriteText(file,
            "%YAML:1.0\n---\ncameras:\n  - { name: \"cam1\", image_width: 64, image_height: 48, "
            "camera_matrix: [ 50, 0, 32, 0, 50, 24, 0, 0, 1 ] }\n");
  EXPECT_THAT(ErrorOf(ErrorKind::kFormat, [&] { (void)ReadRigFile(file, RigUse::kPictures); }),
              HasSubstr("missing"));
}

}  // namespace
}  // namespace elbowroom::recon
