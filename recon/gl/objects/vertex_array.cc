#include "recon/gl/objects/vertex_array.h"

#include "core/error.h"

namespace elbowroom::recon::gl {

VertexArray::VertexArray(std::initializer_list<int> attribute_sizes) {
  for (const int size : attribute_sizes) floats_per_vertex_ += static_cast<std::size_t>(size);
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  GLuint index = 0;
  std::size_t offset = 0;
  for (const int size : attribute_sizes) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE,
                          static_cast<GLsizei>(floats_per_vertex_ * sizeof(float)),
                          reinterpret_cast<const void*>(offset));
    offset += static_cast<std::size_t>(size) * sizeof(float);
    ++index;
  }
}

void VertexArray::Upload(std::span<const float> floats, Refill refill) {
  core::Require(floats_per_vertex_ > 0 && floats.size() % floats_per_vertex_ == 0,
                "an upload holds whole vertices");
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(floats.size_bytes()), floats.data(),
               refill == Refill::kOnce ? GL_STATIC_DRAW : GL_STREAM_DRAW);
  vertex_count_ = static_cast<GLsizei>(floats.size() / floats_per_vertex_);
}

void VertexArray::Draw(GLenum primitive, GLsizei vertex_count) const {
  if (vertex_count == 0) return;
  glBindVertexArray(array_.get());
  glDrawArrays(primitive, 0, vertex_count);
}

}  // namespace elbowroom::recon::gl
