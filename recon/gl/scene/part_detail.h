// How much of the parts' meshes is drawn.
#pragma once

#include <cstdint>

namespace elbowroom::recon::gl {

enum class PartDetail {
  kWhole,  // each mesh as it is: for pictures that are drawn once
  // Large meshes, once they were drawn whole and coarser levels of them have been made beside the drawing, by
  // the coarsest that stays within a quarter of a pixel of the whole: for moving pictures.
  kOnDemand,
};

// Triangles of parts, in every pass of every picture.
struct TriangleCount {
  std::int64_t drawn = 0;
  std::int64_t left_out = 0;  // what whole meshes would have had beside them
};

}  // namespace elbowroom::recon::gl
