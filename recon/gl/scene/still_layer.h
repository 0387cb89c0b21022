// What stays in the picture while the hull moves. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "recon/gl/objects/framebuffer.h"
#include "recon/gl/objects/gl_name.h"
#include "recon/gl/objects/object_kinds.h"
#include "recon/gl/objects/shader_program.h"
#include "recon/gl/objects/vertex_array.h"
#include "recon/gl/scene/lighting.h"
#include "recon/gl/scene/part_painter.h"
#include "recon/gl/scene/scene.h"
#include "recon/gl/scene/still_content.h"
#include "recon/gl/scene/still_count.h"
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

  // What the layer needs to show a content. kNoLayer: to be drawn without one, which is sooner where nearly
  // all changes from picture to picture, as when the eye turns: a layer is drawn whole only for a content
  // that comes the second time in a row.
  enum class Need { kNothing, kSquares, kAll, kNoLayer };
  [[nodiscard]] Need NeedFor(const StillContent& content);

  // Empties the layer, or, for kSquares, those of its squares that differ from the content that NeedFor was
  // given, and makes it the target of drawing. Shaders write `pixel`, `unlit` and `place` there, within those
  // squares alone. `room_px`: the largest view to come. Throws: Error{kGraphics} when the driver can't hold
  // it.
  void BeginDrawing(Need need, const SceneView& view, const Eigen::Vector2i& room_px);

  // The layer shows the content, which NeedFor was given, from here on. Looks where each square of the
  // picture that is new stands in the lamp's.
  void EndDrawing(StillContent content, const ViewMatrices& matrices, const SceneLamp& lamp);

  [[nodiscard]] const SquareCount& square_count() const { return square_count_; }  // since the start

  // Copies colours and depths to the target, which has room for them and one sample, and puts the hull's
  // shadow on them, in those pieces that it can reach. The target is bound afterwards.
  void ShowIn(const Framebuffer& target, const ViewMatrices& matrices, const Lighting& light);

 private:
  // A square of the picture.
  struct Tile {
    int x_px = 0;
    int y_px = 0;
    Eigen::AlignedBox2f in_lamp;  // around its surfaces, in shares of the lamp's picture; empty: none
  };
  struct Buffers {
    explicit Buffers(const Eigen::Vector2i& room_px);
    Eigen::Vector2i room_px;  // of which the layer takes the lower left corner
    GlName<TextureKind> lit, unlit, place;
    GlName<RenderbufferKind> depth;
    GlName<FramebufferKind> framebuffer;
  };
  [[nodiscard]] std::vector<std::size_t> StaleTiles(const StillChange& change) const;
  void EmptyStaleTiles();
  // Finds where these squares' surfaces stand in the lamp's picture. `places`: room to read them back to.
  class LampPlace;
  void PlaceInLamp(std::span<const std::size_t> band, const LampPlace& in_lamp,
                   std::vector<Eigen::Vector4f>& places);

  ShaderProgram shadow_program_;
  ShaderProgram empty_program_;
  VertexArray corners_{2};
  std::optional<Buffers> buffers_;
  int width_px_ = 0, height_px_ = 0;  // of the layer
  std::optional<StillContent> content_, asked_for_;
  std::vector<Tile> tiles_;
  std::vector<std::size_t> stale_;  // places in tiles_, ascending, to be drawn
  int part_shadow_px_ = 1;
  SquareCount square_count_;
};

}  // namespace elbowroom::recon::gl
