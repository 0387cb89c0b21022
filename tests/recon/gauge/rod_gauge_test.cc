// What the gauge says of rods whose truth is known.
#include "recon/gauge/rod_gauge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "recon/synthetic/rig_presets.h"
#include "tests/recon/gauge/rod_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;
using testing::MasksOf;
using testing::Rod;
using testing::Silhouettes;

TEST(Experiment, Prints) {
  struct Case {
    const char* name;
    core::Rig rig;
    double share;
    double diameter, length;
    Silhouettes silhouettes;
  };
  const Case cases[] = {{"paper 10 ready", PaperRig(), 0.5, 10, 300, Silhouettes::kReady},
                        {"paper 40 ready", PaperRig(), 0.5, 40, 300, Silhouettes::kReady},
                        {"four 10 ready", FourCameraRig(), 0.6, 10, 200, Silhouettes::kReady},
                        {"paper 10 seg", PaperRig(), 0.5, 10, 300, Silhouettes::kSegmented},
                        {"paper 40 seg", PaperRig(), 0.5, 40, 300, Silhouettes::kSegmented},
                        {"four 10 seg", FourCameraRig(), 0.6, 10, 200, Silhouettes::kSegmented},
                        {"four 40 seg", FourCameraRig(), 0.6, 40, 200, Silhouettes::kSegmented}};
  for (const Case& c : cases) {
    const UndistortedPlanes planes = MakeUndistortedPlanes(c.rig);
    std::printf("== %s\n", c.name);
    for (const Rod& rod : testing::TwentySevenRods(c.rig, c.share, c.diameter, c.length)) {
      const auto masks = MasksOf(c.rig, {testing::RodObject(rod)}, c.silhouettes);
      const RodGaugeResult result = GaugeRod(c.rig, planes, masks, {}, c.diameter);
      if (!result.rod) {
        std::printf("none: %s\n", result.reason.c_str());
        continue;
      }
      const RodMeasurement& m = *result.rod;
      std::printf("d %7.3f +- %5.3f (%5.3f %5.3f) %c | L %7.2f +- %5.2f | str %5.2f +- %5.2f | %c%c |",
                  m.diameter.value_mm, m.diameter.bound.total_mm(), m.diameter.bound.silhouettes_mm,
                  m.diameter.bound.distance_mm,
                  std::abs(m.diameter.value_mm - c.diameter) <= m.diameter.bound.total_mm() ? ' ' : '!',
                  m.length ? m.length->value_mm : 0.0, m.length ? m.length->bound.total_mm() : 0.0,
                  m.straightness ? m.straightness->value_mm : -1.0,
                  m.straightness ? m.straightness->bound.total_mm() : -1.0, m.widths_agree ? ' ' : 'W',
                  m.CamerasAgree() ? ' ' : 'C');
      for (const CameraOfGauge& camera : m.cameras)
        std::printf(" %d %.2f+-%.2f ex %.2f o %.2f+-%.2f", static_cast<int>(camera.sight),
                    camera.diameter ? camera.diameter->value_mm : 0.0,
                    camera.diameter ? camera.diameter->bound.total_mm() : 0.0, camera.excess_px,
                    camera.offset ? camera.offset->value_mm : 0.0,
                    camera.offset ? camera.offset->bound.total_mm() : 0.0);
      std::printf("\n");
    }
  }
}

}  // namespace
}  // namespace elbowroom::recon
