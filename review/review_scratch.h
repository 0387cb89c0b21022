// Memory that judging a part leaves for the next frame's judging.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "core/contact.h"
#include "recon/hull/crossing_scratch.h"
#include "review/clearance_cell.h"
#include "review/contact_stretches.h"
#include "review/point_chain.h"

namespace elbowroom::review {

// What the search for contacts works with.
struct ContactSearchScratch {
  PointChunks chunks;
  std::vector<TakenPlaces> taken;
  std::vector<core::ContactPoint> points;  // all that were found
};

// Points that follow each other, and so are near each other, as SpreadEvenly sees them.
struct SpreadBlock {
  static constexpr int kPoints = 16;
  using Row = Eigen::Array<float, kPoints, 1>;

  std::array<Row, 3> at;  // relative to the first point of all
  Row nearest;            // squared distance to the nearest kept point
  Row nearest_kept;       // which one it is
  std::array<float, 3> center{};
  float radius = 0.0F;
  float farthest = 0.0F;  // the largest of `nearest`
  float reach = 0.0F;     // a kept point at a larger squared distance from the centre is nearest to none
};

// What choosing the points that are kept works with.
struct SpreadScratch {
  std::vector<SpreadBlock> blocks;
  std::vector<core::ContactPoint> kept;  // its memory goes into the answer
};

// One part's. It holds no answer, only memory, and what was prepared of the part's surface: a part that is
// judged with the same one frame after frame allocates nothing, once the memory is large enough for what the
// part meets. Thread: one at a time.
struct ReviewScratch {
  std::unique_ptr<const ContactStretches> stretches;  // null: the part's tree is searched
  ContactSearchScratch search;
  SpreadScratch spread;
  recon::CrossingScratch crossings;
  std::vector<ClearanceCell> cells;
};

}  // namespace elbowroom::review
