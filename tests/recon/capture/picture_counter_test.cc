#include "recon/capture/picture_counter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace elbowroom::recon {
namespace {

using core::LossReason;
using core::PictureLoss;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

CaptureClock::time_point At(double s) {
  return CaptureClock::time_point(std::chrono::duration_cast<CaptureClock::duration>(
      std::chrono::hours(1) + std::chrono::duration<double>(s)));
}

class PictureCounting : public ::testing::Test {
 protected:
  std::vector<PictureLoss> losses_;
  PictureCounter counter_{[this](PictureLoss loss) { losses_.push_back(loss); }};
};

TEST_F(PictureCounting, CountsFromZero) {
  EXPECT_EQ(counter_.Count(65'401, At(0.0)), 0U);
  EXPECT_EQ(counter_.Count(65'402, At(0.033)), 1U);
  EXPECT_THAT(losses_, IsEmpty());
}

TEST_F(PictureCounting, AGapInTheCamerasCountIsALoss) {
  (void)counter_.Count(5, At(0.0));
  EXPECT_EQ(counter_.Count(8, At(0.1)), 3U);
  EXPECT_THAT(losses_, ElementsAre(PictureLoss{0, 1, 2, LossReason::kNotSent}));
}

TEST_F(PictureCounting, APictureThatCantBeUsedKeepsItsNumber) {
  (void)counter_.Count(5, At(0.0));
  counter_.CountLost(7, At(0.066), LossReason::kIncomplete);
  EXPECT_EQ(counter_.Count(8, At(0.1)), 3U);
  EXPECT_THAT(losses_, ElementsAre(PictureLoss{0, 1, 1, LossReason::kNotSent},
                                   PictureLoss{0, 2, 2, LossReason::kIncomplete}));
}

TEST_F(PictureCounting, AnInterruptionLosesWhatTheCameraWouldHaveTaken) {
  counter_.SetRate(10.0);
  (void)counter_.Count(5, At(0.0));
  (void)counter_.Count(6, At(0.1));
  counter_.Interrupt();
  EXPECT_EQ(counter_.Count(1, At(1.12)), 11U);
  EXPECT_THAT(losses_, ElementsAre(PictureLoss{0, 2, 10, LossReason::kCameraGone}));
}

TEST_F(PictureCounting, AShortInterruptionLosesNothing) {
  counter_.SetRate(10.0);
  (void)counter_.Count(5, At(0.0));
  counter_.Interrupt();
  EXPECT_EQ(counter_.Count(1, At(0.12)), 1U);
  EXPECT_THAT(losses_, IsEmpty());
}

TEST_F(PictureCounting, ThePeriodFollowsTheStamps) {
  counter_.SetRate(30.0);
  for (int i = 0; i < 500; ++i) (void)counter_.Count(static_cast<std::uint64_t>(i), At(0.04 * i));
  constexpr double kMostErrorS = 1e-5;
  EXPECT_NEAR(counter_.period_s(), 0.04, kMostErrorS);
}

}  // namespace
}  // namespace elbowroom::recon
