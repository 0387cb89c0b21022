#include "recon/headset/child/xr_functions.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <openxr/openxr_reflection.h>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr const char* kLoader = "libopenxr_loader.so.1";

}  // namespace

std::string_view NameOf(XrResult result) {
#define ELBOWROOM_NAME_RESULT(name, value) \
  case name:                               \
    return #name;
  switch (result) { XR_LIST_ENUM_XrResult(ELBOWROOM_NAME_RESULT) default : return "an unknown result"; }
#undef ELBOWROOM_NAME_RESULT
}

void CheckXr(XrResult result, const char* what) {
  if (XR_SUCCEEDED(result)) return;
  const std::string text = fmt::format("the OpenXR runtime can't {} ({})", what, NameOf(result));
  if (result == XR_ERROR_INSTANCE_LOST || result == XR_ERROR_SESSION_LOST ||
      result == XR_ERROR_RUNTIME_FAILURE)
    throw RuntimeLost(text);
  throw core::Error(core::ErrorKind::kCamera, text);
}

XrFunctions::XrFunctions() {
  void* loader = ::dlopen(kLoader, RTLD_NOW | RTLD_LOCAL);
  if (loader == nullptr)
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("the OpenXR loader ({}) isn't installed: install libopenxr-loader1", kLoader));
  get_address = reinterpret_cast<PFN_xrGetInstanceProcAddr>(::dlsym(loader, "xrGetInstanceProcAddr"));
  if (get_address == nullptr)
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("{} is no OpenXR loader: install libopenxr-loader1 again", kLoader));
  Find(XR_NULL_HANDLE, "xrEnumerateInstanceExtensionProperties", &EnumerateInstanceExtensionProperties);
  Find(XR_NULL_HANDLE, "xrCreateInstance", &CreateInstance);
}

void XrFunctions::LoadFor(XrInstance instance) {
  Find(instance, "xrDestroyInstance", &DestroyInstance);
  Find(instance, "xrGetInstanceProperties", &GetInstanceProperties);
  Find(instance, "xrPollEvent", &PollEvent);
  Find(instance, "xrGetSystem", &GetSystem);
  Find(instance, "xrGetSystemProperties", &GetSystemProperties);
  Find(instance, "xrEnumerateViewConfigurationViews", &EnumerateViewConfigurationViews);
  Find(instance, "xrEnumerateEnvironmentBlendModes", &EnumerateEnvironmentBlendModes);
  Find(instance, "xrCreateSession", &CreateSession);
  Find(instance, "xrDestroySession", &DestroySession);
  Find(instance, "xrBeginSession", &BeginSession);
  Find(instance, "xrEndSession", &EndSession);
  Find(instance, "xrEnumerateReferenceSpaces", &EnumerateReferenceSpaces);
  Find(instance, "xrCreateReferenceSpace", &CreateReferenceSpace);
  Find(instance, "xrLocateSpace", &LocateSpace);
  Find(instance, "xrLocateViews", &LocateViews);
  Find(instance, "xrWaitFrame", &WaitFrame);
  Find(instance, "xrBeginFrame", &BeginFrame);
  Find(instance, "xrEndFrame", &EndFrame);
  Find(instance, "xrEnumerateSwapchainFormats", &EnumerateSwapchainFormats);
  Find(instance, "xrCreateSwapchain", &CreateSwapchain);
  Find(instance, "xrDestroySwapchain", &DestroySwapchain);
  Find(instance, "xrEnumerateSwapchainImages", &EnumerateSwapchainImages);
  Find(instance, "xrAcquireSwapchainImage", &AcquireSwapchainImage);
  Find(instance, "xrWaitSwapchainImage", &WaitSwapchainImage);
  Find(instance, "xrReleaseSwapchainImage", &ReleaseSwapchainImage);
  Find(instance, "xrGetOpenGLGraphicsRequirementsKHR", &GetOpenGLGraphicsRequirementsKHR);
  Find(instance, "xrConvertTimespecTimeToTimeKHR", &ConvertTimespecTimeToTimeKHR);
  Find(instance, "xrConvertTimeToTimespecTimeKHR", &ConvertTimeToTimespecTimeKHR);
}

}  // namespace elbowroom::recon
