// The OpenXR loader, opened by hand: there may be none.
#pragma once

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <ctime>

#define XR_NO_PROTOTYPES
#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_EGL
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace elbowroom::recon {

// The runtime is gone: another one may come.
class RuntimeLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

[[nodiscard]] std::string_view NameOf(XrResult result);  // "XR_ERROR_INSTANCE_LOST"

// Throws: RuntimeLost for the results that mean so; Error{kCamera} naming what failed for other errors.
void CheckXr(XrResult result, const char* what);

// A struct of OpenXR: all zero but for its type.
template <typename Struct>
[[nodiscard]] Struct XrStruct(XrStructureType type) {
  Struct its{};
  its.type = type;
  return its;
}

// Loaded for an instance; those of extensions are null where the extension isn't enabled.
struct XrFunctions {
  // Throws: Error{kFile} saying what to install when there is no loader.
  XrFunctions();
  void LoadFor(XrInstance instance);

  PFN_xrGetInstanceProcAddr get_address = nullptr;
  PFN_xrEnumerateInstanceExtensionProperties EnumerateInstanceExtensionProperties = nullptr;
  PFN_xrCreateInstance CreateInstance = nullptr;
  PFN_xrDestroyInstance DestroyInstance = nullptr;
  PFN_xrGetInstanceProperties GetInstanceProperties = nullptr;
  PFN_xrPollEvent PollEvent = nullptr;
  PFN_xrGetSystem GetSystem = nullptr;
  PFN_xrGetSystemProperties GetSystemProperties = nullptr;
  PFN_xrEnumerateViewConfigurationViews EnumerateViewConfigurationViews = nullptr;
  PFN_xrEnumerateEnvironmentBlendModes EnumerateEnvironmentBlendModes = nullptr;
  PFN_xrCreateSession CreateSession = nullptr;
  PFN_xrDestroySession DestroySession = nullptr;
  PFN_xrBeginSession BeginSession = nullptr;
  PFN_xrEndSession EndSession = nullptr;
  PFN_xrEnumerateReferenceSpaces EnumerateReferenceSpaces = nullptr;
  PFN_xrCreateReferenceSpace CreateReferenceSpace = nullptr;
  PFN_xrLocateSpace LocateSpace = nullptr;
  PFN_xrLocateViews LocateViews = nullptr;
  PFN_xrWaitFrame WaitFrame = nullptr;
  PFN_xrBeginFrame BeginFrame = nullptr;
  PFN_xrEndFrame EndFrame = nullptr;
  PFN_xrEnumerateSwapchainFormats EnumerateSwapchainFormats = nullptr;
  PFN_xrCreateSwapchain CreateSwapchain = nullptr;
  PFN_xrDestroySwapchain DestroySwapchain = nullptr;
  PFN_xrEnumerateSwapchainImages EnumerateSwapchainImages = nullptr;
  PFN_xrAcquireSwapchainImage AcquireSwapchainImage = nullptr;
  PFN_xrWaitSwapchainImage WaitSwapchainImage = nullptr;
  PFN_xrReleaseSwapchainImage ReleaseSwapchainImage = nullptr;
  PFN_xrGetOpenGLGraphicsRequirementsKHR GetOpenGLGraphicsRequirementsKHR = nullptr;
  PFN_xrConvertTimespecTimeToTimeKHR ConvertTimespecTimeToTimeKHR = nullptr;
  PFN_xrConvertTimeToTimespecTimeKHR ConvertTimeToTimespecTimeKHR = nullptr;

 private:
  template <typename Function>
  void Find(XrInstance instance, const char* name, Function* function) const {
    PFN_xrVoidFunction found = nullptr;
    const bool is_there = XR_SUCCEEDED(get_address(instance, name, &found));
    *function = is_there ? reinterpret_cast<Function>(found) : nullptr;
  }
};

}  // namespace elbowroom::recon
