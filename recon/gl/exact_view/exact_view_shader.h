// The exact view of one pixel, as shader source.
#pragma once

namespace elbowroom::recon::gl {

// Attribute 0: a corner of a square, as OpenGL's clip coordinates.
extern const char* const kExactViewVertexSource;

// Reads PencilTables and the view's rays; writes depth (target 0) and caster, edge (target 1). The same steps
// as tile_cast.cc, a ray at a time; docs/exact_view_gl.md says by how much float32 may make the results
// differ.
extern const char* const kExactViewFragmentSource;

}  // namespace elbowroom::recon::gl
