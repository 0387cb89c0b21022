// A small OpenXR runtime for tests. It is loaded by the real loader, which finds it by XR_RUNTIME_JSON. It
// keeps to the order of calls that OpenXR prescribes, and counts what breaks it.
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#define XR_NO_PROTOTYPES
#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_EGL
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <string_view>
#include <vector>

#include "tests/openxr_runtime/mock_control.h"

namespace {

using elbowroom::test_support::kMockClockAheadNs;
using elbowroom::test_support::kMockControlVariable;
using elbowroom::test_support::kMockEyeHeightPx;
using elbowroom::test_support::kMockEyeWidthPx;
using elbowroom::test_support::kMockPredictionNs;
using elbowroom::test_support::MockControl;
using elbowroom::test_support::MockEvent;
using elbowroom::test_support::MockEye;
using elbowroom::test_support::MockPicture;
using elbowroom::test_support::MockPose;

constexpr std::int64_t kSecondNs = 1'000'000'000, kPeriodNs = 8'000'000;
constexpr XrSystemId kSystem = 1;

struct Swapchain {
  std::array<GLuint, 3> textures{};
  std::uint32_t next = 0;
  bool is_acquired = false, is_waited = false, is_released_once = false;
};

MockControl* OpenControl() {
  const char* path = std::getenv(kMockControlVariable);
  const int file = path == nullptr ? -1 : ::open(path, O_RDWR | O_CLOEXEC);
  if (file < 0) std::abort();
  void* memory = ::mmap(nullptr, sizeof(MockControl), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  if (memory == MAP_FAILED) std::abort();
  return static_cast<MockControl*>(memory);
}

struct Runtime {
  MockControl* control = OpenControl();
  bool has_session = false, is_running = false, is_headless = false, asked_for_opengl = false;
  bool waited = false, began = false;
  std::deque<MockEvent> own_events;
  std::map<XrSpace, XrReferenceSpaceType> spaces;
  std::map<XrSwapchain, Swapchain> swapchains;
  std::uint64_t handles = 0;
  std::int64_t last_frame_ns = 0;
};

Runtime* runtime = nullptr;

template <typename Struct>
Struct XrStruct(XrStructureType type) {
  Struct its{};
  its.type = type;
  return its;
}

template <typename Handle>
Handle NewHandle() {
  return reinterpret_cast<Handle>(static_cast<std::uintptr_t>(++runtime->handles));
}

XrResult Misuse(const char* what) {
  if (runtime->control->misuse.fetch_add(1) == 0)
    std::snprintf(runtime->control->what_misuse.data(), runtime->control->what_misuse.size(), "%s", what);
  return XR_ERROR_CALL_ORDER_INVALID;
}

std::int64_t NowNs() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return kSecondNs * now.tv_sec + now.tv_nsec;
}

void SleepUntil(std::int64_t at_ns) {
  const timespec at{at_ns / kSecondNs, at_ns % kSecondNs};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

// XR_SUCCESS: the runtime is still there.
XrResult Alive() {
  if (runtime->control->crashes != 0) std::abort();
  return runtime->control->vanishes != 0 ? XR_ERROR_INSTANCE_LOST : XR_SUCCESS;
}

void HangWhileAsked() {
  while (runtime->control->hangs != 0) SleepUntil(NowNs() + kPeriodNs);
}

struct WholePose {
  MockPose head;
  std::array<MockEye, 2> eyes;
};

WholePose CurrentPose() {
  for (;;) {
    const std::int32_t before = runtime->control->pose_serial;
    const WholePose pose{runtime->control->head, runtime->control->eyes};
    std::atomic_thread_fence(std::memory_order_acquire);
    if (before % 2 == 0 && runtime->control->pose_serial == before) return pose;
  }
}

XrPosef PoseOf(const MockPose& pose) {
  const auto f = [](double value) { return static_cast<float>(value); };
  return {{f(pose.quaternion[0]), f(pose.quaternion[1]), f(pose.quaternion[2]), f(pose.quaternion[3])},
          {f(pose.position[0]), f(pose.position[1]), f(pose.position[2])}};
}

using Quaternion = std::array<double, 4>;

Quaternion Times(const Quaternion& a, const Quaternion& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

std::array<double, 3> Turned(const Quaternion& by, const std::array<double, 3>& vector) {
  const Quaternion turned =
      Times(Times(by, {vector[0], vector[1], vector[2], 0.0}), {-by[0], -by[1], -by[2], by[3]});
  return {turned[0], turned[1], turned[2]};
}

MockPose EyeOf(const MockPose& head, const MockEye& eye) {
  MockPose result = head;
  const auto offset = Turned(head.quaternion, {eye.x_m, 0.0, 0.0});
  for (std::size_t i = 0; i < 3; ++i) result.position[i] += offset[i];
  // Outwards: the left eye's about +y, the right eye's about -y.
  const double half = 0.5 * (eye.x_m < 0.0 ? eye.turned_outwards_rad : -eye.turned_outwards_rad);
  result.quaternion = Times(head.quaternion, {0.0, std::sin(half), 0.0, std::cos(half)});
  return result;
}

template <typename Value>
XrResult Fill(const std::vector<Value>& values, std::uint32_t capacity, std::uint32_t* count, Value* out) {
  *count = static_cast<std::uint32_t>(values.size());
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < values.size()) return XR_ERROR_SIZE_INSUFFICIENT;
  std::copy(values.begin(), values.end(), out);
  return XR_SUCCESS;
}

// --- instance
// ---------------------------------------------------------------------------------------------------

XrResult EnumerateExtensions(const char*, std::uint32_t capacity, std::uint32_t* count,
                             XrExtensionProperties* out) {
  const MockControl& control = *runtime->control;
  std::vector<const char*> names{XR_KHR_OPENGL_ENABLE_EXTENSION_NAME};
  if (control.offers_egl != 0) names.push_back(XR_MNDX_EGL_ENABLE_EXTENSION_NAME);
  if (control.offers_headless != 0) names.push_back(XR_MND_HEADLESS_EXTENSION_NAME);
  if (control.offers_time != 0) names.push_back(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
  std::vector<XrExtensionProperties> found;
  for (const char* name : names) {
    auto its = XrStruct<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES);
    std::strcpy(its.extensionName, name);
    found.push_back(its);
  }
  return Fill(found, capacity, count, out);
}

XrResult CreateInstance(const XrInstanceCreateInfo* info, XrInstance* instance) {
  if (runtime->control->refuses_instance != 0) return XR_ERROR_RUNTIME_UNAVAILABLE;
  runtime->is_headless = false;
  for (std::uint32_t i = 0; i < info->enabledExtensionCount; ++i)
    if (std::string_view(info->enabledExtensionNames[i]) == XR_MND_HEADLESS_EXTENSION_NAME)
      runtime->is_headless = true;
  ++runtime->control->instances;
  *instance = NewHandle<XrInstance>();
  return XR_SUCCESS;
}

XrResult DestroyInstance(XrInstance) { return XR_SUCCESS; }

XrResult GetInstanceProperties(XrInstance, XrInstanceProperties* out) {
  out->runtimeVersion = XR_MAKE_VERSION(1, 2, 3);
  std::strcpy(out->runtimeName, "Mock runtime");
  return Alive();
}

XrResult PollEvent(XrInstance, XrEventDataBuffer* out) {
  if (const XrResult gone = Alive(); gone != XR_SUCCESS) return gone;
  MockControl& control = *runtime->control;
  while (control.events_read < control.event_serial)
    runtime->own_events.push_back(control.events[static_cast<std::size_t>(control.events_read++)]);
  if (runtime->own_events.empty()) return XR_EVENT_UNAVAILABLE;
  const MockEvent event = runtime->own_events.front();
  runtime->own_events.pop_front();
  if (event == MockEvent::kInstanceLoss) {
    *reinterpret_cast<XrEventDataInstanceLossPending*>(out) = {XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING,
                                                               nullptr, 0};
    return XR_SUCCESS;
  }
  if (event == MockEvent::kRecentred) {
    auto its =
        XrStruct<XrEventDataReferenceSpaceChangePending>(XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING);
    its.referenceSpaceType =
        runtime->control->has_stage != 0 ? XR_REFERENCE_SPACE_TYPE_STAGE : XR_REFERENCE_SPACE_TYPE_LOCAL;
    std::memcpy(out, &its, sizeof its);
    return XR_SUCCESS;
  }
  static const std::map<MockEvent, XrSessionState> states{
      {MockEvent::kIdle, XR_SESSION_STATE_IDLE},
      {MockEvent::kReady, XR_SESSION_STATE_READY},
      {MockEvent::kSynchronized, XR_SESSION_STATE_SYNCHRONIZED},
      {MockEvent::kVisible, XR_SESSION_STATE_VISIBLE},
      {MockEvent::kFocused, XR_SESSION_STATE_FOCUSED},
      {MockEvent::kStopping, XR_SESSION_STATE_STOPPING},
      {MockEvent::kLossPending, XR_SESSION_STATE_LOSS_PENDING},
      {MockEvent::kExiting, XR_SESSION_STATE_EXITING}};
  auto its = XrStruct<XrEventDataSessionStateChanged>(XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED);
  its.state = states.at(event);
  std::memcpy(out, &its, sizeof its);
  return XR_SUCCESS;
}

// --- the headset
// ------------------------------------------------------------------------------------------------

XrResult GetSystem(XrInstance, const XrSystemGetInfo*, XrSystemId* system) {
  *system = kSystem;
  return runtime->control->has_headset != 0 ? XR_SUCCESS : XR_ERROR_FORM_FACTOR_UNAVAILABLE;
}

XrResult GetSystemProperties(XrInstance, XrSystemId, XrSystemProperties* out) {
  std::strcpy(out->systemName, "Mock headset");
  return XR_SUCCESS;
}

XrResult EnumerateViews(XrInstance, XrSystemId, XrViewConfigurationType, std::uint32_t capacity,
                        std::uint32_t* count, XrViewConfigurationView* out) {
  auto view = XrStruct<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW);
  view.recommendedImageRectWidth = view.maxImageRectWidth = kMockEyeWidthPx;
  view.recommendedImageRectHeight = view.maxImageRectHeight = kMockEyeHeightPx;
  view.recommendedSwapchainSampleCount = view.maxSwapchainSampleCount = 1;
  return Fill(std::vector<XrViewConfigurationView>(2, view), capacity, count, out);
}

XrResult EnumerateBlendModes(XrInstance, XrSystemId, XrViewConfigurationType, std::uint32_t capacity,
                             std::uint32_t* count, XrEnvironmentBlendMode* out) {
  return Fill(std::vector<XrEnvironmentBlendMode>{XR_ENVIRONMENT_BLEND_MODE_OPAQUE}, capacity, count, out);
}

XrResult GetOpenGlRequirements(XrInstance, XrSystemId, XrGraphicsRequirementsOpenGLKHR* out) {
  runtime->asked_for_opengl = true;
  out->minApiVersionSupported = XR_MAKE_VERSION(3, 0, 0);
  out->maxApiVersionSupported = XR_MAKE_VERSION(4, 6, 0);
  return XR_SUCCESS;
}

// --- session
// ----------------------------------------------------------------------------------------------------

XrResult CreateSession(XrInstance, const XrSessionCreateInfo* info, XrSession* session) {
  if (const XrResult gone = Alive(); gone != XR_SUCCESS) return gone;
  if (runtime->control->refuses_session != 0) return XR_ERROR_LIMIT_REACHED;
  const auto* binding = static_cast<const XrGraphicsBindingEGLMNDX*>(info->next);
  if (binding == nullptr && !runtime->is_headless) return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  if (binding != nullptr) {
    if (!runtime->asked_for_opengl)
      return Misuse("xrCreateSession before xrGetOpenGLGraphicsRequirementsKHR");
    if (binding->type != XR_TYPE_GRAPHICS_BINDING_EGL_MNDX || binding->display == EGL_NO_DISPLAY ||
        binding->context != eglGetCurrentContext() || binding->config == nullptr ||
        binding->getProcAddress == nullptr || binding->getProcAddress("glGenTextures") == nullptr)
      return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  } else {
    ++runtime->control->headless_sessions;
  }
  runtime->has_session = true;
  ++runtime->control->sessions;
  runtime->own_events.push_back(MockEvent::kIdle);
  if (runtime->control->begins_by_itself != 0) runtime->own_events.push_back(MockEvent::kReady);
  *session = NewHandle<XrSession>();
  return XR_SUCCESS;
}

XrResult DestroySession(XrSession) {
  runtime->has_session = runtime->is_running = false;
  return XR_SUCCESS;
}

XrResult BeginSession(XrSession, const XrSessionBeginInfo*) {
  if (runtime->is_running) return Misuse("xrBeginSession of a session that runs");
  runtime->is_running = true;
  ++runtime->control->begun;
  if (runtime->control->begins_by_itself != 0)
    for (const MockEvent event : {MockEvent::kSynchronized, MockEvent::kVisible, MockEvent::kFocused})
      runtime->own_events.push_back(event);
  return XR_SUCCESS;
}

XrResult EndSession(XrSession) {
  if (!runtime->is_running) return Misuse("xrEndSession of a session that doesn't run");
  runtime->is_running = runtime->waited = runtime->began = false;
  ++runtime->control->ended;
  return XR_SUCCESS;
}

// --- where things are
// -------------------------------------------------------------------------------------------

XrResult EnumerateSpaces(XrSession, std::uint32_t capacity, std::uint32_t* count, XrReferenceSpaceType* out) {
  std::vector<XrReferenceSpaceType> types{XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL};
  if (runtime->control->has_stage != 0) types.push_back(XR_REFERENCE_SPACE_TYPE_STAGE);
  return Fill(types, capacity, count, out);
}

XrResult CreateSpace(XrSession, const XrReferenceSpaceCreateInfo* info, XrSpace* space) {
  *space = NewHandle<XrSpace>();
  runtime->spaces[*space] = info->referenceSpaceType;
  return XR_SUCCESS;
}

XrResult DestroySpace(XrSpace) { return XR_SUCCESS; }

// The times that are asked for lie between a second ago and the next picture.
bool IsNow(XrTime time) {
  const std::int64_t ahead = time - kMockClockAheadNs - NowNs();
  return ahead > -kSecondNs && ahead < kSecondNs;
}

XrResult LocateSpace(XrSpace space, XrSpace base, XrTime time, XrSpaceLocation* out) {
  if (const XrResult gone = Alive(); gone != XR_SUCCESS) return gone;
  HangWhileAsked();
  if (!IsNow(time)) Misuse("xrLocateSpace for another time");
  if (runtime->spaces[space] != XR_REFERENCE_SPACE_TYPE_VIEW ||
      runtime->spaces[base] == XR_REFERENCE_SPACE_TYPE_VIEW)
    Misuse("xrLocateSpace of something else than the head");
  out->locationFlags = XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
  if (runtime->control->is_tracked != 0)
    out->locationFlags |= XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
  out->pose = PoseOf(CurrentPose().head);
  return XR_SUCCESS;
}

XrResult LocateViews(XrSession, const XrViewLocateInfo* info, XrViewState* state, std::uint32_t capacity,
                     std::uint32_t* count, XrView* out) {
  if (!IsNow(info->displayTime)) Misuse("xrLocateViews for another time");
  state->viewStateFlags = XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;
  const WholePose now = CurrentPose();
  *count = 2;
  if (capacity < 2) return XR_ERROR_SIZE_INSUFFICIENT;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto f = [&](std::size_t side) { return static_cast<float>(now.eyes[i].fov[side]); };
    out[i].pose = PoseOf(EyeOf(now.head, now.eyes[i]));
    out[i].fov = {f(0), f(1), f(2), f(3)};
  }
  return XR_SUCCESS;
}

