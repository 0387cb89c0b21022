#include "app/control/overlay/part_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "app/control/overlay/projected_edge.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A face as bright as this is seen edge on, and lit from below.
constexpr double kDarkest = 0.35;

// A triangle before a camera. A ray d = (u, v, 1) meets it where d lies within the three planes through the
// camera's centre and a side: `sides[i] . d` >= 0, which also holds behind the camera if its `volume` has the
// other sign. Its depth there is volume / (normal . d).
struct SeenTriangle {
  std::array<Vector3d, 3> sides;
  Vector3d normal;
  double volume = 0.0;

  SeenTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c)
      : sides{b.cross(c), c.cross(a), a.cross(b)}, volume(a.dot(sides[0])) {
    if (volume < 0.0) {  // seen from its inner side
      for (Vector3d& side : sides) side = -side;
      volume = -volume;
    }
    normal = sides[0] + sides[1] + sides[2];
  }

  // Each of the three is linear in (u, v): over a box its largest value is that of the centre and what the
  // box reaches towards it.
  [[nodiscard]] bool MayCover(const Eigen::AlignedBox2d& box) const {
    const Vector2d center = box.center(), half = 0.5 * box.sizes();
    return std::ranges::all_of(sides, [&](const Vector3d& side) {
      return side.dot(center.homogeneous()) + side.head<2>().cwiseAbs().dot(half) >= 0.0;
    });
  }

  // 0: the ray doesn't meet it.
  [[nodiscard]] double DepthAlong(const Vector3d& ray) const {
    for (const Vector3d& side : sides)
      if (!(side.dot(ray) >= 0.0)) return 0.0;  // also without a ray: NaN
    const double slope = normal.dot(ray);
    return slope > 0.0 ? volume / slope : 0.0;
  }
};

// Lit from the camera, and from above.
std::uint8_t ShadeOf(const Vector3d& normal_in_cam, const Vector3d& up_in_cam, const Vector3d& to_face) {
  Vector3d n = normal_in_cam.normalized();
  if (n.dot(to_face) > 0.0) n = -n;
  const double facing = -n.dot(to_face.normalized()), from_above = 0.5 + 0.5 * n.dot(up_in_cam);
  return static_cast<std::uint8_t>(
      std::lround(255.0 * (kDarkest + (1.0 - kDarkest) * (0.45 * facing + 0.55 * from_above))));
}

// As large as the picture; what is kept of it is cut to the part.
class Canvas {
 public:
  explicit Canvas(const ViewPixels& view) : view_(view) {
    whole_.box = {0, 0, view.rays().width_px(), view.rays().height_px()};
    const auto pixels =
        static_cast<std::size_t>(whole_.box.right) * static_cast<std::size_t>(whole_.box.bottom);
    whole_.depth_mm.resize(pixels);
    whole_.shade.resize(pixels);
  }

  void Draw(const SeenTriangle& triangle, std::uint8_t shade, const recon::PixelBox& square) {
    for (int y = square.y; y < square.bottom; ++y) {
      for (int x = square.x; x < square.right; ++x) {
        const double depth_mm = triangle.DepthAlong(view_.rays().At(x, y).homogeneous());
        if (depth_mm < kOverlayNearMm) continue;
        const std::size_t at = whole_.At(x, y);
        if (whole_.depth_mm[at] > 0.0F && whole_.depth_mm[at] <= static_cast<float>(depth_mm)) continue;
        whole_.depth_mm[at] = static_cast<float>(depth_mm);
        whole_.shade[at] = shade;
        drawn_.extend(Eigen::Vector2i(x, y));
      }
    }
  }

  [[nodiscard]] PartFaces Cut() const {
    PartFaces cut;
    if (drawn_.isEmpty()) return cut;
    cut.box = {drawn_.min().x(), drawn_.min().y(), drawn_.max().x() + 1, drawn_.max().y() + 1};
    for (int y = cut.box.y; y < cut.box.bottom; ++y) {
      const auto first = static_cast<std::ptrdiff_t>(whole_.At(cut.box.x, y));
      const auto count = static_cast<std::ptrdiff_t>(cut.box.right - cut.box.x);
      cut.depth_mm.insert(cut.depth_mm.end(), whole_.depth_mm.begin() + first,
                          whole_.depth_mm.begin() + first + count);
      cut.shade.insert(cut.shade.end(), whole_.shade.begin() + first, whole_.shade.begin() + first + count);
    }
    return cut;
  }

 private:
  const ViewPixels& view_;
  PartFaces whole_;
  Eigen::AlignedBox2i drawn_;
};

}  // namespace

PartFaces DrawFaces(const ViewPixels& view, const core::TriangleMesh& mesh,
                    const core::RigidTransform& cam_from_part) {
  std::vector<Vector3d> corners_in_cam;
  corners_in_cam.reserve(mesh.vertices_mm.size());
  for (const Vector3d& corner : mesh.vertices_mm) corners_in_cam.push_back(cam_from_part * corner);
  const Vector3d up_in_cam = view.camera().cam_from_world().rotation.col(2);
  Canvas canvas(view);
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector3d &a = corners_in_cam[static_cast<std::size_t>(i)],
                   &b = corners_in_cam[static_cast<std::size_t>(j)],
                   &c = corners_in_cam[static_cast<std::size_t>(k)];
    if (std::max({a.z(), b.z(), c.z()}) < kOverlayNearMm) continue;
    const SeenTriangle triangle(a, b, c);
    if (triangle.volume == 0.0) continue;  // seen edge on
    const std::uint8_t shade = ShadeOf(triangle.normal, up_in_cam, (a + b + c) / 3.0);
    view.VisitLeaves([&](const Eigen::AlignedBox2d& box) { return triangle.MayCover(box); },
                     [&](const recon::PixelBox& square) { canvas.Draw(triangle, shade, square); });
  }
  return canvas.Cut();
}

}  // namespace elbowroom::control
