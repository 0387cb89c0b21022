#include "app/control/self_test.h"

#include <gtest/gtest.h>

#include "recon/exact_view/view_band.h"

namespace elbowroom::control {
namespace {

TEST(SelfTest, GraphicsAndProcessorAgree) {
  const SelfTestReport report = RunSelfTest();
  EXPECT_FALSE(report.driver.empty());
  ASSERT_EQ(report.lines.size(), 3U + 8U + 1U);  // sweeps, exact views, collisions
  for (const SelfTestLine& line : report.lines) {
    EXPECT_GT(line.hit_pixels, 1000) << line.what;
    EXPECT_LT(line.differing_pixels, line.hit_pixels / 50) << line.what;  // the band is narrow
    EXPECT_EQ(line.unexplained_pixels, 0) << line.what;
  }
  EXPECT_TRUE(report.Passed());
  for (std::size_t i = 3; i < 7; ++i)  // the policies make different hulls of what one camera doesn't see
    EXPECT_GT(report.lines[i + 4].hit_pixels, report.lines[i].hit_pixels) << report.lines[i].what;
}

TEST(SelfTest, OneUnexplainedPixelFailsIt) {
  SelfTestReport report{"driver", {{"a", 100, 3, 0}, {"b", 100, 3, 0}}};
  EXPECT_TRUE(report.Passed());
  report.lines[1].unexplained_pixels = 1;
  EXPECT_FALSE(report.Passed());
  report.lines[1] = {"b", 0, 0, 0};
  EXPECT_FALSE(report.Passed());  // a hand that nobody sees tests nothing
}

// What the exact views' lines are if every 500th surface point is off by `factor`, or gone where it is 0.
SelfTestReport WithPlanted(float factor) {
  return {"driver", TestExactViews([factor](const recon::VisualHull& hull, const recon::ViewRays& rays,
                                            const recon::HullView&) {
            recon::HullView view = recon::ViewHull(hull, rays);
            int hits = 0;
            for (float& depth_mm : view.depth_mm)
              if (depth_mm != 0.0F && ++hits % 500 == 0) depth_mm *= factor;
            return view;
          })};
}

TEST(SelfTest, AnExactViewWithADifferenceFailsIt) {
  EXPECT_TRUE(WithPlanted(1.0F).Passed());
  for (const float factor : {0.0F, 1.0F + 4.0F * static_cast<float>(recon::kViewTolerance)}) {
    const SelfTestReport report = WithPlanted(factor);
    EXPECT_FALSE(report.Passed());
    for (const SelfTestLine& line : report.lines) {
      EXPECT_GT(line.unexplained_pixels, 0) << line.what;
      EXPECT_GE(line.differing_pixels, line.hit_pixels / 500) << line.what;  // some within the band
    }
  }
}

}  // namespace
}  // namespace elbowroom::control
