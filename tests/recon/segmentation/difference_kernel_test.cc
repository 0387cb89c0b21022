#include "recon/segmentation/difference_kernel.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "core/error.h"
#include "recon/segmentation/boundary.h"
#include "recon/segmentation/coverage.h"
#include "recon/segmentation/mask_regions.h"
#include "tests/oracles/exposure_oracle.h"
#include "tests/recon/segmentation/boundary_oracle.h"

namespace elbowroom::recon {
namespace {

constexpr ShadeRule kRule{0.55F, 0.10F, 3.0F};

struct Case {
  cv::Mat image_bgr, mean_bgr, threshold_bgr;
};

// Rows that end anywhere within a word, and a picture that is a window of a wider one; where `busy`, most
// pixels differ and many are shade, else only a few, on a ground of which rows have levels in common.
Case RandomCase(int width, int height, bool busy, std::mt19937& random) {
  Case made{cv::Mat(height, width + 5, CV_8UC3), cv::Mat(height, width, CV_32FC3),
            cv::Mat(height, width, CV_32FC3)};
  made.image_bgr = made.image_bgr(cv::Rect(2, 0, width, height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double light =
          busy && random() % 2 == 0 ? 0.4 + static_cast<double>(random() % 700U) / 1000.0 : 1.0;
      const bool differs = busy ? random() % 3 == 0 : random() % 200 == 0;
      for (int c = 0; c < 3; ++c) {
        const float mean = static_cast<float>(busy ? random() % 25500U : 12000U + random() % 600U) / 100.0F;
        made.mean_bgr.at<cv::Vec3f>(y, x)[c] = mean;
        made.threshold_bgr.at<cv::Vec3f>(y, x)[c] =
            static_cast<float>((busy ? 0U : 1000U) + random() % 3000U) / 100.0F;
        made.image_bgr.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<std::uint8_t>(
            differs ? static_cast<double>(random() % 256U) : light * static_cast<double>(mean));
      }
    }
  }
  return made;
}

bool Differs(const Case& made, int y, int x) {
  for (int c = 0; c < 3; ++c) {
    const double mean = made.mean_bgr.at<cv::Vec3f>(y, x)[c];
    if (std::abs(made.image_bgr.at<cv::Vec3b>(y, x)[c] - mean) > made.threshold_bgr.at<cv::Vec3f>(y, x)[c])
      return true;
  }
  return false;
}

// The rule as its comment has it, in double; nothing where single precision may decide otherwise.
std::optional<bool> IsShade(const Case& made, int y, int x) {
  constexpr double kUnsure = 1e-4;  // relative; single precision keeps 1e-6 of the products' sum
  const cv::Vec3d i(made.image_bgr.at<cv::Vec3b>(y, x)), b(made.mean_bgr.at<cv::Vec3f>(y, x));
  const double g = i.dot(b) / b.dot(b), left = g * cv::norm(b);
  const double rest = std::sqrt(std::max(0.0, i.dot(i) - left * left));
  const double allowed =
      std::max(static_cast<double>(kRule.chroma) * left, static_cast<double>(kRule.noise_levels));
  const double darkest = kRule.darkest;
  if (std::abs(g - 1.0) < kUnsure || std::abs(g - darkest) < kUnsure) return std::nullopt;
  if (std::abs(rest * rest - allowed * allowed) < kUnsure * i.dot(i)) return std::nullopt;
  return g >= darkest && g < 1.0 && rest < allowed;
}

class EachTarget : public ::testing::Test {
 protected:
  void TearDown() override {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
  static std::vector<std::int64_t> Targets() {
    std::vector<std::int64_t> targets;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1)
      targets.push_back(left & -left);
    return targets;
  }
  static void Choose(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

TEST_F(EachTarget, GivesTheSameBits) {
  std::mt19937 random(3);
  const std::vector<std::int64_t> targets = Targets();
  for (const int width : {1, 5, 21, 63, 64, 65, 128, 191, 320, 333}) {
    for (const bool busy : {false, true}) {
      const Case made = RandomCase(width, 17, busy, random);
      const LevelRanges ranges(made.mean_bgr, made.threshold_bgr);
      std::optional<core::BitMask> first, first_without_shade;
      for (const std::int64_t target : targets) {
        SCOPED_TRACE(hwy::TargetName(target));
        Choose(target);
        const core::BitMask plain = DifferingPixels(ranges, made.image_bgr);
        const core::BitMask lit = DifferingPixels(ranges, made.image_bgr, kRule);
        if (!first) first = plain, first_without_shade = lit;
        EXPECT_EQ(plain, *first);
        EXPECT_EQ(lit, *first_without_shade);
      }
      for (int y = 0; y < 17; ++y) {
        for (int x = 0; x < width; ++x) {
          ASSERT_EQ(first->At(x, y), Differs(made, y, x)) << width << ": " << x << ' ' << y;
          if (const auto shade = IsShade(made, y, x)) {
            ASSERT_EQ(first_without_shade->At(x, y), first->At(x, y) && !*shade)
                << width << ": " << x << ' ' << y;
          }
        }
      }
      std::size_t counted = 0;
      for (int y = 0; y < 17; ++y)
        for (int x = 0; x < width; ++x) counted += first->At(x, y) ? 1 : 0;
      EXPECT_EQ(first->CountObjectPixels(), counted) << "padding is zero";
    }
  }
  RecordProperty("targets", static_cast<int>(targets.size()));
  EXPECT_GE(targets.size(), 2U) << "only one instruction set to compare";
}

// The rounded rule bit by bit, and the rule in real numbers for all levels but those within kBoundLevels of
// an end of their range: 1 / 128 of a level by rounding it (times the gain), 2^-14 of at most 512 levels by
// rounding the gain, and 1 / 32 each by rounding product and offset, with gains below 2.
TEST_F(EachTarget, FollowsAnExposureAsTheSlowOracle) {
  constexpr double kBoundLevels = 2.0 / 128 + 512.0 / 16384 + 2.0 / 32;
  std::mt19937 random(6);
  std::int64_t within_bound = 0, levels = 0;
  for (const int width : {1, 21, 64, 65, 191, 333}) {
    for (const bool busy : {false, true}) {
      for (int trial = 0; trial < 4; ++trial) {
        Case made = RandomCase(width, 17, busy, random);
        ExposureChange change;
        for (std::size_t c = 0; c < 3; ++c) {
          change.gain[c] = 0.5 + static_cast<double>(random() % 1500U) / 1000.0;
          change.offset_levels[c] = static_cast<double>(random() % 800U) / 10.0 - 40.0;
        }
        const FixedExposure exposure(change);
        ExposureChange fixed;
        for (std::size_t c = 0; c < 3; ++c)
          fixed.gain[c] = exposure.Gain(c), fixed.offset_levels[c] = exposure.OffsetLevels(c);
        if (!busy) {  // most levels are background after the change
          oracles::WithExposure(made.mean_bgr, fixed).convertTo(made.image_bgr, CV_8U);
          made.image_bgr.at<cv::Vec3b>(8, width / 2) = {0, 255, 0};
        }
        const FollowedRanges ranges(made.mean_bgr, made.threshold_bgr);
        const core::BitMask wanted =
            oracles::OutsidePixels(made.image_bgr, made.mean_bgr, made.threshold_bgr, exposure);
        std::optional<core::BitMask> first_lit;
        for (const std::int64_t target : Targets()) {
          SCOPED_TRACE(hwy::TargetName(target));
          Choose(target);
          ASSERT_EQ(DifferingPixels(ranges, exposure, made.image_bgr, nullptr), wanted) << width;
          const core::BitMask lit = DifferingPixels(ranges, exposure, made.image_bgr, &kRule);
          if (!first_lit) first_lit = lit;
          EXPECT_EQ(lit, *first_lit);
        }
        Case followed = made;
        followed.mean_bgr = oracles::WithExposure(made.mean_bgr, fixed);
        for (int y = 0; y < 17; ++y) {
          for (int x = 0; x < width; ++x) {
            bool surely = false, perhaps = false;
            for (int c = 0; c < 3; ++c) {
              const auto channel = static_cast<std::size_t>(c);
              const auto outside = [&](double by_levels) {
                return oracles::IsOutsideExactly(
                    made.image_bgr.at<cv::Vec3b>(y, x)[c], made.mean_bgr.at<cv::Vec3f>(y, x)[c],
                    made.threshold_bgr.at<cv::Vec3f>(y, x)[c], fixed.gain[channel],
                    fixed.offset_levels[channel], by_levels);
              };
              surely |= outside(kBoundLevels);
              perhaps |= outside(-kBoundLevels);
            }
            ++levels;
            if (surely != perhaps) {
              ++within_bound;
            } else {
              ASSERT_EQ(wanted.At(x, y), surely) << width << ": " << x << ' ' << y;
            }
            if (const auto shade = IsShade(followed, y, x)) {
              ASSERT_EQ(first_lit->At(x, y), wanted.At(x, y) && !*shade) << width << ": " << x << ' ' << y;
            }
          }
        }
      }
    }
  }
  EXPECT_LT(within_bound * 4, levels) << "too few levels are held to the rule in real numbers";
}

TEST(Exposure, AFollowedMeanIsWithinThreeEighthsOfALevel) {
  // Half a quarter before, times a gain of 2, and after; 2^-14 of 255 levels for the gain, 1 / 32 for the
  // offset.
  constexpr double kBoundLevels = 2.0 / 8 + 1.0 / 8 + 255.0 / 16384 + 1.0 / 32;
  std::mt19937 random(7);
  for (int trial = 0; trial < 2000; ++trial) {
    ExposureChange change;
    const double level = static_cast<double>(random() % 2551U) / 10.0;
    for (std::size_t c = 0; c < 3; ++c) {
      change.gain[c] = 0.5 + static_cast<double>(random() % 1500U) / 1000.0;
      change.offset_levels[c] = static_cast<double>(random() % 800U) / 10.0 - 40.0;
    }
    const cv::Mat packed = PackedMean(cv::Mat(1, 1, CV_32FC3, cv::Scalar::all(level)));
    const std::uint32_t followed =
        WithExposure(static_cast<std::uint32_t>(packed.at<std::int32_t>(0, 0)), FixedExposure(change));
    for (std::size_t c = 0; c < 3; ++c) {
      const double wanted = std::clamp(change.gain[c] * level + change.offset_levels[c], 0.0, 255.75);
      EXPECT_NEAR(((followed >> (10 * c)) & 1023U) / 4.0, wanted, kBoundLevels) << level;
    }
  }
}

// Noise of few pixels, thin lines and frames all over the picture, between the pixels that are looked at too:
// what is left of it without small regions is the same.
TEST_F(EachTarget, FindsAllLargeRegionsWithoutLookingAtEveryPixel) {
  std::mt19937 random(5);
  for (const int width : {63, 64, 200, 320, 333}) {
    for (int trial = 0; trial < 12; ++trial) {
      const int height = 40 + trial;
      const cv::Mat mean(height, width, CV_32FC3, cv::Scalar::all(100.0));
      const cv::Mat threshold(height, width, CV_32FC3, cv::Scalar::all(10.0));
      cv::Mat image(height, width, CV_8UC3, cv::Scalar::all(100.0));
      for (int n = 0; n < 8; ++n) {
        const bool is_line = random() % 2 == 0;
        const cv::Rect box(static_cast<int>(random() % static_cast<unsigned>(width)),
                           static_cast<int>(random() % static_cast<unsigned>(height)),
                           static_cast<int>(1 + random() % 150),
                           static_cast<int>(1 + random() % (is_line ? 3 : 20)));
        const cv::Scalar color = cv::Scalar::all(random() % 3 == 0 ? 80.0 : 130.0);  // shade, or light
        image(box & cv::Rect(0, 0, width, height)).setTo(color);
      }
      const LevelRanges ranges(mean, threshold);
      for (const int least_px : {50, 133, 200}) {
        core::BitMask all = DifferingPixels(ranges, image, kRule);
        RemoveSmallBlobs(all, least_px);
        for (const std::int64_t target : Targets()) {
          SCOPED_TRACE(hwy::TargetName(target));
          Choose(target);
          core::BitMask large = DifferingPixels(ranges, image, kRule, least_px);
          RemoveSmallBlobs(large, least_px);
          ASSERT_EQ(large, all) << width << ' ' << trial << ' ' << least_px;
          core::BitMask followed =
              DifferingPixels(FollowedRanges(mean, threshold), FixedExposure({}), image, &kRule, least_px);
          RemoveSmallBlobs(followed, least_px);
          ASSERT_EQ(followed, all) << width << ' ' << trial << ' ' << least_px;
        }
      }
    }
  }
}

// Cells of 64 x 4 pixels: of a row of one that is left out 44 pixels aren't looked at, its first row is.
TEST_F(EachTarget, TellsHowManyPixelsItDidNotLookAt) {
  const cv::Size size(330, 22);
  const LevelRanges ranges(cv::Mat(size, CV_32FC3, cv::Scalar::all(100.0)),
                           cv::Mat(size, CV_32FC3, cv::Scalar::all(10.0)));
  const FollowedRanges followed(cv::Mat(size, CV_32FC3, cv::Scalar::all(100.0)),
                                cv::Mat(size, CV_32FC3, cv::Scalar::all(10.0)));
  cv::Mat image(size, CV_8UC3, cv::Scalar::all(100.0));
  cv::Mat touched = image.clone();
  touched.at<cv::Vec3b>(8, 64) = {100, 150, 100};
  for (const std::int64_t target : Targets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    Choose(target);
    std::int64_t unseen_px = -1;
    EXPECT_EQ(DifferingPixels(ranges, image, 200, &unseen_px).CountObjectPixels(), 0U);
    EXPECT_EQ(unseen_px, 5 * 44 * (5 * 3 + 1));  // the last of six rows of cells has two rows of pixels
    EXPECT_EQ(DifferingPixels(ranges, touched, 200, &unseen_px).CountObjectPixels(), 1U);
    EXPECT_EQ(unseen_px, 5 * 44 * (5 * 3 + 1) - 9 * 44 * 3);
    EXPECT_EQ(DifferingPixels(ranges, touched, 100, &unseen_px).CountObjectPixels(), 1U);
    EXPECT_EQ(unseen_px, 0) << "regions of 100 pixels may hide between the pixels that are looked at";
    const FixedExposure as_it_is({});
    EXPECT_EQ(DifferingPixels(followed, as_it_is, image, nullptr, 200, &unseen_px).CountObjectPixels(), 0U);
    EXPECT_EQ(unseen_px, 5 * 44 * (5 * 3 + 1));
    EXPECT_EQ(DifferingPixels(followed, as_it_is, touched, nullptr, 200, &unseen_px).CountObjectPixels(), 1U);
    EXPECT_EQ(unseen_px, 5 * 44 * (5 * 3 + 1) - 9 * 44 * 3);
  }
}

// Labels of every kind: blocks with holes, so thin lines and pixels without an interior, and smooth discs.
// Both reach the picture's edge. Contrast is mostly high; where `busy`, every colour is random.
TEST_F(EachTarget, LocatesTheBoundaryOfTheSlowOracle) {
  std::mt19937 random(4);
  for (const int width : {1, 2, 5, 31, 64, 65, 128, 191, 700}) {
    for (const int height : {2, 5, 33}) {
      for (const bool busy : {false, true}) {
        Case made = RandomCase(width, height, busy, random);
        // A picture that isn't a window: AddressSanitizer sees bytes read past its end.
        if (!busy) made.image_bgr = made.image_bgr.clone();
        const cv::Mat mean = PackedMean(made.mean_bgr);
        core::BitMask detected(width, height);
        for (int y = 0; y < height; ++y) {
          for (int x = 0; x < width; ++x) {
            const bool is_block = (x / 9 + y / 7) % 2 == 0 && random() % 20 != 0;
            detected.Set(x, y, busy ? is_block : std::hypot(x % 40 - 18, y - 12) < 11.0);
            if (!busy && detected.At(x, y) && random() % 8 != 0)
              made.image_bgr.at<cv::Vec3b>(y, x) =
                  cv::Vec3b(30, 60, static_cast<std::uint8_t>(200 + random() % 20));
          }
        }
        const core::SoftMask wanted = LocateBoundarySlowly(detected, made.image_bgr, mean, 20.0);
        const FixedExposure exposure({{0.8, 1.1, 1.3}, {5.0, -12.0, 3.0}});
        cv::Mat followed = mean.clone();
        for (auto& packed : cv::Mat_<std::int32_t>(followed))
          packed = static_cast<std::int32_t>(WithExposure(static_cast<std::uint32_t>(packed), exposure));
        const core::SoftMask wanted_followed = LocateBoundarySlowly(detected, made.image_bgr, followed, 20.0);
        for (const std::int64_t target : Targets()) {
          SCOPED_TRACE(hwy::TargetName(target));
          Choose(target);
          const core::SoftMask located = LocateBoundary(detected, made.image_bgr, mean, 20.0);
          located.Validate();
          ASSERT_EQ(located, wanted) << width << " x " << height;
          ASSERT_EQ(LocateBoundary(detected, made.image_bgr, mean, 20.0, &exposure), wanted_followed);
        }
      }
    }
  }
}

TEST(DifferenceKernel, RefusesAPictureOfAnotherSize) {
  const LevelRanges ranges(cv::Mat(4, 4, CV_32FC3, cv::Scalar::all(9)),
                           cv::Mat(4, 4, CV_32FC3, cv::Scalar::all(1)));
  EXPECT_THROW((void)DifferingPixels(ranges, cv::Mat(4, 5, CV_8UC3)), core::PreconditionError);
  EXPECT_THROW((void)DifferingPixels(ranges, cv::Mat(4, 4, CV_8U)), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
