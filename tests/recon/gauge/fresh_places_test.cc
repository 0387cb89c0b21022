// Rods at places and in directions that no constant of the gauge was chosen by: draws 1 to 8 were, these
// weren't.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "recon/gauge/rod_gauge.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/recon/gauge/rod_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using testing::Rod;
using testing::RodStage;
using testing::Silhouettes;

constexpr unsigned kFirstFreshDraw = 9;

struct FreshCase {
  const char* title;
  core::Rig rig;
  double diameter_mm;
  double length_mm;
  Silhouettes silhouettes;
  bool has_hand = false;
  double share = 0.5;  // of the workspace
};

bool IsBeyond(const BoundedMm& measured, double true_mm) {
  return std::abs(measured.value_mm - true_mm) > measured.bound.total_mm();
}

// How often what was measured at a place is wrong.
struct Counts {
  int places = 0, diameters = 0, lengths = 0, bows = 0, offsets = 0;
  int widths = 0, refuted = 0;       // cameras that don't agree, of sound rods: the gauge fails for nothing
  int ranges = 0, wrong_ranges = 0;  // of single cameras
  int caught = 0;                    // a rod thicker by a fifth, gauged as the thinner one
  double worst_share = 0.0;          // of its bound, of a diameter's error

  void Add(const FreshCase& c, const RodMeasurement& rod) {
    ++places;
    worst_share = std::max(worst_share,
                           std::abs(rod.diameter.value_mm - c.diameter_mm) / rod.diameter.bound.total_mm());
    diameters += IsBeyond(rod.diameter, c.diameter_mm) ? 1 : 0;
    lengths += !c.has_hand && rod.length && IsBeyond(*rod.length, c.length_mm) ? 1 : 0;
    bows += rod.straightness && IsBeyond(*rod.straightness, 0.0) ? 1 : 0;
    widths += rod.widths_agree ? 0 : 1;
    bool is_refuted = false;
    for (const CameraOfGauge& camera : rod.cameras) {
      is_refuted = is_refuted || camera.sight == RodSight::kRefutes || camera.sight == RodSight::kAstray;
      offsets +=
          camera.sight == RodSight::kMeasured && camera.offset && IsBeyond(*camera.offset, 0.0) ? 1 : 0;
      if (!camera.diameter) continue;
      ++ranges;
      wrong_ranges += IsBeyond(*camera.diameter, c.diameter_mm) ? 1 : 0;
    }
    refuted += is_refuted ? 1 : 0;
  }
  void Print(const char* title) const {
    std::printf(
        "%-32s %d places: diameter beyond %d (at most %.2f of its bound), length %d, bow %d, offset %d; "
        "widths "
        "disagree %d, refuted %d; single cameras beyond %d of %d; thicker rod caught at %d\n",
        title, places, diameters, worst_share, lengths, bows, offsets, widths, refuted, wrong_ranges, ranges,
        caught);
  }
};

Counts CountsOf(const FreshCase& c) {
  RodStage stage(c.rig, c.silhouettes);
  const UndistortedPlanes planes = MakeUndistortedPlanes(c.rig);
  const auto gauged = [&](const std::vector<SyntheticObject>& objects) {
    return GaugeRod(c.rig, planes, stage.MasksOf(objects), {}, c.diameter_mm).rod;
  };
  Counts counts;
  const unsigned end = kFirstFreshDraw + static_cast<unsigned>(test_support::SoakScale());
  for (unsigned draw = kFirstFreshDraw; draw < end; ++draw) {
    for (Rod rod : testing::TwentySevenRods(c.rig, c.share, c.diameter_mm, c.length_mm, draw)) {
      std::vector<SyntheticObject> objects = {testing::RodObject(rod)};
      if (c.has_hand) objects.push_back(testing::HandAtTheEnd(rod));
      if (const auto found = gauged(objects)) counts.Add(c, *found);
      if (c.has_hand) continue;
      rod.diameter_mm *= 1.2;
      const auto thicker = gauged({testing::RodObject(rod)});
      counts.caught += thicker && IsBeyond(thicker->diameter, c.diameter_mm) ? 1 : 0;
    }
  }
  return counts;
}

void ExpectWithinBounds(const Counts& counts) {
  EXPECT_EQ(counts.places, 27 * test_support::SoakScale());
  EXPECT_EQ(counts.diameters, 0);
  EXPECT_EQ(counts.lengths, 0);
  EXPECT_EQ(counts.bows, 0);
  EXPECT_EQ(counts.offsets, 0);
}

TEST(GaugeRod, IsWithinItsBoundAtFreshPlacesInReadyMasks) {
  for (const FreshCase& c :
       {FreshCase{"paper rig, 10 mm, ready", PaperRig(), 10.0, 300.0, Silhouettes::kReady},
        FreshCase{"paper rig, 40 mm, ready", PaperRig(), 40.0, 300.0, Silhouettes::kReady},
        FreshCase{"four cameras, 10 mm, ready", FourCameraRig(), 10.0, 200.0, Silhouettes::kReady},
        FreshCase{"six in a ring, 10 mm, in a hand", testing::RingRig(6), 10.0, 260.0, Silhouettes::kReady,
                  true, 0.4},
        FreshCase{"five in a ring, 10 mm, in a hand", testing::RingRig(5), 10.0, 260.0, Silhouettes::kReady,
                  true, 0.4}}) {
    SCOPED_TRACE(c.title);
    const Counts counts = CountsOf(c);
    counts.Print(c.title);
    ExpectWithinBounds(counts);
    // Stray crossings of a hand, or a rod that points at a camera, at one place in a hundred.
    EXPECT_LE(counts.widths + counts.refuted, 1 + counts.places / 100);
    if (!c.has_hand) {
      EXPECT_GE(counts.caught, counts.places - 1 - counts.places / 100);
    }
  }
}

TEST(GaugeRod, IsWithinItsBoundAtFreshPlacesInSegmentedPictures) {
  for (const FreshCase& c :
       {FreshCase{"paper rig, 10 mm, segmented", PaperRig(), 10.0, 300.0, Silhouettes::kSegmented},
        FreshCase{"paper rig, 40 mm, segmented", PaperRig(), 40.0, 300.0, Silhouettes::kSegmented},
        FreshCase{"four cameras, 10 mm, segmented", FourCameraRig(), 10.0, 200.0, Silhouettes::kSegmented},
        FreshCase{"four cameras, 40 mm, segmented", FourCameraRig(), 40.0, 200.0, Silhouettes::kSegmented}}) {
    SCOPED_TRACE(c.title);
    const Counts counts = CountsOf(c);
    counts.Print(c.title);
    ExpectWithinBounds(counts);
    // A rod of 10 mm is so small in some of these pictures that its bound hides a fifth of it.
    if (c.diameter_mm > 10.0) {
      EXPECT_EQ(counts.caught, counts.places);
    }
  }
}

}  // namespace
}  // namespace elbowroom::recon
