#include "recon/headset/child/xr_graphics.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr XrDuration kLongestWaitNs = 1'000'000'000;

XrFovf FovOf(const EyeTangents& seen) {
  return {static_cast<float>(std::atan(seen.left)), static_cast<float>(std::atan(seen.right)),
          static_cast<float>(std::atan(seen.up)), static_cast<float>(std::atan(seen.down))};
}

EGLConfig CurrentConfig(EGLDisplay display, EGLContext context) {
  EGLint id = 0, count = 0;
  EGLConfig config = nullptr;
  (void)eglQueryContext(display, context, EGL_CONFIG_ID, &id);
  const std::array<EGLint, 3> wanted{EGL_CONFIG_ID, id, EGL_NONE};
  (void)eglChooseConfig(display, wanted.data(), &config, 1, &count);
  return config;
}

}  // namespace

XrGraphics::XrGraphics(const XrFunctions& xr, XrInstance instance, XrSystemId system) : xr_(xr) {
  auto needed = XrStruct<XrGraphicsRequirementsOpenGLKHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR);
  CheckXr(xr.GetOpenGLGraphicsRequirementsKHR(instance, system, &needed), "say which OpenGL it needs");
  binding_.getProcAddress = eglGetProcAddress;
  binding_.display = eglGetCurrentDisplay();
  binding_.context = eglGetCurrentContext();
  binding_.config = CurrentConfig(binding_.display, binding_.context);
}

void XrGraphics::MakeSwapchains(XrSession session, const std::array<XrViewConfigurationView, 2>& sizes) {
  std::array<std::int64_t, 64> formats{};
  std::uint32_t count = 0;
  CheckXr(xr_.EnumerateSwapchainFormats(session, 64, &count, formats.data()), "list its kinds of pictures");
  const auto end = formats.begin() + std::min<std::uint32_t>(count, 64);
  // Pictures have sRGB's values: of the second kind the runtime knows no better.
  constexpr std::array<std::int64_t, 2> kWanted{GL_SRGB8_ALPHA8, GL_RGBA8};
  const auto* format = std::ranges::find_if(
      kWanted, [&](std::int64_t one) { return std::find(formats.begin(), end, one) != end; });
  if (format == kWanted.end())
    throw core::Error(core::ErrorKind::kCamera, "the OpenXR runtime takes no pictures of 8 bits a colour");
  for (std::size_t i = 0; i < 2; ++i) {
    EyeImages& eye = eyes_[i];
    auto info = XrStruct<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
    info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_SAMPLED_BIT |
                      XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
    info.format = *format;
    info.sampleCount = info.faceCount = info.arraySize = info.mipCount = 1;
    info.width = std::min<std::uint32_t>(sizes[i].recommendedImageRectWidth, kMostEyeSidePx);
    info.height = std::min<std::uint32_t>(sizes[i].recommendedImageRectHeight, kMostEyeSidePx);
    CheckXr(xr_.CreateSwapchain(session, &info, &eye.swapchain), "make room for pictures");
    eye.width_px = static_cast<std::int32_t>(info.width);
    eye.height_px = static_cast<std::int32_t>(info.height);
    CheckXr(xr_.EnumerateSwapchainImages(eye.swapchain, 0, &count, nullptr), "make room for pictures");
    eye.images.assign(count, {XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR, nullptr, 0});
    CheckXr(xr_.EnumerateSwapchainImages(eye.swapchain, count, &count,
                                         reinterpret_cast<XrSwapchainImageBaseHeader*>(eye.images.data())),
            "make room for pictures");
  }
}

// OpenGL's first row is the lowest.
void XrGraphics::Upload(const EyeImages& eye, const std::uint8_t* rgb, std::int32_t width_px,
                        std::int32_t height_px) {
  std::uint32_t index = 0;
  CheckXr(xr_.AcquireSwapchainImage(eye.swapchain, nullptr, &index), "take a picture");
  auto patience = XrStruct<XrSwapchainImageWaitInfo>(XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
  patience.timeout = kLongestWaitNs;
  CheckXr(xr_.WaitSwapchainImage(eye.swapchain, &patience), "take a picture");
  const auto row_bytes = static_cast<std::size_t>(3) * static_cast<std::size_t>(width_px);
  upside_down_.resize(row_bytes * static_cast<std::size_t>(height_px));
  for (std::int32_t row = 0; row < height_px; ++row)
    std::copy_n(rgb + row_bytes * static_cast<std::size_t>(height_px - 1 - row), row_bytes,
                upside_down_.data() + row_bytes * static_cast<std::size_t>(row));
  context_.MakeCurrent();
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glBindTexture(GL_TEXTURE_2D, eye.images.at(index).image);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_px, height_px, GL_RGB, GL_UNSIGNED_BYTE, upside_down_.data());
  glBindTexture(GL_TEXTURE_2D, 0);
  glFlush();
  CheckXr(xr_.ReleaseSwapchainImage(eye.swapchain, nullptr), "take a picture");
}

void XrGraphics::Take(const PictureForHeadset& picture, const std::array<XrPosef, 2>& eyes,
                      const std::byte* slot) {
  for (std::size_t i = 0; i < 2; ++i) {
    const bool fits = picture.width_px[i] > 0 && picture.height_px[i] > 0 &&
                      picture.width_px[i] <= eyes_[i].width_px && picture.height_px[i] <= eyes_[i].height_px;
    if (!fits) return;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    Upload(eyes_[i], reinterpret_cast<const std::uint8_t*>(slot + i * kEyeBytes), picture.width_px[i],
           picture.height_px[i]);
    XrCompositionLayerProjectionView& view = views_[i];
    view = XrStruct<XrCompositionLayerProjectionView>(XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW);
    view.pose = eyes[i];
    view.fov = FovOf(picture.seen[i]);
    view.subImage.swapchain = eyes_[i].swapchain;
    view.subImage.imageRect = {{0, 0}, {picture.width_px[i], picture.height_px[i]}};
  }
  has_picture_ = true;
}

}  // namespace elbowroom::recon
