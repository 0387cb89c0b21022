#include "app/control/render_worker.h"

#include <exception>
#include <optional>
#include <utility>

#include "app/control/scene_composer.h"
#include "recon/gl/scene_renderer.h"

namespace elbowroom::control {

RenderWorker::RenderWorker(OnImage on_image, OnError on_error)
    : on_image_(std::move(on_image)), on_error_(std::move(on_error)), thread_([this] { Run(); }) {}

RenderWorker::~RenderWorker() { requests_.Close(); }

void RenderWorker::Run() {
  std::optional<recon::gl::SceneRenderer> renderer;
  while (const std::optional<RenderRequest> request = requests_.Pop()) {
    try {
      if (!renderer) {
        renderer.emplace();
        const std::lock_guard lock(driver_mutex_);
        driver_ = renderer->driver();
      }
      const recon::SceneView view = recon::ViewFrom(request->camera, request->width_px, request->height_px);
      on_image_(renderer->Render(ComposeScene(*request->result, view, request->hull_scale)), *request);
    } catch (const std::exception& error) {  // the worker's outermost loop: nothing may escape a thread
      on_error_(error.what());
    }
  }
}

}  // namespace elbowroom::control
