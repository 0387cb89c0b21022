// Vertices on the graphics card, with their layout. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>

#include "recon/gl/objects/gl_name.h"
#include "recon/gl/objects/object_kinds.h"

namespace elbowroom::recon::gl {

enum class Refill { kOnce, kEachFrame };

// Interleaved float attributes, drawn without indices.
class VertexArray {
 public:
  // Attribute i takes attribute_sizes[i] floats; an empty list draws from gl_VertexID alone.
  explicit VertexArray(std::initializer_list<int> attribute_sizes);

  // Throws: PreconditionError when `floats` doesn't hold whole vertices.
  void Upload(std::span<const float> floats, Refill refill);

  // All vertices uploaded, or `vertex_count` of them where there are no attributes.
  void Draw(GLenum primitive) const { Draw(primitive, vertex_count_); }
  void Draw(GLenum primitive, GLsizei vertex_count) const;

 private:
  struct ArrayKind {
    static GLuint Create() {
      GLuint name = 0;
      glGenVertexArrays(1, &name);
      return name;
    }
    static void Destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
  };

  GlName<ArrayKind> array_;
  GlName<BufferKind> buffer_;
  std::size_t floats_per_vertex_ = 0;
  GLsizei vertex_count_ = 0;
};

}  // namespace elbowroom::recon::gl