XrResult ToXrTime(XrInstance, const timespec* at, XrTime* time) {
  *time = kSecondNs * at->tv_sec + at->tv_nsec + kMockClockAheadNs;
  return XR_SUCCESS;
}

XrResult ToTimespec(XrInstance, XrTime time, timespec* at) {
  const std::int64_t ns = time - kMockClockAheadNs;
  *at = {ns / kSecondNs, ns % kSecondNs};
  return XR_SUCCESS;
}

// --- frames and pictures
// ----------------------------------------------------------------------------------------

// As fast as a display: one every 8 ms.
XrResult WaitFrame(XrSession, const XrFrameWaitInfo*, XrFrameState* out) {
  if (const XrResult gone = Alive(); gone != XR_SUCCESS) return gone;
  if (!runtime->is_running) return XR_ERROR_SESSION_NOT_RUNNING;
  if (runtime->is_headless) return Misuse("xrWaitFrame without graphics");
  if (runtime->waited) return Misuse("xrWaitFrame twice");
  const std::int64_t at_ns = std::max(NowNs(), runtime->last_frame_ns + kPeriodNs);
  SleepUntil(at_ns);
  runtime->last_frame_ns = at_ns;
  runtime->waited = true;
  out->predictedDisplayTime = at_ns + kMockPredictionNs + kMockClockAheadNs;
  out->predictedDisplayPeriod = kPeriodNs;
  out->shouldRender = XR_TRUE;
  return XR_SUCCESS;
}

