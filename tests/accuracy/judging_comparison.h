// What contacts and clearance cost, against how exact they are and what they are asked of.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "recon/synthetic/view_scene.h"
#include "tests/accuracy/interleaved_timing.h"

namespace elbowroom::accuracy {

// A method in one of its settings, over the same poses of a panel (MakeTabletopPanel).
struct JudgingMethod {
  std::string family, setting;
  double time_ms = 0.0;      // a pose: mean over the poses of their medians
  double rms_error = 0.0;    // contacts: of the area, %; clearance: mm
  double worst_error = 0.0;  // likewise
  double promised = 0.0;     // contacts: 0; clearance: upper - lower at most, mm; 0: nothing is promised
  int missed = 0;            // poses of which it reports nothing that should be there
};

// The area of the panel that is in the hull, the panel pushed into the demo's hand by up to 20 mm from
// random sides, against samples 0.1 mm apart that are looked up in the masks (oracles::MaskHullOracle): the
// exact contacts at several resolutions, and the paper's viewports of several sizes, each sample standing for
// its pixel's area. Hull or textures at hand; one thread.
[[nodiscard]] std::vector<JudgingMethod> CompareContactAreas(int poses, std::uint64_t seed,
                                                             const TimingEffort& effort = {});

// How far the panel is from the hull, 5 to 60 mm away from it: the upper bound at several tolerances, and
// the least distance between panel and hull mesh (recon::MeshHull, then FCL) for each of the edges;
// both against the clearance to a thousandth of a millimetre, which tests/review/clearance_test.cc holds to
// an oracle. Hull at hand; one thread.
[[nodiscard]] std::vector<JudgingMethod> CompareClearances(int poses, std::uint64_t seed,
                                                           std::span<const double> mesh_edges_mm,
                                                           const TimingEffort& effort = {});

// One thing changed at a time, the others as they are: 720 triangles 10 mm in the hull, three cameras, the
// demo's hand.
struct JudgingCost {
  std::string what;
  std::size_t triangles = 0, cameras = 0;
  double hull_cm3 = 0.0;  // of its mesh with edges of 4 mm
  double contact_area_mm2 = 0.0;
  Timing contacts;
  std::int64_t contact_queries = 0;
  double skipped_triangles = 0.0;  // share of those settled with their branch of the tree
  Timing clearance;                // the panel 30 mm away
  std::int64_t clearance_queries = 0;
};
[[nodiscard]] std::vector<JudgingCost> MeasureJudgingCosts(const TimingEffort& effort = {});

}  // namespace elbowroom::accuracy
