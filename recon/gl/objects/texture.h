// Images on the graphics card. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "recon/gl/objects/gl_name.h"
#include "recon/gl/objects/object_kinds.h"

namespace elbowroom::recon::gl {

// Texels [x, right) by [y, bottom).
struct TexelBox {
  int x = 0, y = 0, right = 0, bottom = 0;
};

// One or three floats a texel, read with texelFetch: no filtering, no mipmaps. An image that is smaller than
// the room made for it is at its beginning, the texels (0, 0) to (width_px - 1, height_px - 1).
class FloatTexture {
 public:
  explicit FloatTexture(int channels) : channels_(channels) {}

  // For images of up to this size from here on; what the texture held is lost where that changes. Without,
  // there is room for the largest image that came.
  void MakeRoom(const Eigen::Vector2i& room_px);

  // Row-major, width_px * height_px * channels floats. Throws: PreconditionError when the count differs.
  void Upload(int width_px, int height_px, std::span<const float> floats);

  // The same, but where the size has not changed only these texels are renewed: the others stay as they were.
  void UploadWithin(int width_px, int height_px, std::span<const float> floats, const TexelBox& texels);

  void BindTo(int unit) const;

 private:
  GlName<TextureKind> texture_;
  int channels_;
  Eigen::Vector2i room_px_ = Eigen::Vector2i::Zero();
  Eigen::Vector2i size_px_ = Eigen::Vector2i::Zero();  // of the image
};

// Four bytes a texel, read with texelFetch as numbers in [0, 1].
class ColorTexture {
 public:
  // Row-major, width_px * height_px texels. Throws: PreconditionError when the count differs.
  void Upload(int width_px, int height_px, std::span<const std::array<std::uint8_t, 4>> texels);

  void BindTo(int unit) const;

 private:
  GlName<TextureKind> texture_;
};

}  // namespace elbowroom::recon::gl
