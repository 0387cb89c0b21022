#include "recon/gl/objects/egl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace elbowroom::recon::gl {
namespace {

using core::Error;
using core::ErrorKind;

constexpr std::string_view kRemedy =
    "install libegl1, libgl1 and libegl-mesa0 (software) or the GPU's driver";

// Parts of the names that Mesa, X servers and ANGLE give to renderers that draw with the processor. Zink's
// name holds that of the renderer below it.
constexpr std::array<std::string_view, 5> kSoftwareRenderers = {"llvmpipe", "softpipe", "swrast",
                                                                "Software Rasterizer", "SwiftShader"};

struct Display {
  std::string name;
  EGLDisplay display = EGL_NO_DISPLAY;
};

// Holds one context and, where the driver knows no surfaceless contexts, its 1 x 1 surface.
struct Attempt {
  EGLContext context = EGL_NO_CONTEXT;
  EGLSurface surface = EGL_NO_SURFACE;
  std::string failure;  // empty: it worked
};

// libepoxy ends the process when a library is missing, so look first.
void RequireLibraries() {
  const auto present = [](const char* name) {
    void* library = ::dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    if (library != nullptr) ::dlclose(library);
    return library != nullptr;
  };
  if (!present("libEGL.so.1") || !(present("libOpenGL.so.0") || present("libGL.so.1"))) {
    throw Error(ErrorKind::kGraphics,
                fmt::format("cannot draw: libEGL.so.1 or libGL.so.1 is missing; {}", kRemedy));
  }
}

bool HasExtension(const char* extensions, std::string_view wanted) {
  return extensions != nullptr && epoxy_extension_in_string(extensions, std::string(wanted).c_str());
}

void AppendDevices(const char* client_extensions, bool software, std::vector<Display>& displays) {
  if (!HasExtension(client_extensions, "EGL_EXT_platform_device") ||
      !(HasExtension(client_extensions, "EGL_EXT_device_base") ||
        (HasExtension(client_extensions, "EGL_EXT_device_enumeration") &&
         HasExtension(client_extensions, "EGL_EXT_device_query")))) {
    return;
  }
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) return;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
    if (HasExtension(extensions, "EGL_MESA_device_software") != software) continue;
    displays.push_back({fmt::format("EGL device {}", i),
                        eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr)});
  }
}

