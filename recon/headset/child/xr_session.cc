#include "recon/headset/child/xr_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr std::size_t kRememberedPoses = 4096;
constexpr XrViewConfigurationType kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
constexpr XrPosef kNoTurn{{0.0F, 0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F}};

using core::Error;
using core::ErrorKind;

std::vector<std::string> ExtensionsOf(const XrFunctions& xr) {
  std::uint32_t count = 0;
  XrResult result = xr.EnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr);
  std::vector<XrExtensionProperties> found(count,
                                           XrStruct<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES));
  if (XR_SUCCEEDED(result))
    result = xr.EnumerateInstanceExtensionProperties(nullptr, count, &count, found.data());
  if (XR_FAILED(result))
    throw Error(ErrorKind::kCamera,
                fmt::format("no OpenXR runtime answers ({}): start one, such as Monado or WiVRn, or name its "
                            "file in XR_RUNTIME_JSON",
                            NameOf(result)));
  std::vector<std::string> names;
  for (const XrExtensionProperties& its : found) names.emplace_back(its.extensionName);
  return names;
}

bool Has(const std::vector<std::string>& names, const char* name) {
  return std::ranges::find(names, name) != names.end();
}

WirePose WireOf(const XrPosef& pose) {
  return {{pose.position.x, pose.position.y, pose.position.z},
          {pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w}};
}

std::int64_t SteadyNowNs() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

// Tracked, not only guessed from what was seen before.
constexpr XrSpaceLocationFlags kTracked =
    XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT |
    XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
constexpr XrViewStateFlags kViewsValid =
    XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;

}  // namespace

XrHeadset::XrHeadset(const HeadsetOrder& order) : eyes_of_poses_(kRememberedPoses) {
  CreateInstance(order);
  try {
    FindHeadset();
    CreateSession(order);
    ChooseSpaces(order.space);
    if (!is_headless_ && order.shows_pictures != 0) graphics_->MakeSwapchains(session_, sizes_);
  } catch (...) {
    (void)xr_.DestroyInstance(instance_);
    throw;
  }
}

// All handles go with the instance; what the runtime answers doesn't matter any more.
XrHeadset::~XrHeadset() { (void)xr_.DestroyInstance(instance_); }

