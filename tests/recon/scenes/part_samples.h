// Random parts about a workspace, and their samples in the hull held to the oracle.
#pragma once

#include <span>
#include <string>

#include "recon/paper_methods/triangle_viewports.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/recon/scenes/sweep_oracle.h"

namespace elbowroom::recon {

// Plain triangles, needles, slivers, some without area, from a twentieth of the box to all of it, about it.
[[nodiscard]] core::TriangleMesh RandomTriangles(Random* random, const Eigen::AlignedBox3d& box_mm,
                                                 int count);

struct SampleCheck {
  int wrong_samples = 0;   // labelled otherwise than the oracle is sure of, or where there is no sample
  int unsure_samples = 0;  // within the band
  int hull_samples = 0;    // that the oracle is sure are in the hull
  std::string first_wrong;
};

// Samples are counted by the viewports' definition, in rational numbers: pixel by pixel, against the edges.
[[nodiscard]] SampleCheck CheckSamples(const core::Rig& rig, std::span<const core::SoftMask> masks,
                                       const core::TriangleMesh& part,
                                       const core::RigidTransform& world_from_part,
                                       const TriangleViewportOptions& options, const SampledContacts& sampled,
                                       const SweepBand& band);

}  // namespace elbowroom::recon
