// Hard parts at seeded places about hard hulls: the ground on which speed and bounds are measured.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/bvh.h"
#include "core/rigid_transform.h"
#include "core/surface_patches.h"
#include "tests/accuracy/hard/hard_hulls.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::accuracy {

struct HardOptions {
  int triangles = 28'000;  // of each part but the scan
  int scan_triangles = 1'000'000;
  int places_each = 3;  // seeded places of each kind
  std::uint64_t seed = 6113;
};

struct HardPart {
  std::string name;
  std::shared_ptr<const core::TriangleTree> tree;
  std::shared_ptr<const core::SurfacePatches> patches;
  bool encloses = false;  // the hull stands in it
};

// Flat (a panel), convex (a sphere), a forest of needles, a scan: the same for every hull.
[[nodiscard]] std::vector<HardPart> PartsForAll(const HardOptions& options);

// Concave (a bore along x) and equidistant (a round shell; a sleeve, which is the hull made thicker all
// over), each kAroundMm around this hull or more.
inline constexpr double kAroundMm = 50.0;
[[nodiscard]] std::vector<HardPart> PartsAround(const SeenHull& seen, const HardOptions& options);

enum class HardPlace {
  kTouching,  // 1 to 5 mm farther than the first touch
  kClose,     // 1 to 5 mm away
  kFar,       // 30 to 50 mm away
  kAmid,      // the middle of the one in the middle of the other
};
inline constexpr std::array kHardPlaces = {HardPlace::kTouching, HardPlace::kClose, HardPlace::kFar,
                                           HardPlace::kAmid};
[[nodiscard]] std::string_view ToString(HardPlace place);  // "touching", ...

// Where the part comes from a random side to such a place: a part that encloses the hull from around it, any
// other, turned at random, from outside towards a random point of the hull's surface.
[[nodiscard]] core::RigidTransform PlaceOf(const SeenHull& seen, const HardPart& part, HardPlace place,
                                           recon::Random* random);

struct HardCase {
  HardPart part;
  HardPlace place = HardPlace::kTouching;
  core::RigidTransform world_from_part;
};

// options.places_each of every kind for each part.
[[nodiscard]] std::vector<HardCase> CasesOf(const SeenHull& seen, const std::vector<HardPart>& parts,
                                            const HardOptions& options);

}  // namespace elbowroom::accuracy
