// Small footage that the tests make themselves: numbered pictures, videos, rigs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/error.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::recon::testing {

inline constexpr int kWidthPx = 96;
inline constexpr int kHeightPx = 64;

// A folder of its own for the running test, empty, and removed with this object.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string File(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

// A picture whose blocks spell out `number` (0..255), so that lossy codecs keep it.
[[nodiscard]] cv::Mat NumberedPicture(int number, int width_px = kWidthPx, int height_px = kHeightPx);
[[nodiscard]] int NumberIn(const cv::Mat& picture_bgr);

// MJPG AVI of NumberedPicture(first_number)...
void WriteVideo(const std::string& path, int frames, int first_number = 0, double rate_hz = 30.0);
// The first `share` of the file's bytes.
void CutFile(const std::filesystem::path& from, const std::filesystem::path& to, double share);
// Changes how many frames the headers of such an AVI promise.
void PromiseFrames(const std::filesystem::path& avi, std::uint32_t frames);
// Overwrites pixels of one of its frames, behind that frame's headers.
void DamageFrame(const std::filesystem::path& avi, int frame);
void WriteText(const std::filesystem::path& path, const std::string& text);

[[nodiscard]] core::CameraModel PlainCamera(const std::string& name, int width_px = kWidthPx,
                                            int height_px = kHeightPx);
[[nodiscard]] RigFile PlainRig(const std::vector<CameraSources>& sources);  // cameras cam1, cam2, ...

// Runs `action` and returns the message of the core::Error that it throws; fails the test if it throws none,
// one of another kind, or a message of more than one line.
[[nodiscard]] std::string ErrorOf(core::ErrorKind kind, const std::function<void()>& action);

}  // namespace elbowroom::recon::testing
