// Where a shadow can fall at all, known without drawing it.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "recon/exact_view/hull_view.h"

namespace elbowroom::recon::gl {

inline constexpr float kShadowFilterTexels = 2.0F;  // that a look-up of a shadow may read beside its place

// Of a hull's layer from the lamp: which of kBlocks x kBlocks blocks of the lamp's picture have a place whose
// look-up reads a hit, as sums from the picture's corner (a summed-area table).
class ShadowReach {
 public:
  static constexpr int kBlocks = 64;

  ShadowReach() = default;  // nowhere
  explicit ShadowReach(const HullView& from_lamp);

  // Whether a look-up within the box, in shares of the lamp's picture, can meet a hit.
  [[nodiscard]] bool Meets(const Eigen::AlignedBox2f& box) const;

 private:
  [[nodiscard]] int SumTo(int x, int y) const;  // of the blocks left of x and above y

  std::vector<int> sums_;  // (kBlocks + 1)^2, row by row; empty: nowhere
};

}  // namespace elbowroom::recon::gl
