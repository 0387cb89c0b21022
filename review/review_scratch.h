// Memory that judging a part leaves for the next frame's judging.
#pragma once

#include <vector>

#include "core/contact.h"
#include "recon/hull/crossing_scratch.h"
#include "review/clearance_cell.h"
#include "review/point_chain.h"

namespace elbowroom::review {

// What the search for contacts works with.
struct ContactSearchScratch {
  PointChunks chunks;
  std::vector<core::ContactPoint> points;  // all that were found
};

// What choosing the points that are kept works with.
struct SpreadScratch {
  std::vector<float> rows;
  std::vector<core::ContactPoint> kept;  // its memory goes into the answer
};

// One part's. It holds no answer, only memory: a part that is judged with the same one frame after frame
// allocates nothing, once the memory is large enough for what the part meets. Thread: one at a time.
struct ReviewScratch {
  ContactSearchScratch search;
  SpreadScratch spread;
  recon::CrossingScratch crossings;
  std::vector<ClearanceCell> cells;
};

}  // namespace elbowroom::review
