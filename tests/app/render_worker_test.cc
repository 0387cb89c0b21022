// Pictures by a thread of its own, also after the driver has lost its context.
#include "app/control/render_worker.h"

#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include <functional>
#include <future>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"

namespace elbowroom::control {
namespace {

SharedFrameResult DemoFrame() {
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  FramePipeline pipeline(setup.source->rig(), setup.layout, setup.source->ReadBackgrounds({}, {}),
                         setup.segmentation);
  return pipeline.Process(setup.source->Read(60),
                          std::vector<double>{setup.layout.spacings.front().initial_mm});
}

// One request after the other; what each came to.
class Pictures {
 public:
  explicit Pictures(std::function<void()> after_picture)
      : after_picture_(std::move(after_picture)),
        worker_([this](const recon::Image& image, const RenderRequest&) { Deliver(image); },
                [this](const std::string& line) { promise_.set_value(line); }) {}

  std::variant<recon::Image, std::string> Ask(const RenderRequest& request) {
    promise_ = {};
    auto answer = promise_.get_future();
    worker_.Submit(request);
    return answer.get();
  }

 private:
  void Deliver(const recon::Image& image) {
    after_picture_();
    promise_.set_value(image);
  }

  std::function<void()> after_picture_;
  std::promise<std::variant<recon::Image, std::string>> promise_;
  RenderWorker worker_;
};

// What a reset of the graphics card comes to: the context is there no more.
void LoseContext() {
  const EGLDisplay display = eglGetCurrentDisplay();
  const EGLContext context = eglGetCurrentContext();
  ASSERT_NE(context, EGL_NO_CONTEXT);
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  ASSERT_TRUE(eglDestroyContext(display, context));
}

TEST(RenderWorker, DrawsAgainAfterItsContextIsLost) {
  const SharedFrameResult frame = DemoFrame();
  const RenderRequest request{frame, OverviewCamera(*frame, 320, 240), 320, 240, 1.0, false, {}};
  bool is_first = true;
  Pictures pictures([&] {
    if (std::exchange(is_first, false)) LoseContext();
  });
  const auto first = pictures.Ask(request);
  ASSERT_TRUE(std::holds_alternative<recon::Image>(first));
  const auto failed = pictures.Ask(request);
  ASSERT_TRUE(std::holds_alternative<std::string>(failed)) << "the context was destroyed";
  EXPECT_NE(std::get<std::string>(failed).find("cannot draw"), std::string::npos)
      << std::get<std::string>(failed);
  const auto again = pictures.Ask(request);
  ASSERT_TRUE(std::holds_alternative<recon::Image>(again)) << std::get<std::string>(again);
  EXPECT_EQ(std::get<recon::Image>(again).rgb, std::get<recon::Image>(first).rgb);
}

}  // namespace
}  // namespace elbowroom::control
