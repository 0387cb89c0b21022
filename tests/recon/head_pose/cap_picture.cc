#include "tests/recon/head_pose/cap_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/units.h"
#include "recon/boards/marker_dictionary.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::recon::testing {
namespace {

using core::RigidTransform;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kQuietShare = 0.16;                            // of the side, light ground around the marker
constexpr double kBehind = 90.0, kSkin = 120.0, kHand = 150.0;  // grey levels

struct Facet {
  RigidTransform marker_from_cam;
  double half_mm = 0.0;
  std::vector<std::vector<bool>> pattern;
};

struct PlacedBall {
  Vector3d center_in_cam;
  double radius_mm = 0.0;
  double level = 0.0;
};

struct CapInView {
  std::vector<Facet> facets;
  std::vector<PlacedBall> balls;
};

// The distance along a ray from the origin; nothing on a miss.
std::optional<double> HitBall(const PlacedBall& ball, const Vector3d& ray) {
  const double along = ray.dot(ball.center_in_cam) / ray.squaredNorm();
  const double gap2 = ball.radius_mm * ball.radius_mm - (along * ray - ball.center_in_cam).squaredNorm();
  if (gap2 < 0.0) return std::nullopt;
  return along - std::sqrt(gap2 / ray.squaredNorm());
}

double LevelOnFacet(const Facet& facet, const Vector2d& x_in_marker, bool is_front,
                    const CapPictureOptions& options) {
  if (!is_front) return kBehind;
  const auto across = static_cast<double>(facet.pattern.size());
  const double column = (x_in_marker.x() / facet.half_mm + 1.0) * 0.5 * across;
  const double row = (1.0 - x_in_marker.y() / facet.half_mm) * 0.5 * across;
  if (column < 0.0 || row < 0.0 || column >= across || row >= across) return options.light;
  return facet.pattern[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] ? options.light
                                                                                        : options.dark;
}

// What a ray of the camera meets first; nothing: the scene.
std::optional<double> LevelAlong(const CapInView& view, const Vector3d& ray,
                                 const CapPictureOptions& options) {
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<double> level;
  for (const Facet& facet : view.facets) {
    const Vector3d eye = facet.marker_from_cam.translation_mm;
    const Vector3d direction = facet.marker_from_cam.rotation * ray;
    const double depth = -eye.z() / direction.z();
    if (!(depth > 0.0 && depth < nearest)) continue;
    const Vector2d x = (eye + depth * direction).head<2>();
    if (x.cwiseAbs().maxCoeff() > facet.half_mm * (1.0 + 2.0 * kQuietShare)) continue;
    nearest = depth;
    level = LevelOnFacet(facet, x, eye.z() > 0.0, options);
  }
  for (const PlacedBall& ball : view.balls) {
    const auto depth = HitBall(ball, ray);
    if (!depth || !(*depth > 0.0 && *depth < nearest)) continue;
    nearest = *depth;
    level = ball.level;
  }
  return level;
}

CapInView ViewOf(const Cap& cap, const RigidTransform& world_from_head, const core::CameraModel& camera,
                 const CapPictureOptions& options) {
  CapInView view;
  const MarkerDictionary dictionary(cap.dictionary);
  const RigidTransform cam_from_cap = camera.cam_from_world() * world_from_head * cap.cap_from_head.Inverse();
  for (const CapMarker& marker : cap.markers)
    view.facets.push_back({(cam_from_cap * marker.cap_from_marker).Inverse(), 0.5 * marker.side_mm,
                           dictionary.PatternOf(marker.id)});
  view.balls.push_back({cam_from_cap * Vector3d(0.0, 0.0, -100.0), 95.0, kSkin});
  for (const Ball& ball : options.before)
    view.balls.push_back({camera.cam_from_world() * ball.center_in_world, ball.radius_mm, kHand});
  return view;
}

// The pixels around the cap, the head and what is before them.
cv::Rect BoxOf(const CapInView& view, const core::CameraModel& camera) {
  constexpr double kMarginPx = 6.0;
  const cv::Rect picture(0, 0, camera.width_px(), camera.height_px());
  Eigen::AlignedBox2d box;
  const auto add = [&](const Vector3d& center_in_cam, double radius_mm) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d offset((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                            (corner & 4) != 0 ? 1.0 : -1.0);
      if (const auto pixel = camera.ProjectInCam(center_in_cam + radius_mm * offset)) box.extend(*pixel);
    }
  };
  for (const PlacedBall& ball : view.balls) add(ball.center_in_cam, ball.radius_mm);
  for (const Facet& facet : view.facets)
    add(facet.marker_from_cam.Inverse().translation_mm, 2.0 * facet.half_mm);
  if (box.isEmpty()) return {};
  const cv::Rect around(cv::Point(cvFloor(std::clamp(box.min().x() - kMarginPx, -1e4, 1e4)),
                                  cvFloor(std::clamp(box.min().y() - kMarginPx, -1e4, 1e4))),
                        cv::Point(cvCeil(std::clamp(box.max().x() + kMarginPx, -1e4, 1e4)),
                                  cvCeil(std::clamp(box.max().y() + kMarginPx, -1e4, 1e4))));
  return around & picture;
}