XrResult BeginFrame(XrSession, const XrFrameBeginInfo*) {
  if (!runtime->waited || runtime->began) return Misuse("xrBeginFrame without xrWaitFrame");
  runtime->began = true;
  return XR_SUCCESS;
}

XrResult EnumerateFormats(XrSession, std::uint32_t capacity, std::uint32_t* count, std::int64_t* out) {
  return Fill(std::vector<std::int64_t>{GL_RGBA16F, GL_SRGB8_ALPHA8, GL_RGBA8}, capacity, count, out);
}

XrResult CreateSwapchain(XrSession, const XrSwapchainCreateInfo* info, XrSwapchain* swapchain) {
  if (info->format != GL_SRGB8_ALPHA8 || info->width != kMockEyeWidthPx || info->height != kMockEyeHeightPx)
    Misuse("xrCreateSwapchain of another kind than the best");
  *swapchain = NewHandle<XrSwapchain>();
  Swapchain& its = runtime->swapchains[*swapchain];
  glGenTextures(3, its.textures.data());
  for (const GLuint texture : its.textures) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, kMockEyeWidthPx, kMockEyeHeightPx, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, nullptr);
  }
  glBindTexture(GL_TEXTURE_2D, 0);
  return XR_SUCCESS;
}

XrResult DestroySwapchain(XrSwapchain) { return XR_SUCCESS; }

