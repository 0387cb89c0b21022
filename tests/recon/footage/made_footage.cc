#include "tests/recon/footage/made_footage.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "tests/support/text_file.h"

namespace elbowroom::recon::testing {
namespace fs = std::filesystem;

TestFolder::TestFolder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  path_ = fs::temp_directory_path() / ("elbowroom_" + std::string(test->test_suite_name()) + "_" +
                                       test->name() + "_" + std::to_string(::getpid()));
  fs::remove_all(path_);
  fs::create_directories(path_);
}

TestFolder::~TestFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

cv::Mat NumberedPicture(int number, int width_px, int height_px) {
  cv::Mat picture(height_px, width_px, CV_8UC3, cv::Scalar(90, 90, 90));
  const int block_px = width_px / 8;
  for (int bit = 0; bit < 8; ++bit) {
    const int level = ((number >> bit) & 1) != 0 ? 220 : 30;
    picture(cv::Rect(bit * block_px, 0, block_px, height_px / 2)).setTo(cv::Scalar(level, level, level));
  }
  return picture;
}

int NumberIn(const cv::Mat& picture_bgr) {
  const int block_px = picture_bgr.cols / 8;
  int number = 0;
  for (int bit = 0; bit < 8; ++bit) {
    const cv::Scalar mean =
        cv::mean(picture_bgr(cv::Rect(bit * block_px, 0, block_px, picture_bgr.rows / 2)));
    if (mean[0] > 125.0) number |= 1 << bit;
  }
  return number;
}

void WriteVideo(const std::string& path, int frames, int first_number, double rate_hz) {
  cv::VideoWriter writer(path, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), rate_hz,
                         cv::Size(kWidthPx, kHeightPx));
  ASSERT_TRUE(writer.isOpened());
  for (int i = 0; i < frames; ++i) writer.write(NumberedPicture(first_number + i));
}

void CutFile(const fs::path& from, const fs::path& to, double share) {
  fs::copy_file(from, to, fs::copy_options::overwrite_existing);
  fs::permissions(to, fs::perms::owner_write, fs::perm_options::add);
  fs::resize_file(to, static_cast<std::uintmax_t>(static_cast<double>(fs::file_size(from)) * share));
}

void PromiseFrames(const fs::path& avi, std::uint32_t frames) {
  std::string bytes = test_support::ReadText(avi);
  // dwTotalFrames of the main header, dwLength of the stream's.
  for (const std::size_t at : {bytes.find("avih") + 8 + 16, bytes.find("strh") + 8 + 32})
    for (unsigned i = 0; i < 4; ++i) bytes.at(at + i) = static_cast<char>((frames >> (8U * i)) & 0xFFU);
  WriteText(avi, bytes);
}

void DamageFrame(const fs::path& avi, int frame) {
  std::string bytes = test_support::ReadText(avi);
  std::size_t at = bytes.find("movi");
  for (int i = 0; i <= frame; ++i) at = bytes.find("00dc", at + 4);
  bytes.replace(at + 8 + 640, 60, 60, '\x55');
  WriteText(avi, bytes);
}

void WriteText(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
}

core::CameraModel PlainCamera(const std::string& name, int width_px, int height_px) {
  core::CameraCalibration calibration;
  calibration.name = name;
  calibration.image_width_px = width_px;
  calibration.image_height_px = height_px;
  calibration.camera_matrix << 80.0, 0.0, 0.5 * width_px, 0.0, 81.0, 0.5 * height_px, 0.0, 0.0, 1.0;
  calibration.cam_from_world.translation_mm = {0.0, 0.0, 1000.0};
  return core::CameraModel(calibration);
}

RigFile PlainRig(const std::vector<CameraSources>& sources) {
  RigFile rig_file;
  rig_file.rig.name = "test rig";
  rig_file.rig.workspace_mm = {Eigen::Vector3d(-100, -100, -100), Eigen::Vector3d(100, 100, 100)};
  rig_file.sources = sources;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    rig_file.rig.cameras.push_back(PlainCamera("cam" + std::to_string(i + 1)));
  }
  return rig_file;
}

std::string ErrorOf(core::ErrorKind kind, const std::function<void()>& action) {
  try {
    action();
  } catch (const core::Error& error) {
    EXPECT_EQ(static_cast<int>(error.kind()), static_cast<int>(kind)) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error was thrown";
  return {};
}

}  // namespace elbowroom::recon::testing
