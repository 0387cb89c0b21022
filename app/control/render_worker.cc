#include "app/control/render_worker.h"

#include <exception>
#include <optional>
#include <utility>

#include "core/error.h"
#include "recon/gl/scene/scene_renderer.h"

namespace elbowroom::control {
namespace {

recon::SceneView ViewOf(const RenderRequest& request) {
  if (request.fixed_view) return *request.fixed_view;
  return recon::ViewFrom(request.camera, request.width_px, request.height_px);
}

}  // namespace

RenderWorker::RenderWorker(OnImage on_image, OnError on_error)
    : on_image_(std::move(on_image)), on_error_(std::move(on_error)), thread_([this] { Run(); }) {}

RenderWorker::~RenderWorker() { requests_.Close(); }

void RenderWorker::Run() {
  std::optional<recon::gl::SceneRenderer> renderer;
  std::optional<ExactViewMaker> views;
  SceneComposer composer([&views](const recon::VisualHull& hull, const recon::ViewRays& rays,
                                  recon::HullView kept) { return views->Make(hull, rays, std::move(kept)); });
  std::optional<RenderRequest> last;
  while (const auto next = requests_.Pop()) {
    try {
      if (const auto* hull = std::get_if<SharedHull>(&*next)) {
        if (last && views) composer.Foresee(*hull, ViewOf(*last), last->hull_scale);
        continue;
      }
      const auto* request = &std::get<RenderRequest>(*next);
      if (!renderer) {
        renderer.emplace(recon::gl::PartDetail::kOnDemand);
        views.emplace(GraphicsCard(renderer->driver(), renderer->is_software()));
        const std::lock_guard lock(driver_mutex_);
        driver_ = renderer->driver();
        is_software_ = renderer->is_software();
      }
      recon::gl::Scene scene = request->scene ? *request->scene
                                              : composer.Compose(*request->result, ViewOf(*request),
                                                                 request->look, request->hull_scale);
      scene.view = ViewOf(*request);
      scene.largest_px = request->largest_px;
      if (!request->is_smooth) scene.smoothness = recon::gl::Smoothness::kOneSample;
      on_image_(renderer->Render(scene), *request);
      last = *request;
    } catch (const std::exception& error) {  // the worker's outermost loop: nothing may escape a thread
      const auto* failure = dynamic_cast<const core::Error*>(&error);
      if (failure != nullptr && failure->kind() == core::ErrorKind::kGraphics) {
        views.reset();
        renderer.reset();
      }
      on_error_(error.what());
    }
  }
}

}  // namespace elbowroom::control
