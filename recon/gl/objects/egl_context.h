// An OpenGL context without a window: on a GPU where there is one, else on software Mesa.
#pragma once

#include <memory>
#include <string>

namespace elbowroom::recon::gl {

// OpenGL 3.3 core. Tried in this order: hardware EGL devices, Mesa's surfaceless platform, software EGL
// devices, the default display; needs no window system. Move-only.
// Thread: made, used and destroyed on one thread; several may live in a process, on one thread or on many.
class EglContext {
 public:
  // Leaves the context current. Throws: Error{kGraphics} with what each display answered and what to install.
  EglContext();
  ~EglContext();
  EglContext(EglContext&&) noexcept;
  EglContext& operator=(EglContext&&) noexcept;

  // Throws: Error{kGraphics} when the driver refuses, for example because another thread holds the context.
  void MakeCurrent() const;

  // For destructors: where the driver has lost the context, an empty one takes its place, in which there is
  // nothing to delete. False: the driver gives no context at all any more.
  [[nodiscard]] bool MakeCurrentOrReplace() noexcept;

  [[nodiscard]] const std::string& platform() const { return platform_; }  // "EGL device 0", "surfaceless"...
  [[nodiscard]] const std::string& vendor() const { return vendor_; }
  [[nodiscard]] const std::string& renderer() const { return renderer_; }
  [[nodiscard]] const std::string& version() const { return version_; }
  [[nodiscard]] const std::string& driver() const { return driver_; }  // the three in one line

  // The processor does the drawing, as far as the renderer's name tells.
  [[nodiscard]] bool is_software() const;

 private:
  struct Native;
  std::unique_ptr<Native> native_;
  std::string platform_;
  std::string vendor_;
  std::string renderer_;
  std::string version_;
  std::string driver_;
};

}  // namespace elbowroom::recon::gl
