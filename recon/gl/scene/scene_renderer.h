// Scenes to pictures, off screen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "recon/gl/scene/part_detail.h"
#include "recon/gl/scene/scene.h"
#include "recon/gl/scene/shadow_count.h"
#include "recon/gl/scene/still_count.h"
#include "recon/images/image.h"

namespace elbowroom::recon::gl {

struct DepthImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<float> depth_mm;  // row-major, along the camera's z axis; 0: nothing there
};

// Owns an OpenGL context and all that lives in it; a mesh stays on the graphics card until the last owner of
// its SharedMesh lets go of it. Move-only.
// Thread: every call, the destructor too, on the thread that made it. Several may live in a process.
class SceneRenderer {
 public:
  // Throws: Error{kGraphics} as EglContext, or when the driver refuses a shader.
  explicit SceneRenderer(PartDetail detail = PartDetail::kWhole,
                         StillThings still_things = StillThings::kKept);
  ~SceneRenderer();
  SceneRenderer(SceneRenderer&&) noexcept;
  SceneRenderer& operator=(SceneRenderer&&) noexcept;

  // The picture. The same scene gives the same bytes on the same driver, but for levels of detail that have
  // come in between, and, in pictures of one sample, for 2 of 255 where what stays is kept.
  // Throws: PreconditionError as Scene::Validate; Error{kGeometry} for a mesh that can't be drawn;
  // Error{kGraphics} when the driver fails, for example when it is out of memory.
  [[nodiscard]] Image Render(const Scene& scene);

  // Depth of parts (unless invisible) and hull at the pixels' centres; nothing else is drawn. To about
  // 4 * 2^-24 * z^2 / near_mm (SceneRendererDepth tests). Throws: as Render.
  [[nodiscard]] DepthImage RenderDepth(const Scene& scene);

  // Driver's vendor, renderer and version in one line, for the session's record.
  [[nodiscard]] const std::string& driver() const;
  // The processor does the drawing, as EglContext tells.
  [[nodiscard]] bool is_software() const;

  [[nodiscard]] std::size_t cached_meshes() const;
  [[nodiscard]] std::int64_t mesh_uploads() const;     // since the start
  [[nodiscard]] ShadowCount shadow_count() const;      // since the start
  [[nodiscard]] StillCount still_count() const;        // since the start
  [[nodiscard]] SquareCount square_count() const;      // since the start
  [[nodiscard]] TriangleCount triangle_count() const;  // since the start

  // Waits until the levels of all meshes that were drawn are there.
  void AwaitLevels();

 private:
  class Impl;
  [[nodiscard]] Impl& OnOwnThread() const;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::recon::gl
