#include "app/control/participant/participant_pictures.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include "app/control/tiles/frame_overlays.h"
#include "app/control/view_method.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/images/image_file.h"

namespace elbowroom::control {
namespace {

constexpr double kAimMs = 33.0, kRoomForFinerMs = 14.0;
constexpr std::array<double, 4> kScales = {1.0, 0.75, 0.55, 0.4};  // of the picture's sides
constexpr double kHullScale = 0.5;
constexpr int kSmallestEyePx = 64;
constexpr int kMostStillPx = 1600;
// A scene that hasn't changed for this long is drawn in full.
constexpr std::chrono::milliseconds kRests(400);

// Where a part of a picture is.
struct Part {
  int first_column = 0;
  int first_row = 0;
  int width_px = 0;
  int height_px = 0;
};

void Copy(const recon::Image& from, const Part& part, int to_column, bool is_mirrored, recon::Image* to) {
  for (int y = 0; y < part.height_px; ++y) {
    for (int x = 0; x < part.width_px; ++x) {
      const int source = is_mirrored ? part.first_column + part.width_px - 1 - x : part.first_column + x;
      const auto* pixel =
          from.rgb.data() + 3 * (static_cast<std::ptrdiff_t>(part.first_row + y) * from.width_px + source);
      auto* target = to->rgb.data() + 3 * (static_cast<std::ptrdiff_t>(y) * to->width_px + to_column + x);
      std::copy_n(pixel, 3, target);
    }
  }
}

recon::Image BlackPicture(int width_px, int height_px) {
  return {width_px, height_px,
          std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width_px) *
                                    static_cast<std::size_t>(height_px))};
}

// Which eyes' views make the picture, side by side.
std::vector<EyeView> ViewsFor(const recon::HeadPose& pose, const EyeOptions& options, int width_px,
                              int height_px) {
  if (options.mode == ViewMode::kStereo && pose.eyes)
    return HeadsetEyeViewsOf(pose.world_from_head, *pose.eyes, std::max(kSmallestEyePx, width_px / 2),
                             height_px);
  return EyeViewsOf(pose.world_from_head, options, width_px, height_px);
}

recon::Image ImageOf(const cv::Mat& bgr) {
  recon::Image image{bgr.cols, bgr.rows, {}};
  image.rgb.reserve(3 * bgr.total());
  for (int y = 0; y < bgr.rows; ++y) {
    const auto* row = bgr.ptr<std::uint8_t>(y);
    for (int x = 0; x < bgr.cols; ++x)
      image.rgb.insert(image.rgb.end(), {row[3 * x + 2], row[3 * x + 1], row[3 * x]});
  }
  return image;
}

// What a camera saw; empty: it has no picture.
recon::Image PictureOf(const FrameResult& result, core::CameraIndex camera) {
  if (!result.camera_frames || camera >= result.camera_frames->cameras.size()) return {};
  return ImageOf(result.camera_frames->cameras[camera].image_bgr);
}

// What the trial's camera on the head saw; where it has none, a camera of the rig.
recon::Image HeadPictureOf(const FrameResult& result, core::CameraIndex camera) {
  if (result.camera_frames && result.camera_frames->viewer)
    return ImageOf(result.camera_frames->viewer->image_bgr);
  return PictureOf(result, camera);
}

// Every so many-th pixel, so that the sides are kMostStillPx at most.
recon::Image ReadStill(const std::filesystem::path& file) {
  recon::ImageReader reader("head camera");
  (void)reader.Open(file);
  const cv::Mat bgr = reader.Decode(recon::DecodedAs::kBgr, {});
  const int step = 1 + (std::max(bgr.cols, bgr.rows) - 1) / kMostStillPx;
  if (step == 1) return ImageOf(bgr);
  cv::Mat small(bgr.rows / step, bgr.cols / step, CV_8UC3);
  for (int y = 0; y < small.rows; ++y)
    for (int x = 0; x < small.cols; ++x) small.at<cv::Vec3b>(y, x) = bgr.at<cv::Vec3b>(y * step, x * step);
  return ImageOf(small);
}

}  // namespace

