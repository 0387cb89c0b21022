#include "app/control/render_worker.h"

#include <exception>
#include <optional>
#include <utility>

#include "recon/gl/scene_renderer.h"

namespace elbowroom::control {

RenderWorker::RenderWorker(OnImage on_image, OnError on_error)
    : on_image_(std::move(on_image)), on_error_(std::move(on_error)), thread_([this] { Run(); }) {}

RenderWorker::~RenderWorker() { requests_.Close(); }

void RenderWorker::Run() {
  std::optional<recon::gl::SceneRenderer> renderer;
  std::optional<ExactViewMaker> views;
  SceneComposer composer([&views](const recon::VisualHull& hull, const recon::ViewRays& rays,
                                  recon::HullView kept) { return views->Make(hull, rays, std::move(kept)); });
  while (const std::optional<RenderRequest> request = requests_.Pop()) {
    try {
      if (!renderer) {
        renderer.emplace();
        views.emplace(GraphicsCard(renderer->driver(), renderer->is_software()));
        const std::lock_guard lock(driver_mutex_);
        driver_ = renderer->driver();
      }
      const recon::SceneView view = recon::ViewFrom(request->camera, request->width_px, request->height_px);
      const recon::gl::Scene scene =
          composer.Compose(*request->result, view, request->look, request->hull_scale);
      on_image_(renderer->Render(scene), *request);
    } catch (const std::exception& error) {  // the worker's outermost loop: nothing may escape a thread
      on_error_(error.what());
    }
  }
}

}  // namespace elbowroom::control
