#include "recon/gl/objects/egl_context.h"

#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon::gl {
namespace {

TEST(EglContext, OpensWithoutAWindowSystem) {
  ::unsetenv("DISPLAY");
  ::unsetenv("WAYLAND_DISPLAY");
  const EglContext context;
  EXPECT_FALSE(context.vendor().empty());
  EXPECT_FALSE(context.renderer().empty());
  const bool new_enough = context.version() >= "3.3";
  EXPECT_TRUE(new_enough) << context.version();
  std::cout << context.platform() << " | " << context.vendor() << " | " << context.renderer() << " | "
            << context.version() << '\n';
}

TEST(EglContext, SurvivesItsNeighboursEnd) {
  const EglContext first;
  { const EglContext second; }
  EXPECT_NO_THROW(first.MakeCurrent());
}

// As a reset of the graphics card does it. The driver may give the new context the old one's handle.
TEST(EglContext, ALostContextIsReplacedByOneThatIsCurrent) {
  for (int trial = 0; trial < 20; ++trial) {
    EglContext context;
    const EGLDisplay display = eglGetCurrentDisplay();
    const EGLContext lost = eglGetCurrentContext();
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    ASSERT_TRUE(eglDestroyContext(display, lost));
    ASSERT_TRUE(context.MakeCurrentOrReplace());
    ASSERT_NE(eglGetCurrentContext(), EGL_NO_CONTEXT) << "trial " << trial;
  }
}

TEST(EglContext, MovedFromIsNotUsed) {
  EglContext first;
  const EglContext second = std::move(first);
  EXPECT_NO_THROW(second.MakeCurrent());
  // NOLINTNEXTLINE(bugprone-use-after-move, clang-analyzer-cplusplus.Move)
  EXPECT_THROW(first.MakeCurrent(), core::PreconditionError);
}

// In a process of its own, which reads the variable when it first touches EGL.
void OpenWithoutAnyDriver() {
  ::setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
  try {
    const EglContext context;
  } catch (const core::Error& error) {
    std::cerr << error.what() << '\n';
    std::exit(error.kind() == core::ErrorKind::kGraphics ? 1 : 3);
  }
  std::exit(0);
}

TEST(EglContextDeathTest, NoDriverIsOneLineThatSaysWhatToInstall) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(OpenWithoutAnyDriver(), testing::ExitedWithCode(1), "^cannot draw: [^\n]*install [^\n]*\n$");
}

// Likewise: Mesa alone, drawing with the processor.
void OpenSoftware() {
  ::setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/usr/share/glvnd/egl_vendor.d/50_mesa.json", 1);
  ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  const EglContext context;
  std::cerr << context.driver() << '\n';
  std::exit(context.is_software() ? 0 : 1);
}

TEST(EglContextDeathTest, KnowsSoftware) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(OpenSoftware(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace elbowroom::recon::gl