// Owns what is of the drawing thread: the renderer, and for each eye what can be used again.
class ParticipantPictures::Painter {
 public:
  ParticipantPicture Draw(const FrameResult& result, const recon::HeadPose& pose, const ParticipantLook& look,
                          bool in_full) {
    const double scale = in_full ? 1.0 : kScales[step_];
    const int width_px = std::max(kSmallestEyePx, static_cast<int>(scale * look.width_px) / 2 * 2);
    const int height_px = std::max(kSmallestEyePx, static_cast<int>(scale * look.height_px));
    const std::vector<EyeView> eyes = ViewsFor(pose, look.eyes, width_px, height_px);
    ParticipantPicture picture;
    int whole_width_px = 0, most_height_px = 0;
    for (const EyeView& eye : eyes) {
      whole_width_px += eye.width_px;
      most_height_px = std::max(most_height_px, eye.height_px);
    }
    picture.image = BlackPicture(whole_width_px, most_height_px);
    int column = 0;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
      const EyeView& eye = eyes[i];
      recon::gl::Scene scene =
          composers_[i].Compose(result, eye.view, look.scene, scale < 1.0 ? kHullScale : 1.0);
      if (!in_full) scene.smoothness = recon::gl::Smoothness::kOneSample;
      Copy(renderer_.Render(scene), {eye.first_column, eye.first_row, eye.width_px, eye.height_px}, column,
           look.eyes.mode == ViewMode::kMirror, &picture.image);
      column += eye.width_px;
    }
    if (look.eyes.mode == ViewMode::kStereo && pose.eyes) picture.headset_eyes = eyes;
    return picture;
  }

  // The parts in a camera's live picture, hidden by what is real before them; empty: it has none.
  recon::Image DrawCamera(const FrameResult& result, const ParticipantLook& look) {
    recon::Image picture = PictureOf(result, look.camera);
    if (picture.rgb.empty()) return picture;
    overlays_.PaintOn(&picture, result, look.camera);
    if (look.eyes.mode != ViewMode::kCameraMirror) return picture;
    recon::Image mirrored = picture;
    Copy(picture, {0, 0, picture.width_px, picture.height_px}, 0, true, &mirrored);
    return mirrored;
  }

  // The parts in the picture of the camera on the head; empty: it has none.
  recon::Image DrawHeadCamera(const FrameResult& result, const recon::HeadPose& pose,
                              const ParticipantLook& look) {
    if (look.head_picture.empty()) {
      still_ = {};
    } else if (still_file_ != look.head_picture || still_.rgb.empty()) {
      still_ = ReadStill(look.head_picture);
    }
    still_file_ = look.head_picture;
    recon::Image picture = still_.rgb.empty() ? HeadPictureOf(result, look.camera) : still_;
    if (picture.rgb.empty()) return picture;
    const recon::HeadCamera camera = recon::ResizedTo(look.head_camera, picture.width_px, picture.height_px);
    overlays_.PaintOn(&picture, result, camera.ModelFor(pose.world_from_head));
    return picture;
  }

  // Coarser after three pictures in a row that took too long, finer after thirty that were quick.
  void Adapt(double drawing_ms) {
    const int vote = drawing_ms > kAimMs ? 1 : drawing_ms < kRoomForFinerMs ? -1 : 0;
    in_a_row_ = vote * in_a_row_ > 0 ? in_a_row_ + vote : vote;
    if (in_a_row_ >= 3 && step_ + 1 < kScales.size()) {
      ++step_;
      in_a_row_ = 0;
    } else if (in_a_row_ <= -30 && step_ > 0) {
      --step_;
      in_a_row_ = 0;
    }
  }

 private:
  recon::gl::SceneRenderer renderer_{recon::gl::PartDetail::kOnDemand};
  std::array<SceneComposer, 2> composers_;  // one an eye
  FrameOverlays overlays_;
  std::filesystem::path still_file_;
  recon::Image still_;  // of that file
  std::size_t step_ = 0;
  int in_a_row_ = 0;
};