XrResult EnumerateImages(XrSwapchain swapchain, std::uint32_t capacity, std::uint32_t* count,
                         XrSwapchainImageBaseHeader* out) {
  const Swapchain& its = runtime->swapchains[swapchain];
  std::vector<XrSwapchainImageOpenGLKHR> images;
  for (const GLuint texture : its.textures)
    images.push_back({XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR, nullptr, texture});
  return Fill(images, capacity, count, reinterpret_cast<XrSwapchainImageOpenGLKHR*>(out));
}

XrResult AcquireImage(XrSwapchain swapchain, const XrSwapchainImageAcquireInfo*, std::uint32_t* index) {
  Swapchain& its = runtime->swapchains[swapchain];
  if (its.is_acquired) return Misuse("xrAcquireSwapchainImage twice");
  its.is_acquired = true;
  its.next = (its.next + 1) % 3;
  *index = its.next;
  return XR_SUCCESS;
}

XrResult WaitImage(XrSwapchain swapchain, const XrSwapchainImageWaitInfo*) {
  Swapchain& its = runtime->swapchains[swapchain];
  if (!its.is_acquired) return Misuse("xrWaitSwapchainImage before xrAcquireSwapchainImage");
  its.is_waited = true;
  return XR_SUCCESS;
}

XrResult ReleaseImage(XrSwapchain swapchain, const XrSwapchainImageReleaseInfo*) {
  Swapchain& its = runtime->swapchains[swapchain];
  if (!its.is_waited) return Misuse("xrReleaseSwapchainImage before xrWaitSwapchainImage");
  its.is_acquired = its.is_waited = false;
  its.is_released_once = true;
  return XR_SUCCESS;
}

