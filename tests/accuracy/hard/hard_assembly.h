// An assembly of many parts, written as STEP and imported, and asked part by part as a trial asks.
#pragma once

#include <cstdint>
#include <vector>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/rigid_transform.h"
#include "review/inside_cells.h"
#include "review/part_review.h"
#include "tests/accuracy/hard/hard_cases.h"

namespace elbowroom::accuracy {

// Blocks, posts and rings, turned at random, in layers; a third of the parts each.
inline constexpr int kAssemblyParts = 300;

struct HardAssembly {
  struct Instance {
    std::size_t shape = 0;
    core::RigidTransform assembly_from_part;
  };
  std::vector<core::TriangleTree> shapes;
  std::vector<Instance> instances;
  HardPart whole;  // all of them as one mesh, to place it

  [[nodiscard]] const core::TriangleTree& TreeOf(std::size_t part) const {
    return shapes[instances[part].shape];
  }
};

// Through a STEP file (cad_import::ImportCadFile); so main must have called ServeImport.
[[nodiscard]] HardAssembly ImportHardAssembly(std::uint64_t seed);

// One part of it in a frame, as FramePipeline asks it: required are 15 mm; without a hint from a frame
// before.
[[nodiscard]] review::PartReviewOptions AssemblyReview();
[[nodiscard]] core::PartContact ReviewOf(const recon::VisualHull& hull, const HardAssembly& assembly,
                                         const core::RigidTransform& world_from_assembly, std::size_t part,
                                         review::InsideCells* inside);

}  // namespace elbowroom::accuracy