bool ShowInHeadset(const ParticipantPicture& picture, HeadsetScreen* screen) {
  if (picture.headset_eyes.size() != 2 || !picture.pose.eyes) return false;
  std::array<recon::Image, 2> parts;
  std::array<recon::EyePicture, 2> eyes;
  int column = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const EyeView& eye = picture.headset_eyes[i];
    parts[i] = BlackPicture(eye.width_px, eye.height_px);
    Copy(picture.image, {column, 0, eye.width_px, eye.height_px}, 0, false, &parts[i]);
    column += eye.width_px;
    eyes[i] = {eye.width_px, eye.height_px, parts[i].rgb, eye.Seen()};
  }
  return screen->Show(picture.pose.eyes->pose, eyes);
}

ParticipantPictures::ParticipantPictures(OnPicture on_picture, OnError on_error)
    : on_picture_(std::move(on_picture)),
      on_error_(std::move(on_error)),
      thread_([this](const std::stop_token& stop) { Run(stop); }) {}

ParticipantPictures::~ParticipantPictures() = default;

void ParticipantPictures::ShowHead(const HeadState& head) {
  {
    const std::lock_guard lock(mutex_);
    head_ = head;
  }
  Wake();
}

void ParticipantPictures::SetLook(const ParticipantLook& look) {
  look.eyes.Validate();
  {
    const std::lock_guard lock(mutex_);
    look_ = look;
  }
  Wake();
}

void ParticipantPictures::ShowFrame(SharedFrameResult result) {
  {
    const std::lock_guard lock(mutex_);
    result_ = std::move(result);
  }
  Wake();
}

void ParticipantPictures::Wake() {
  {
    const std::lock_guard lock(mutex_);
    is_outdated_ = true;
  }
  woken_.notify_one();
}

void ParticipantPictures::Run(const std::stop_token& stop) {
  std::unique_ptr<Painter> painter;
  bool can_be_finer = false;  // the last picture
  while (!stop.stop_requested()) {
    ParticipantLook look;
    SharedFrameResult result;
    HeadState head;
    {
      std::unique_lock lock(mutex_);
      const auto is_awaited = [this] { return is_outdated_; };
      if (can_be_finer) {
        (void)woken_.wait_for(lock, stop, kRests, is_awaited);
      } else {
        (void)woken_.wait(lock, stop, is_awaited);
      }
      if (stop.stop_requested()) return;
      can_be_finer = std::exchange(is_outdated_, false);
      look = look_;
      result = result_;
      head = head_;
    }
    const bool is_of_camera = IsOfCamera(look.eyes.mode);
    const bool needs_head = NeedsHead(look.eyes.mode);
    if ((!head.pose && needs_head) || !result || look.width_px <= 0 || look.height_px <= 0) continue;
    try {
      if (!painter) painter = std::make_unique<Painter>();
      const double begun_ms = SteadyNowMs();
      ParticipantPicture picture;
      if (look.eyes.mode == ViewMode::kHeadCamera) {
        picture.image = painter->DrawHeadCamera(*result, *head.pose, look);
      } else if (is_of_camera) {
        picture.image = painter->DrawCamera(*result, look);
      } else {
        picture = painter->Draw(*result, *head.pose, look, !can_be_finer);
      }
      if (picture.image.rgb.empty()) continue;
      picture.drawing_ms = SteadyNowMs() - begun_ms;
      if (is_of_camera) can_be_finer = false;
      if (can_be_finer) painter->Adapt(picture.drawing_ms);
      if (needs_head) picture.pose = *head.pose;
      picture.serial = head.serial;
      picture.frame = result->record.frame;
      on_picture_(std::move(picture));
    } catch (const std::exception& error) {  // the outermost loop: nothing may escape a thread
      painter.reset();                       // a context that was lost is made anew
      can_be_finer = false;
      on_error_(error.what());
    }
  }
}

}  // namespace elbowroom::control
