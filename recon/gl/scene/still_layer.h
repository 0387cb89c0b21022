// What stays in the picture while the hull moves. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "recon/gl/objects/framebuffer.h"
#include "recon/gl/objects/gl_name.h"
#include "recon/gl/objects/object_kinds.h"
#include "recon/gl/objects/shader_program.h"
#include "recon/gl/objects/vertex_array.h"
#include "recon/gl/scene/lighting.h"
#include "recon/gl/scene/part_painter.h"
#include "recon/gl/scene/scene.h"
#include "recon/gl/scene/view_matrices.h"

namespace elbowroom::recon::gl {

// Background, opaque parts, table and lines of a scene, drawn once and kept until one of them, the eye or the
// lamp changes. A pixel keeps its colour with the parts' shadows, its colour without any light of the lamp,
// and its surface's place and normal. The share of the lamp's light that the hull lets through then mixes the
// two: colours are linear in it. So the hull's shadow falls on the layer without drawing it again
// (docs/appearance.md, "What stays").
class StillLayer {
 public:
  StillLayer();

  // Whether the layer gives the picture that drawing everything gives: one sample a pixel, the table seen
  // from above, and no opaque part that reaches below it. The painter must be up to date with the scene.
  [[nodiscard]] static bool Suits(const Scene& scene, const PartPainter& parts);

  // Whether it needs no drawing for this scene. The painter and the light must be up to date with it.
  [[nodiscard]] bool Holds(const Scene& scene, const PartPainter& parts, const Lighting& light) const;

  // Empties it at the scene's size and makes it the target of drawing: shaders write `pixel`, `unlit` and
  // `place` there. It then holds the scene. Throws: Error{kGraphics} when the driver can't hold it.
  void BeginDrawing(const Scene& scene, const PartPainter& parts, const Lighting& light);

  // To be called when all is drawn: looks where each piece of the picture stands in the lamp's.
  void EndDrawing(const ViewMatrices& matrices, const SceneLamp& lamp);

  // Whether the layer was asked for this scene the last time, too. What changes from picture to picture, as
  // when the eye turns, is drawn sooner without a layer.
  [[nodiscard]] bool ComesAgain(const Scene& scene, const PartPainter& parts, const Lighting& light);

  // Copies colours and depths to the target, which has the same size and one sample, and puts the hull's
  // shadow on them, in those pieces that it can reach. The target is bound afterwards.
  void ShowIn(const Framebuffer& target, const ViewMatrices& matrices, const Lighting& light);

 private:
  struct KeptPart {
    std::weak_ptr<const core::TriangleMesh> mesh;
    core::RigidTransform world_from_part;
    Eigen::Vector3f color;
    bool in_contact = false;
    std::size_t level = 0;
  };
  // All that the layer shows.
  struct Content {
    Scene surroundings;  // without parts and hull
    std::vector<KeptPart> parts;
    std::int64_t part_passes = 0;  // of the parts' shadows
  };
  // A square of the picture.
  struct Tile {
    int x_px = 0;
    int y_px = 0;
    Eigen::AlignedBox2f in_lamp;  // around its surfaces, in shares of the lamp's picture; empty: none
  };
  struct Buffers {
    Buffers(int width_px, int height_px);
    int width_px, height_px;
    GlName<TextureKind> lit, unlit, place;
    GlName<RenderbufferKind> depth;
    GlName<FramebufferKind> framebuffer;
  };
  [[nodiscard]] static Content ContentOf(const Scene& scene, const PartPainter& parts, const Lighting& light);
  [[nodiscard]] static bool AreSame(const Content& a, const Content& b);

  ShaderProgram shadow_program_;
  VertexArray corners_{2};
  std::optional<Buffers> buffers_;
  std::optional<Content> content_, asked_for_;
  std::vector<Tile> tiles_;
};

}  // namespace elbowroom::recon::gl
