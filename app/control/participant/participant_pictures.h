// Draws the participant's picture, on a thread with an OpenGL context of its own.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/head/head_pose_holder.h"
#include "app/control/head/headset_screen.h"
#include "app/control/participant/eye_views.h"
#include "app/control/scene_composer.h"
#include "recon/head_pose/head_camera.h"
#include "recon/images/image.h"

namespace elbowroom::control {

// What a picture is asked to be.
struct ParticipantLook {
  EyeOptions eyes;
  SceneLook scene;
  core::CameraIndex camera = 0;  // kCamera, kCameraMirror; kHeadCamera, where the trial has no [viewer]
  int width_px = 0;              // of the whole picture, both eyes together; 0: none is drawn
  int height_px = 0;
  recon::HeadCamera head_camera{};
  std::filesystem::path
      head_picture{};  // kHeadCamera: a picture's file in the place of the camera's; empty: none

  [[nodiscard]] bool operator==(const ParticipantLook&) const = default;
};

struct ParticipantPicture {
  recon::Image image;
  recon::HeadPose pose;     // from which it was drawn
  std::int64_t serial = 0;  // of the pose, HeadState::serial
  core::FrameIndex frame = 0;
  double drawing_ms = 0.0;
  std::vector<EyeView> headset_eyes{};  // of the two pictures side by side; empty: it isn't for a headset
};

// Hands both eyes' parts of a picture to the headset. False: it isn't for one, or the headset hasn't taken
// the last one yet.
bool ShowInHeadset(const ParticipantPicture& picture, HeadsetScreen* screen);

// In stereo, from a pose that has the eyes of a headset, the picture is that of the headset's eyes.
// Each picture is of the latest pose and frame that there are when its drawing begins. A pose, a
// frame or a look that comes while one is drawn makes the next one follow at once; without any, nothing is
// drawn, but for one picture in full when nothing has changed for a while. Where drawing takes longer than a
// frame at 30 Hz, pictures become coarser in steps.
// Thread: any may call; the callbacks come on the drawing thread and must not block.
class ParticipantPictures {
 public:
  using OnPicture = std::function<void(ParticipantPicture)>;
  using OnError = std::function<void(const std::string&)>;  // one line; no picture comes

  ParticipantPictures(OnPicture on_picture, OnError on_error);
  ~ParticipantPictures();
  ParticipantPictures(const ParticipantPictures&) = delete;
  ParticipantPictures& operator=(const ParticipantPictures&) = delete;

  // Where the head is. Without a pose nothing is drawn but a camera's picture, which has the camera's size.
  void ShowHead(const HeadState& head);
  void SetLook(const ParticipantLook& look);
  void ShowFrame(SharedFrameResult result);  // null: nothing is drawn

 private:
  class Painter;
  void Run(const std::stop_token& stop);
  void Wake();

  OnPicture on_picture_;
  OnError on_error_;
  std::mutex mutex_;  // of what follows
  std::condition_variable_any woken_;
  bool is_outdated_ = false;
  HeadState head_;
  ParticipantLook look_;
  SharedFrameResult result_;
  std::jthread thread_;  // last: it starts when all other members exist
};

}  // namespace elbowroom::control
