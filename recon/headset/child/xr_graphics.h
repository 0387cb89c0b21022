// Pictures for the OpenXR runtime, through OpenGL on EGL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "recon/gl/objects/egl_context.h"
#include "recon/headset/child/xr_functions.h"
#include "recon/headset/headset_protocol.h"

namespace elbowroom::recon {

// Thread: one, on which its OpenGL context stays current.
class XrGraphics {
 public:
  // Throws: Error{kGraphics} as EglContext; Error{kCamera}.
  XrGraphics(const XrFunctions& xr, XrInstance instance, XrSystemId system);

  [[nodiscard]] const XrGraphicsBindingEGLMNDX* binding() const { return &binding_; }
  // Throws: Error{kCamera}: the runtime knows no colours of 8 bits.
  void MakeSwapchains(XrSession session, const std::array<XrViewConfigurationView, 2>& sizes);

  // Copies both eyes' pictures to the runtime. Does nothing with one larger than the runtime takes.
  void Take(const PictureForHeadset& picture, const std::array<XrPosef, 2>& eyes, const std::byte* slot);
  // Of the pictures taken last, for a layer; null: there are none yet.
  [[nodiscard]] const XrCompositionLayerProjectionView* views() const {
    return has_picture_ ? views_.data() : nullptr;
  }

 private:
  struct EyeImages {
    XrSwapchain swapchain = XR_NULL_HANDLE;
    std::vector<XrSwapchainImageOpenGLKHR> images;
    std::int32_t width_px = 0;
    std::int32_t height_px = 0;
  };

  void Upload(const EyeImages& eye, const std::uint8_t* rgb, std::int32_t width_px, std::int32_t height_px);

  const XrFunctions& xr_;
  gl::EglContext context_;
  XrGraphicsBindingEGLMNDX binding_ = XrStruct<XrGraphicsBindingEGLMNDX>(XR_TYPE_GRAPHICS_BINDING_EGL_MNDX);
  std::array<EyeImages, 2> eyes_;
  std::array<XrCompositionLayerProjectionView, 2> views_{};
  std::vector<std::uint8_t> upside_down_;
  bool has_picture_ = false;
};

}  // namespace elbowroom::recon