std::vector<Display> ListDisplays() {
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const bool has_platforms = HasExtension(extensions, "EGL_EXT_platform_base");
  std::vector<Display> displays;
  if (has_platforms) AppendDevices(extensions, /*software=*/false, displays);
  if (has_platforms && HasExtension(extensions, "EGL_MESA_platform_surfaceless")) {
    displays.push_back({"surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                                                EGL_DEFAULT_DISPLAY, nullptr)});
  }
  if (has_platforms) AppendDevices(extensions, /*software=*/true, displays);
  displays.push_back({"default display", eglGetDisplay(EGL_DEFAULT_DISPLAY)});
  return displays;
}

void Release(EGLDisplay display, const Attempt& attempt) {
  if (attempt.context != EGL_NO_CONTEXT && eglGetCurrentContext() == attempt.context) {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  if (attempt.surface != EGL_NO_SURFACE) eglDestroySurface(display, attempt.surface);
  if (attempt.context != EGL_NO_CONTEXT) eglDestroyContext(display, attempt.context);
}

Attempt Failed(EGLDisplay display, const Attempt& attempt, std::string_view what) {
  const EGLint code = eglGetError();
  Release(display, attempt);
  return {EGL_NO_CONTEXT, EGL_NO_SURFACE, fmt::format("{} (EGL error {:#x})", what, code)};
}

Attempt Open(EGLDisplay display) {
  Attempt attempt;
  if (display == EGL_NO_DISPLAY) return Failed(display, attempt, "no display");
  if (!eglInitialize(display, nullptr, nullptr)) return Failed(display, attempt, "no driver");
  const bool surfaceless =
      HasExtension(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context");
  const std::array<EGLint, 5> config_attributes{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE,
                                                surfaceless ? 0 : EGL_PBUFFER_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint config_count = 0;
  if (!eglChooseConfig(display, config_attributes.data(), &config, 1, &config_count) || config_count < 1 ||
      !eglBindAPI(EGL_OPENGL_API)) {
    return Failed(display, attempt, "no desktop OpenGL");
  }
  constexpr std::array<EGLint, 7> kContextAttributes{EGL_CONTEXT_MAJOR_VERSION,
                                                     3,
                                                     EGL_CONTEXT_MINOR_VERSION,
                                                     3,
                                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                     EGL_NONE};
  attempt.context = eglCreateContext(display, config, EGL_NO_CONTEXT, kContextAttributes.data());
  if (attempt.context == EGL_NO_CONTEXT) return Failed(display, attempt, "no OpenGL 3.3 core context");
  if (!surfaceless) {
    constexpr std::array<EGLint, 5> kSurfaceAttributes{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    attempt.surface = eglCreatePbufferSurface(display, config, kSurfaceAttributes.data());
    if (attempt.surface == EGL_NO_SURFACE) return Failed(display, attempt, "no off-screen surface");
  }
  if (!eglMakeCurrent(display, attempt.surface, attempt.surface, attempt.context)) {
    return Failed(display, attempt, "context cannot be made current");
  }
  return attempt;
}

std::string GlString(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text == nullptr ? std::string("unknown") : std::string(text);
}

}  // namespace

// The display itself is never terminated: EGL gives every caller in the process the same one, and ending it
// would take the other contexts with it.
struct EglContext::Native {
  EGLDisplay display = EGL_NO_DISPLAY;
  Attempt attempt;

  Native(EGLDisplay on_display, Attempt opened) : display(on_display), attempt(std::move(opened)) {}
  Native(const Native&) = delete;
  Native& operator=(const Native&) = delete;
  ~Native() { Release(display, attempt); }
};

EglContext::EglContext() {
  RequireLibraries();
  std::string failures;
  for (const Display& candidate : ListDisplays()) {
    Attempt attempt = Open(candidate.display);
    if (attempt.failure.empty()) {
      native_ = std::make_unique<Native>(candidate.display, std::move(attempt));
      platform_ = candidate.name;
      vendor_ = GlString(GL_VENDOR);
      renderer_ = GlString(GL_RENDERER);
      version_ = GlString(GL_VERSION);
      driver_ = fmt::format("{} | {} | {}", vendor_, renderer_, version_);
      return;
    }
    failures += fmt::format("{}{}: {}", failures.empty() ? "" : ", ", candidate.name, attempt.failure);
  }
  throw Error(ErrorKind::kGraphics,
              fmt::format("cannot draw: no EGL display gives OpenGL 3.3 ({}); {}", failures, kRemedy));
}

EglContext::~EglContext() = default;
EglContext::EglContext(EglContext&&) noexcept = default;
EglContext& EglContext::operator=(EglContext&&) noexcept = default;

bool EglContext::is_software() const {
  return std::any_of(kSoftwareRenderers.begin(), kSoftwareRenderers.end(),
                     [&](std::string_view name) { return renderer_.find(name) != std::string::npos; });
}

void EglContext::MakeCurrent() const {
  core::Require(native_ != nullptr, "a context that was moved from isn't used");
  if (eglGetCurrentContext() == native_->attempt.context) return;
  eglBindAPI(EGL_OPENGL_API);
  if (!eglMakeCurrent(native_->display, native_->attempt.surface, native_->attempt.surface,
                      native_->attempt.context)) {
    throw Error(ErrorKind::kGraphics,
                fmt::format("cannot draw on {}: the context cannot be made current (EGL error {:#x}); use it "
                            "on one thread only",
                            renderer_, eglGetError()));
  }
}

bool EglContext::MakeCurrentOrReplace() noexcept {
  try {
    MakeCurrent();
  } catch (const Error&) {
    // In this order: a new context may get the handle of one that the driver has given up.
    const EGLDisplay display = native_->display;
    native_.reset();
    native_ = std::make_unique<Native>(display, Open(display));
  }
  return native_->attempt.failure.empty();
}

}  // namespace elbowroom::recon::gl
