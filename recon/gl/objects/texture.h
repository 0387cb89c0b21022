// Images on the graphics card. For the .cc files of this folder: it includes OpenGL.
#pragma once

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

// One or three floats a texel, read with texelFetch: no filtering, no mipmaps.
class FloatTexture {
 public:
  explicit FloatTexture(int channels) : channels_(channels) {}

  // Row-major, width_px * height_px * channels floats. Throws: PreconditionError when the count differs.
  void Upload(int width_px, int height_px, std::span<const float> floats);

  // The same, but where the size has not changed only these texels are renewed: the others stay as they were.
  void UploadWithin(int width_px, int height_px, std::span<const float> floats, const TexelBox& texels);

  void BindTo(int unit) const;

 private:
  GlName<TextureKind> texture_;
  int channels_;
  int width_px_ = 0;
  int height_px_ = 0;
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
