// The one thread that owns the GL context and every GL object; pictures come out as values.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>

#include "app/control/frame_result.h"
#include "app/control/scene_composer.h"
#include "core/bounded_queue.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/images/image.h"

namespace elbowroom::control {

struct RenderRequest {
  SharedFrameResult result;  // null: `scene` is drawn
  recon::OrbitCamera camera;
  int width_px = 640;
  int height_px = 480;
  double hull_scale = 1.0;  // as SceneComposer::Compose
  bool is_smooth = true;    // four samples a pixel; false: one, which is drawn sooner
  SceneLook look = {};
  std::optional<recon::SceneView> fixed_view = std::nullopt;  // of the picture's size; takes camera's place
  // Drawn as it is, but for its view and smoothness, which are the request's. Null: `result` is drawn.
  std::shared_ptr<const recon::gl::Scene> scene = nullptr;
  Eigen::Vector2i largest_px = Eigen::Vector2i::Zero();  // as recon::gl::Scene has it
};

// The latest request wins: one that comes while a picture is being drawn replaces one that waits. When the
// driver fails, for example because the graphics card was reset, the next request gets a new context
// (render_worker_test).
// Thread: any may submit; the callbacks come on the worker's thread and must not block.
class RenderWorker {
 public:
  using OnImage = std::function<void(const recon::Image&, const RenderRequest&)>;
  using OnError = std::function<void(const std::string&)>;  // one line; no picture comes for that request

  RenderWorker(OnImage on_image, OnError on_error);
  ~RenderWorker();
  RenderWorker(const RenderWorker&) = delete;
  RenderWorker& operator=(const RenderWorker&) = delete;

  void Submit(RenderRequest request) { requests_.Push(std::move(request)); }

  // Prepares the picture of a frame that is still being judged: unless something else waits, the worker
  // computes the view of its hull as in the last request, so that the frame's picture is ready sooner.
  void Foresee(SharedHull hull) { requests_.PushIfEmpty(std::move(hull)); }

  // The processor draws; nothing until the first picture was drawn.
  [[nodiscard]] std::optional<bool> is_software() const {
    const std::lock_guard lock(driver_mutex_);
    return is_software_;
  }

  // Vendor, renderer and version in one line; "" until the first picture was drawn.
  [[nodiscard]] std::string driver() const {
    const std::lock_guard lock(driver_mutex_);
    return driver_;
  }

 private:
  void Run();

  OnImage on_image_;
  OnError on_error_;
  mutable std::mutex driver_mutex_;
  std::string driver_;
  std::optional<bool> is_software_;
  core::BoundedQueue<std::variant<RenderRequest, SharedHull>> requests_{1, core::WhenFull::kDropOldest};
  std::jthread thread_;  // last: it starts when all other members exist
};

}  // namespace elbowroom::control
