// The bands' colours stay apart for those who can't see red, green or blue.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "app/control/palette/part_colors.h"
#include "app/control/palette/scale_color.h"

namespace elbowroom::control {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double Linear(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

// What a dichromat sees, in linear RGB. Source: Machado, Oliveira and Fernandes 2009, severity 1.
std::array<Matrix3d, 4> Eyes() {
  std::array<Matrix3d, 4> eyes{Matrix3d::Identity()};
  eyes[1] << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
  eyes[2] << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
  eyes[3] << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900;
  return eyes;
}

Vector3d LabOf(const Vector3d& linear) {
  Matrix3d xyz_from_rgb;
  xyz_from_rgb << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Vector3d xyz =
      (xyz_from_rgb * linear.cwiseMax(0.0).cwiseMin(1.0)).cwiseQuotient(Vector3d(0.9505, 1.0, 1.089));
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  return {116.0 * f(xyz.y()) - 16.0, 500.0 * (f(xyz.x()) - f(xyz.y())), 200.0 * (f(xyz.y()) - f(xyz.z()))};
}

TEST(Palette, BandsStayApartForEveryEye) {
  constexpr double kFarApart = 20.0;  // CIE76; 2.3 is just noticeable
  constexpr std::array kVerdicts = {core::Verdict::kContact, core::Verdict::kNear, core::Verdict::kClear,
                                    core::Verdict::kUndecided};
  double least = 1e9;
  for (const Matrix3d& eye : Eyes()) {
    for (std::size_t i = 0; i < kVerdicts.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto seen = [&](core::Verdict verdict) {
          return LabOf(eye * BandColor(verdict).cast<double>().unaryExpr(&Linear));
        };
        least = std::min(least, (seen(kVerdicts[i]) - seen(kVerdicts[j])).norm());
      }
    }
  }
  EXPECT_GE(least, kFarApart);
  RecordProperty("least_cie76", std::to_string(least));
  std::printf("least distance of two bands: %.1f (CIE76)\n", least);
}

// A scale is read by its lightness, so that must fall all the way, whoever looks.
TEST(Palette, TheScaleIsDarkerAtEachStepForEveryEye) {
  constexpr int kSteps = 12;
  constexpr double kVisible = 2.3;  // just noticeable
  double least = 1e9;
  for (const Matrix3d& eye : Eyes()) {
    double last = 1e9;
    for (int i = 0; i < kSteps; ++i) {
      const double lightness =
          LabOf(eye * ScaleColor((i + 0.5) / kSteps).cast<double>().unaryExpr(&Linear))[0];
      if (i > 0) least = std::min(least, last - lightness);
      last = lightness;
    }
  }
  EXPECT_GE(least, kVisible);
  std::printf("least step of lightness: %.1f of 100\n", least);
}

}  // namespace
}  // namespace elbowroom::control
