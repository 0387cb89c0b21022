// How much of the parts' meshes is drawn.
#pragma once

#include <cstdint>

namespace elbowroom::recon::gl {

enum class PartDetail {
  kWhole,  // each mesh as it is: for pictures that are drawn once
  // A large mesh is drawn whole at first, while coarser levels of it are made on another thread. Then it is
  // drawn at the coarsest level that stays within a quarter of a pixel of the whole mesh. For moving
  // pictures.
  kOnDemand,
};

// Triangles of parts, in every pass of every picture.
struct TriangleCount {
  std::int64_t drawn = 0;
  std::int64_t left_out = 0;  // how many more whole meshes would have had
};

}  // namespace elbowroom::recon::gl