void XrHeadset::CreateInstance(const HeadsetOrder& order) {
  const std::vector<std::string> offered = ExtensionsOf(xr_);
  const bool has_time = Has(offered, XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
  is_headless_ = order.shows_pictures == 0 && has_time && Has(offered, XR_MND_HEADLESS_EXTENSION_NAME);
  std::vector<const char*> names;
  if (has_time) names.push_back(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
  if (is_headless_) {
    names.push_back(XR_MND_HEADLESS_EXTENSION_NAME);
  } else {
    for (const char* needed : {XR_KHR_OPENGL_ENABLE_EXTENSION_NAME, XR_MNDX_EGL_ENABLE_EXTENSION_NAME}) {
      if (!Has(offered, needed))
        throw Error(
            ErrorKind::kCamera,
            fmt::format("the OpenXR runtime doesn't offer {}, by which it would take pictures; Monado "
                        "and WiVRn do",
                        needed));
      names.push_back(needed);
    }
  }
  auto info = XrStruct<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
  std::strcpy(info.applicationInfo.applicationName, "Elbowroom");
  std::strcpy(info.applicationInfo.engineName, "Elbowroom");
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  info.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
  info.enabledExtensionNames = names.data();
  CheckXr(xr_.CreateInstance(&info, &instance_), "begin: is its service running?");
  xr_.LoadFor(instance_);
}

void XrHeadset::FindHeadset() {
  auto wanted = XrStruct<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
  wanted.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  CheckXr(xr_.GetSystem(instance_, &wanted, &system_), "find a headset: is it connected and switched on?");
  auto runtime = XrStruct<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
  CheckXr(xr_.GetInstanceProperties(instance_, &runtime), "say its name");
  auto headset = XrStruct<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
  CheckXr(xr_.GetSystemProperties(instance_, system_, &headset), "say the headset's name");
  name_ = fmt::format("{} {}.{}.{}, {}", runtime.runtimeName, XR_VERSION_MAJOR(runtime.runtimeVersion),
                      XR_VERSION_MINOR(runtime.runtimeVersion), XR_VERSION_PATCH(runtime.runtimeVersion),
                      headset.systemName);
  std::uint32_t count = 2;
  sizes_.fill(XrStruct<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW));
  CheckXr(xr_.EnumerateViewConfigurationViews(instance_, system_, kStereo, count, &count, sizes_.data()),
          "say how large an eye's picture is");
  std::array<XrEnvironmentBlendMode, 8> modes{};
  CheckXr(xr_.EnumerateEnvironmentBlendModes(instance_, system_, kStereo, 8, &count, modes.data()),
          "say how it mixes pictures");
  const auto end = modes.begin() + std::min<std::uint32_t>(count, 8);
  if (std::find(modes.begin(), end, XR_ENVIRONMENT_BLEND_MODE_OPAQUE) == end) blend_ = modes[0];
}

void XrHeadset::CreateSession(const HeadsetOrder& /*order*/) {
  auto info = XrStruct<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
  info.systemId = system_;
  if (!is_headless_) {
    graphics_.emplace(xr_, instance_, system_);
    info.next = graphics_->binding();
  }
  CheckXr(xr_.CreateSession(instance_, &info, &session_), "begin a session");
}

XrSpace XrHeadset::MakeSpace(XrReferenceSpaceType type) const {
  auto info = XrStruct<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
  info.referenceSpaceType = type;
  info.poseInReferenceSpace = kNoTurn;
  XrSpace space = XR_NULL_HANDLE;
  CheckXr(xr_.CreateReferenceSpace(session_, &info, &space), "give a frame of reference");
  return space;
}

void XrHeadset::ChooseSpaces(HeadsetSpace wanted) {
  std::array<XrReferenceSpaceType, 16> types{};
  std::uint32_t count = 0;
  CheckXr(xr_.EnumerateReferenceSpaces(session_, 16, &count, types.data()), "list its frames of reference");
  const auto end = types.begin() + std::min<std::uint32_t>(count, 16);
  const bool has_stage = std::find(types.begin(), end, XR_REFERENCE_SPACE_TYPE_STAGE) != end;
  base_type_ = wanted == HeadsetSpace::kStage && has_stage ? XR_REFERENCE_SPACE_TYPE_STAGE
                                                           : XR_REFERENCE_SPACE_TYPE_LOCAL;
  base_ = MakeSpace(base_type_);
  view_ = MakeSpace(XR_REFERENCE_SPACE_TYPE_VIEW);
}

std::array<std::int32_t, 2> XrHeadset::recommended_px() const {
  return {static_cast<std::int32_t>(sizes_[0].recommendedImageRectWidth),
          static_cast<std::int32_t>(sizes_[0].recommendedImageRectHeight)};
}

XrHeadset::Change XrHeadset::ChangeTo(XrSessionState state) {
  switch (state) {
    case XR_SESSION_STATE_READY: {
      auto info = XrStruct<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
      info.primaryViewConfigurationType = kStereo;
      CheckXr(xr_.BeginSession(session_, &info), "start a session");
      is_running_ = true;
      return {HeadsetPhase::kRunning, {}};
    }
    case XR_SESSION_STATE_SYNCHRONIZED:
      return {HeadsetPhase::kRunning, {}};
    case XR_SESSION_STATE_VISIBLE:
      return {HeadsetPhase::kVisible, {}};
    case XR_SESSION_STATE_FOCUSED:
      return {HeadsetPhase::kFocused, {}};
    case XR_SESSION_STATE_STOPPING:
      is_running_ = false;
      CheckXr(xr_.EndSession(session_), "pause a session");
      return {HeadsetPhase::kStopping, {}};
    case XR_SESSION_STATE_LOSS_PENDING:
      throw RuntimeLost("the OpenXR runtime has lost the headset");
    case XR_SESSION_STATE_EXITING:
      is_running_ = false;
      return {HeadsetPhase::kEnded, "the program was ended in the headset"};
    default:
      return {HeadsetPhase::kIdle, {}};
  }
}

std::vector<XrHeadset::Change> XrHeadset::FollowEvents() {
  std::vector<Change> changes;
  for (;;) {
    auto event = XrStruct<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    const XrResult result = xr_.PollEvent(instance_, &event);
    CheckXr(result, "tell what happens");
    if (result == XR_EVENT_UNAVAILABLE) return changes;
    if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING)
      throw RuntimeLost("the OpenXR runtime is about to end");
    if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) {
      XrEventDataSessionStateChanged its{};
      std::memcpy(&its, &event, sizeof its);
      changes.push_back(ChangeTo(its.state));
    } else if (event.type == XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING) {
      XrEventDataReferenceSpaceChangePending its{};
      std::memcpy(&its, &event, sizeof its);
      if (its.referenceSpaceType == base_type_)
        changes.push_back({HeadsetPhase::kRecentred, "the headset was recentred: register it again"});
    }
  }
}