void DrawRow(const CapInView& view, const core::CameraModel& camera, int y, const cv::Rect& box,
             const CapPictureOptions& options, cv::Mat* picture) {
  constexpr int kPlaces = 16;
  std::optional<Vector2d> corner = camera.NormalisedFromPixel(Vector2d(box.x - 0.5, y - 0.5));
  for (int x = box.x; x < box.x + box.width && corner; ++x) {
    const auto right = camera.NormalisedFromPixel(Vector2d(x + 0.5, y - 0.5), *corner);
    const auto below = camera.NormalisedFromPixel(Vector2d(x - 0.5, y + 0.5), *corner);
    if (!right || !below) return;
    double sum = 0.0;
    auto& level = picture->at<float>(y, x);
    for (int i = 0; i < kPlaces; ++i) {
      // Roberts' R2 sequence and its image in the pixel's middle: the mean place is the middle, or the whole
      // picture would be shifted.
      const int k = i / 2;
      double a = 0.5 + 0.7548776662466927 * (k + 0.5), b = 0.5 + 0.5698402909980532 * (k + 0.5);
      a -= std::floor(a);
      b -= std::floor(b);
      if (i % 2 == 1) {
        a = 1.0 - a;
        b = 1.0 - b;
      }
      const Vector2d point = *corner + a * (*right - *corner) + b * (*below - *corner);
      sum += LevelAlong(view, point.homogeneous(), options).value_or(static_cast<double>(level));
    }
    level = static_cast<float>(sum / kPlaces);
    corner = right;
  }
}

}  // namespace

std::vector<cv::Mat> EmptyScenes(const core::Rig& rig) {
  SyntheticRigOptions options;
  options.noise_sigma_levels = 0.0;
  options.flicker_share = 0.0;
  SyntheticRig source(
      rig, [](double) { return std::vector<SyntheticObject>(); }, options);
  std::vector<cv::Mat> scenes;
  const FrameSet frame = source.Read(0);
  for (const CameraFrame& camera : frame.cameras) {
    cv::Mat grey;
    cv::cvtColor(camera.image_bgr, grey, cv::COLOR_BGR2GRAY);
    scenes.push_back(grey);
  }
  return scenes;
}

cv::Mat PictureOfCap(const Cap& cap, const RigidTransform& world_from_head, const core::CameraModel& camera,
                     const cv::Mat& scene, const CapPictureOptions& options, std::mt19937* random) {
  const CapInView view = ViewOf(cap, world_from_head, camera, options);
  cv::Mat picture;
  scene.convertTo(picture, CV_32F);
  const cv::Rect box = BoxOf(view, camera);
  for (int y = box.y; y < box.y + box.height; ++y) DrawRow(view, camera, y, box, options, &picture);
  cv::GaussianBlur(picture, picture, {}, options.blur_px);
  cv::Mat noise(picture.size(), CV_32F);
  cv::RNG rng((*random)());
  rng.fill(noise, cv::RNG::NORMAL, 0.0, options.noise_levels);
  picture += noise;
  cv::Mat levels;
  picture.convertTo(levels, CV_8U);
  return levels;
}

HeadError ErrorOf(const RigidTransform& a, const RigidTransform& b) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(a.rotation.transpose() * b.rotation));
  return {(a.translation_mm - b.translation_mm).norm(), core::DegreesFromRadians(std::abs(turn.angle()))};
}

RigidTransform RandomHead(std::mt19937* random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(*random);
  };
  const Vector3d eyes(between(-140.0, 260.0), between(-200.0, 200.0), between(180.0, 380.0));
  // Head axes in a world where the head looks along y: x right, y down, z forward.
  Eigen::Matrix3d level;
  level << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0;
  const auto turn = [](double angle_deg, const Vector3d& axis) {
    return Eigen::AngleAxisd(core::RadiansFromDegrees(angle_deg), axis).toRotationMatrix();
  };
  return {turn(between(-180.0, 180.0), Vector3d::UnitZ()) * level *
              turn(between(-50.0, 20.0), Vector3d::UnitX()) * turn(between(-25.0, 25.0), Vector3d::UnitZ()),
          eyes};
}

}  // namespace elbowroom::recon::testing
