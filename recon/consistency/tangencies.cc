#include "recon/consistency/tangencies.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/units.h"

namespace elbowroom::recon {
namespace {

Tangency CompareBoth(std::size_t pair, TangentSide side, const Tangent& in_a, const Tangent& in_b) {
  Tangency tangency{pair, side, in_a, in_b, 0.0, 0.0};
  const double rad_per_px = std::hypot(1.0 / in_a.px_per_rad, 1.0 / in_b.px_per_rad);
  tangency.residual_px = (in_a.angle_rad - in_b.angle_rad) / rad_per_px;
  tangency.sigma_px = std::hypot(in_a.sigma_rad(), in_b.sigma_rad()) / rad_per_px;
  return tangency;
}

// Where two sights are nearest to each other, in the middle between them. Nothing: they are parallel, or that
// is behind a camera.
std::optional<Eigen::Vector3d> MeetingPoint(const Eigen::Vector3d& from_a, const Eigen::Vector3d& sight_a,
                                            const Eigen::Vector3d& from_b, const Eigen::Vector3d& sight_b) {
  constexpr double kLeastSine2 = 1e-6;
  const Eigen::Vector3d between = from_b - from_a;
  const double cosine = sight_a.dot(sight_b), sine2 = 1.0 - cosine * cosine;
  if (sine2 < kLeastSine2) return std::nullopt;
  const double along_a = (between.dot(sight_a) - cosine * between.dot(sight_b)) / sine2;
  const double along_b = (cosine * between.dot(sight_a) - between.dot(sight_b)) / sine2;
  if (along_a <= 0.0 || along_b <= 0.0) return std::nullopt;
  return 0.5 * (from_a + along_a * sight_a + from_b + along_b * sight_b);
}

// Whether a camera sees background around the place where the point must be.
bool IsRefuted(const core::CameraModel& camera, const core::BitMask& mask,
               const Eigen::Vector3d& x_in_world) {
  constexpr int kAroundPx = 4;  // a camera that was knocked is off by less, or every pair shows it
  const std::optional<Eigen::Vector2d> pixel = camera.Project(x_in_world);
  if (!pixel || !IsWithin(camera, *pixel, kAroundPx + 1.0)) return false;
  const auto x = static_cast<int>(std::lround(pixel->x())), y = static_cast<int>(std::lround(pixel->y()));
  for (int v = y - kAroundPx; v <= y + kAroundPx; ++v)
    for (int u = x - kAroundPx; u <= x + kAroundPx; ++u)
      if (mask.At(u, v)) return false;
  return true;
}

// Whether the tangents of cut silhouettes touch one point that is certain enough.
bool TouchOnePoint(const EpipolarPairs& pairs, const EpipolarPair& pair, const Tangent& in_a,
                   const Tangent& in_b, std::span<const core::SoftMask> masks) {
  if (!in_a.is_seen_by_other || !in_b.is_seen_by_other) return false;
  const core::CameraModel &a = pairs.plane(pair.a).camera(), &b = pairs.plane(pair.b).camera();
  const auto point =
      MeetingPoint(a.center_in_world(), in_a.sight_in_world, b.center_in_world(), in_b.sight_in_world);
  if (!point || !pairs.workspace_mm().contains(*point)) return false;
  for (core::CameraIndex c = 0; c < pairs.camera_count(); ++c)
    if (c != pair.a && c != pair.b && IsRefuted(pairs.plane(c).camera(), masks[c].mask, *point)) return false;
  return true;
}

constexpr double kFarOffPx = 3.0;  // of a residual that may be a wrong comparison
constexpr double kAgreesPx = 1.0;  // of one that may not

bool IsFarOff(const Tangency& tangency) { return std::abs(tangency.residual_px) > kFarOffPx; }

// Of a pair's epipolar plane: the shift of either camera's picture along it shows in the residual.
Eigen::Vector3d PlaneNormal(const EpipolarPairs& pairs, const Tangency& tangency) {
  const EpipolarPair& pair = pairs.pairs()[tangency.pair];
  const Eigen::Vector3d baseline =
      pairs.plane(pair.b).camera().center_in_world() - pairs.plane(pair.a).camera().center_in_world();
  return baseline.cross(tangency.in_a.sight_in_world).normalized();
}

// Whether two other pairs of the camera agree, of planes that stand at 40 degrees or more to each other: then
// its picture can't be shifted by much in any direction.
bool AgreesElsewhere(const EpipolarPairs& pairs, std::span<const Tangency> found, std::size_t pair,
                     core::CameraIndex camera) {
  const double most_alike = std::cos(core::RadiansFromDegrees(40.0));
  std::vector<Eigen::Vector3d> normals;
  for (const Tangency& other : found) {
    const EpipolarPair& of = pairs.pairs()[other.pair];
    if (other.pair == pair || (of.a != camera && of.b != camera)) continue;
    if (std::abs(other.residual_px) > kAgreesPx) continue;
    const Eigen::Vector3d normal = PlaneNormal(pairs, other);
    for (const Eigen::Vector3d& before : normals)
      if (std::abs(before.dot(normal)) <= most_alike) return true;
    normals.push_back(normal);
  }
  return false;
}

// Leaves out comparisons that are far off though both cameras stand as they should: a camera that was knocked
// is off in its other pairs, too. So they are of two points.
void LeaveOutContradicted(const EpipolarPairs& pairs, FrameTangencies& frame) {
  const std::vector<Tangency> all = frame.found;
  const auto left_out = std::erase_if(frame.found, [&](const Tangency& tangency) {
    const EpipolarPair& pair = pairs.pairs()[tangency.pair];
    return IsFarOff(tangency) && AgreesElsewhere(pairs, all, tangency.pair, pair.a) &&
           AgreesElsewhere(pairs, all, tangency.pair, pair.b);
  });
  frame.skipped[static_cast<std::size_t>(TangencySkip::kContradicted)] += left_out;
}

}  // namespace

std::size_t FrameTangencies::SkippedAll() const {
  return std::accumulate(skipped.begin(), skipped.end(), std::size_t{0});
}

FrameTangencies CompareTangents(const EpipolarPairs& pairs, std::span<const CameraTangents> tangents,
                                std::span<const core::SoftMask> masks) {
  core::Require(tangents.size() == pairs.camera_count() && masks.size() == pairs.camera_count(),
                "there are tangents and a silhouette for each camera");
  FrameTangencies frame;
  frame.found.reserve(kTangentSides * pairs.pairs().size());
  const auto skip = [&frame](TangencySkip why) { ++frame.skipped[static_cast<std::size_t>(why)]; };
  for (std::size_t i = 0; i < pairs.pairs().size(); ++i) {
    const EpipolarPair& pair = pairs.pairs()[i];
    const bool both_whole = tangents[pair.a].is_whole && tangents[pair.b].is_whole;
    for (std::size_t side = 0; side < kTangentSides; ++side) {
      const TangentOrSkip& in_a = tangents[pair.a].of_other[pair.b][side];
      const TangentOrSkip& in_b = tangents[pair.b].of_other[pair.a][side];
      const auto* const a = std::get_if<Tangent>(&in_a);
      const auto* const b = std::get_if<Tangent>(&in_b);
      if (a == nullptr || b == nullptr) {
        skip(std::get<TangencySkip>(a == nullptr ? in_a : in_b));
      } else if (!both_whole && !TouchOnePoint(pairs, pair, *a, *b, masks)) {
        skip(TangencySkip::kMaybeHidden);
      } else {
        frame.found.push_back(CompareBoth(i, static_cast<TangentSide>(side), *a, *b));
      }
    }
  }
  if (std::ranges::any_of(frame.found, IsFarOff)) LeaveOutContradicted(pairs, frame);
  return frame;
}

FrameTangencies FindTangencies(const EpipolarPairs& pairs, std::span<const core::SoftMask> masks,
                               const TangentOptions& options) {
  core::Require(masks.size() == pairs.camera_count(), "there is one silhouette a camera");
  std::vector<CameraTangents> tangents;
  tangents.reserve(masks.size());
  for (core::CameraIndex i = 0; i < masks.size(); ++i)
    tangents.push_back(FindTangents(pairs, i, masks[i], options));
  return CompareTangents(pairs, tangents, masks);
}

}  // namespace elbowroom::recon