// As a compositor reads it: OpenGL's first row is the lowest.
void Keep(const XrCompositionLayerProjectionView& view, MockPicture* picture) {
  const Swapchain& its = runtime->swapchains[view.subImage.swapchain];
  const XrExtent2Di size = view.subImage.imageRect.extent;
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, its.textures[its.next], 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(3 * size.width * size.height));
  glReadPixels(view.subImage.imageRect.offset.x, view.subImage.imageRect.offset.y, size.width, size.height,
               GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glDeleteFramebuffers(1, &framebuffer);
  const auto row = static_cast<std::size_t>(3 * size.width);
  for (std::int32_t y = 0; y < size.height; ++y)
    std::copy_n(pixels.data() + row * static_cast<std::size_t>(size.height - 1 - y), row,
                picture->rgb.data() + row * static_cast<std::size_t>(y));
  picture->width_px = size.width;
  picture->height_px = size.height;
  picture->pose.position = {view.pose.position.x, view.pose.position.y, view.pose.position.z};
  picture->pose.quaternion = {view.pose.orientation.x, view.pose.orientation.y, view.pose.orientation.z,
                              view.pose.orientation.w};
  picture->fov = {view.fov.angleLeft, view.fov.angleRight, view.fov.angleUp, view.fov.angleDown};
}