XrTime XrHeadset::Now() const {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  XrTime time = 0;
  CheckXr(xr_.ConvertTimespecTimeToTimeKHR(instance_, &now, &time), "tell the time");
  return time;
}

// Where the runtime doesn't convert its clock, the picture that is begun now is shown a frame later.
std::int64_t XrHeadset::SteadyNsOf(XrTime time, XrDuration period) const {
  if (xr_.ConvertTimeToTimespecTimeKHR == nullptr) return SteadyNowNs() + period;
  timespec at{};
  CheckXr(xr_.ConvertTimeToTimespecTimeKHR(instance_, time, &at), "tell the time");
  return std::int64_t{1'000'000'000} * at.tv_sec + at.tv_nsec;
}

HeadsetNews XrHeadset::BeginFrame() {
  if (is_headless_) {
    const XrTime now = Now();
    return Locate(now, SteadyNsOf(now, 0));
  }
  frame_ = XrStruct<XrFrameState>(XR_TYPE_FRAME_STATE);
  CheckXr(xr_.WaitFrame(session_, nullptr, &frame_), "say when the next picture is shown");
  CheckXr(xr_.BeginFrame(session_, nullptr), "begin a picture");
  return Locate(frame_.predictedDisplayTime,
                SteadyNsOf(frame_.predictedDisplayTime, frame_.predictedDisplayPeriod));
}

HeadsetNews XrHeadset::Locate(XrTime time, std::int64_t at_ns) {
  HeadsetNews news;
  news.kind = HeadsetNewsKind::kPose;
  news.at_ns = at_ns;
  auto head = XrStruct<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
  CheckXr(xr_.LocateSpace(view_, base_, time, &head), "say where the head is");
  auto wanted = XrStruct<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
  wanted.viewConfigurationType = kStereo;
  wanted.displayTime = time;
  wanted.space = base_;
  auto state = XrStruct<XrViewState>(XR_TYPE_VIEW_STATE);
  std::array<XrView, 2> views{};
  views.fill(XrStruct<XrView>(XR_TYPE_VIEW));
  std::uint32_t count = 0;
  CheckXr(xr_.LocateViews(session_, &wanted, &state, 2, &count, views.data()), "say where the eyes are");
  if ((head.locationFlags & kTracked) != kTracked || (state.viewStateFlags & kViewsValid) != kViewsValid)
    return news;
  news.is_tracked = 1;
  news.pose = ++poses_;
  news.space_from_view = WireOf(head.pose);
  auto& kept = eyes_of_poses_[static_cast<std::size_t>(news.pose) % kRememberedPoses];
  for (std::size_t eye = 0; eye < 2; ++eye) {
    kept[eye] = views[eye].pose;
    news.space_from_eye[eye] = WireOf(views[eye].pose);
    const XrFovf& fov = views[eye].fov;
    news.eyes[eye] = {std::tan(fov.angleLeft), std::tan(fov.angleRight), std::tan(fov.angleUp),
                      std::tan(fov.angleDown)};
  }
  return news;
}

void XrHeadset::TakePicture(const PictureForHeadset& picture, const std::byte* slot) {
  if (!graphics_ || picture.pose > poses_ ||
      poses_ - picture.pose >= static_cast<std::int64_t>(kRememberedPoses))
    return;
  graphics_->Take(picture, eyes_of_poses_[static_cast<std::size_t>(picture.pose) % kRememberedPoses], slot);
}

void XrHeadset::EndFrame() {
  if (is_headless_) return;
  auto layer = XrStruct<XrCompositionLayerProjection>(XR_TYPE_COMPOSITION_LAYER_PROJECTION);
  layer.space = base_;
  layer.viewCount = 2;
  layer.views = graphics_->views();
  const auto* const layers = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer);
  auto info = XrStruct<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
  info.displayTime = frame_.predictedDisplayTime;
  info.environmentBlendMode = blend_;
  info.layerCount = layer.views != nullptr && frame_.shouldRender == XR_TRUE ? 1 : 0;
  info.layers = &layers;
  CheckXr(xr_.EndFrame(session_, &info), "take a picture");
}

}  // namespace elbowroom::recon
