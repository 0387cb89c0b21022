#include "app/control/self_test.h"

#include <gtest/gtest.h>

namespace elbowroom::control {
namespace {

TEST(SelfTest, GraphicsAndProcessorAgree) {
  const SelfTestReport report = RunSelfTest();
  EXPECT_FALSE(report.driver.empty());
  ASSERT_EQ(report.lines.size(), 4U);
  for (const SelfTestLine& line : report.lines) {
    EXPECT_GT(line.hit_pixels, 1000) << line.what;
    EXPECT_LT(line.differing_pixels, line.hit_pixels / 50) << line.what;  // the band is narrow
    EXPECT_EQ(line.unexplained_pixels, 0) << line.what;
  }
  EXPECT_TRUE(report.Passed());
}

TEST(SelfTest, OneUnexplainedPixelFailsIt) {
  SelfTestReport report{"driver", {{"a", 100, 3, 0}, {"b", 100, 3, 0}}};
  EXPECT_TRUE(report.Passed());
  report.lines[1].unexplained_pixels = 1;
  EXPECT_FALSE(report.Passed());
  report.lines[1] = {"b", 0, 0, 0};
  EXPECT_FALSE(report.Passed());  // a hand that nobody sees tests nothing
}

}  // namespace
}  // namespace elbowroom::control