XrResult EndFrame(XrSession, const XrFrameEndInfo* info) {
  if (const XrResult gone = Alive(); gone != XR_SUCCESS) return gone;
  if (!runtime->began) return Misuse("xrEndFrame without xrBeginFrame");
  runtime->waited = runtime->began = false;
  MockControl& control = *runtime->control;
  ++control.frames;
  if (info->layerCount == 0) return XR_SUCCESS;
  const auto* layer = reinterpret_cast<const XrCompositionLayerProjection*>(info->layers[0]);
  if (layer->type != XR_TYPE_COMPOSITION_LAYER_PROJECTION || layer->viewCount != 2 ||
      runtime->spaces[layer->space] == XR_REFERENCE_SPACE_TYPE_VIEW)
    return Misuse("xrEndFrame with something else than both eyes' pictures in the world");
  for (std::size_t i = 0; i < 2; ++i)
    if (!runtime->swapchains[layer->views[i].subImage.swapchain].is_released_once)
      return Misuse("xrEndFrame with a picture that was never released");
  if (control.keeps_pictures != 0) {
    ++control.picture_serial;
    for (std::size_t i = 0; i < 2; ++i) Keep(layer->views[i], &control.pictures[i]);
    ++control.picture_serial;
  }
  ++control.frames_with_pictures;
  return XR_SUCCESS;
}

// --- the way in
// -------------------------------------------------------------------------------------------------

XrResult GetAddress(XrInstance, const char* name, PFN_xrVoidFunction* function) {
  const auto as = [](auto* pointer) { return reinterpret_cast<PFN_xrVoidFunction>(pointer); };
  static const std::map<std::string_view, PFN_xrVoidFunction> kFunctions{
      {"xrGetInstanceProcAddr", as(&GetAddress)},
      {"xrEnumerateInstanceExtensionProperties", as(&EnumerateExtensions)},
      {"xrCreateInstance", as(&CreateInstance)},
      {"xrDestroyInstance", as(&DestroyInstance)},
      {"xrGetInstanceProperties", as(&GetInstanceProperties)},
      {"xrPollEvent", as(&PollEvent)},
      {"xrGetSystem", as(&GetSystem)},
      {"xrGetSystemProperties", as(&GetSystemProperties)},
      {"xrEnumerateViewConfigurationViews", as(&EnumerateViews)},
      {"xrEnumerateEnvironmentBlendModes", as(&EnumerateBlendModes)},
      {"xrGetOpenGLGraphicsRequirementsKHR", as(&GetOpenGlRequirements)},
      {"xrCreateSession", as(&CreateSession)},
      {"xrDestroySession", as(&DestroySession)},
      {"xrBeginSession", as(&BeginSession)},
      {"xrEndSession", as(&EndSession)},
      {"xrEnumerateReferenceSpaces", as(&EnumerateSpaces)},
      {"xrCreateReferenceSpace", as(&CreateSpace)},
      {"xrDestroySpace", as(&DestroySpace)},
      {"xrLocateSpace", as(&LocateSpace)},
      {"xrLocateViews", as(&LocateViews)},
      {"xrConvertTimespecTimeToTimeKHR", as(&ToXrTime)},
      {"xrConvertTimeToTimespecTimeKHR", as(&ToTimespec)},
      {"xrWaitFrame", as(&WaitFrame)},
      {"xrBeginFrame", as(&BeginFrame)},
      {"xrEndFrame", as(&EndFrame)},
      {"xrEnumerateSwapchainFormats", as(&EnumerateFormats)},
      {"xrCreateSwapchain", as(&CreateSwapchain)},
      {"xrDestroySwapchain", as(&DestroySwapchain)},
      {"xrEnumerateSwapchainImages", as(&EnumerateImages)},
      {"xrAcquireSwapchainImage", as(&AcquireImage)},
      {"xrWaitSwapchainImage", as(&WaitImage)},
      {"xrReleaseSwapchainImage", as(&ReleaseImage)},
  };
  const auto found = kFunctions.find(name);
  *function = found == kFunctions.end() ? nullptr : found->second;
  return found == kFunctions.end() ? XR_ERROR_FUNCTION_UNSUPPORTED : XR_SUCCESS;
}

// As the loader has them (OpenXR-SDK, loader_interfaces.h, version 1), whose header Debian doesn't ship.
struct LoaderInfo {
  std::int32_t type;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t least_interface, most_interface;
  XrVersion least_api, most_api;
};
struct RuntimeRequest {
  std::int32_t type;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t interface;
  XrVersion api;
  PFN_xrGetInstanceProcAddr get_address;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const LoaderInfo* loader, RuntimeRequest* request) {
  if (loader == nullptr || request == nullptr || loader->least_interface > 1)
    return XR_ERROR_INITIALIZATION_FAILED;
  static Runtime only;
  runtime = &only;
  request->interface = 1;
  request->api = XR_CURRENT_API_VERSION;
  request->get_address = &GetAddress;
  return XR_SUCCESS;
}
