// A session with the OpenXR runtime: its phases, and where the head is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recon/headset/child/xr_functions.h"
#include "recon/headset/child/xr_graphics.h"
#include "recon/headset/headset_protocol.h"

namespace elbowroom::recon {

// Thread: one; most calls may wait for the runtime.
class XrHeadset {
 public:
  // Throws: Error{kFile}: no loader; Error{kCamera}: no runtime, no headset, or a runtime that can't do what
  // is needed; Error{kGraphics}; RuntimeLost.
  explicit XrHeadset(const HeadsetOrder& order);
  ~XrHeadset();
  XrHeadset(const XrHeadset&) = delete;
  XrHeadset& operator=(const XrHeadset&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }  // of runtime and headset
  [[nodiscard]] std::array<std::int32_t, 2> recommended_px() const;

  struct Change {
    HeadsetPhase phase = HeadsetPhase::kIdle;
    std::string text;
  };
  // What the runtime told since the last call; begins and ends the session as it asks. Throws: RuntimeLost.
  [[nodiscard]] std::vector<Change> FollowEvents();
  [[nodiscard]] bool is_running() const { return is_running_; }
  [[nodiscard]] bool waits_for_frames() const { return !is_headless_; }

  // Waits for the next picture that the headset will show, and says where head and eyes will be then. Without
  // graphics it doesn't wait, and says where they are now.
  [[nodiscard]] HeadsetNews BeginFrame();
  // Hands the frame over, with the pictures that were taken last, if there are any.
  void EndFrame();
  // For the pose of that number, of BeginFrame. Nothing happens for one that is long forgotten.
  void TakePicture(const PictureForHeadset& picture, const std::byte* slot);

 private:
  void CreateInstance(const HeadsetOrder& order);
  void FindHeadset();
  void CreateSession(const HeadsetOrder& order);
  void ChooseSpaces(HeadsetSpace wanted);
  [[nodiscard]] XrSpace MakeSpace(XrReferenceSpaceType type) const;
  [[nodiscard]] Change ChangeTo(XrSessionState state);
  [[nodiscard]] HeadsetNews Locate(XrTime time, std::int64_t at_ns);
  [[nodiscard]] std::int64_t SteadyNsOf(XrTime time, XrDuration period) const;
  [[nodiscard]] XrTime Now() const;

  XrFunctions xr_;
  bool is_headless_ = false;
  bool is_running_ = false;
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  XrSession session_ = XR_NULL_HANDLE;
  XrSpace view_ = XR_NULL_HANDLE, base_ = XR_NULL_HANDLE;
  XrReferenceSpaceType base_type_ = XR_REFERENCE_SPACE_TYPE_STAGE;
  XrEnvironmentBlendMode blend_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  std::string name_;
  std::array<XrViewConfigurationView, 2> sizes_{};
  std::optional<XrGraphics> graphics_;
  XrFrameState frame_ = XrStruct<XrFrameState>(XR_TYPE_FRAME_STATE);
  std::int64_t poses_ = 0;
  std::vector<std::array<XrPosef, 2>> eyes_of_poses_;  // a ring, by number
};

}  // namespace elbowroom::recon
