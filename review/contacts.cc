#include "review/contacts.h"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "recon/hull/triangle_pieces.h"
#include "recon/hull/visual_hull.h"
#include "review/containment.h"
#include "review/point_spread.h"
#include "review/recovery.h"
#include "review/triangle_bisection.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::BallAnswer;

// Triangles that are cut into no more pieces a side are cut without a ball query first: it costs as much as
// the queries of a few centres.
constexpr double kSidesWithoutBall = 2.0;
// The halves of what is larger than this many point spacings are searched in parallel.
constexpr double kSpacingsAlone = 8.0;

double AreaMm2(const Corners& t) { return 0.5 * (t.b - t.a).cross(t.c - t.a).norm(); }
Vector3d Centroid(const Corners& t) { return (t.a + t.b + t.c) / 3.0; }

// The part of a small stretch of surface that is in the hull. It becomes one contact point.
struct Patch {
  double area_mm2 = 0.0;
  double largest_mm2 = -1.0;
  Vector3d position = Vector3d::Zero();  // of its largest piece

  void Add(double piece_mm2, const Vector3d& at) {
    area_mm2 += piece_mm2;
    if (piece_mm2 <= largest_mm2) return;
    largest_mm2 = piece_mm2;
    position = at;
  }
};

// The search for the contacts of one part with one hull.
class ContactSearch {
 public:
  ContactSearch(const recon::VisualHull& hull, const core::TriangleTree& part,
                const core::RigidTransform& world_from_part, const ContactOptions& options,
                double resolution_mm, const Vector3d& rp_obj)
      : hull_(hull),
        part_(part),
        world_from_part_(world_from_part),
        options_(options),
        resolution_mm_(resolution_mm),
        rp_obj_(rp_obj),
        farthest_(rp_obj) {}

  void Run() { VisitNode(0, {}, nullptr); }

  [[nodiscard]] std::vector<core::ContactPoint> TakePoints() { return std::move(points_); }
  // CP_obj: the point of the part in the hull that is farthest from RP_obj. A piece wholly inside offers its
  // vertices, one of which is its farthest point. A piece that its centre decides offers its centre.
  [[nodiscard]] const Vector3d& farthest() const { return farthest_; }
  [[nodiscard]] const core::QueryCount& count() const { return count_; }

 private:
  [[nodiscard]] Corners TriangleAt(std::uint32_t index) const {
    const auto& [a, b, c] = part_.mesh().triangles[index];
    const auto vertex = [&](std::int32_t i) {
      return world_from_part_ * part_.mesh().vertices_mm[static_cast<std::size_t>(i)];
    };
    return {vertex(a), vertex(b), vertex(c)};
  }

  BallAnswer Ask(const core::Ball& ball, recon::UndecidedCameras* open) {
    ++count_.queries;
    return hull_.Classify(ball.center, ball.radius_mm, open);
  }

  // Calls visit(patch) with the patch to which a stretch of this size belongs: the given one, or a new one;
  // null for a stretch that is too large to be one contact point.
  template <typename Visit>
  void InPatch(double size_mm, Patch* given, const Visit& visit) {
    if (given != nullptr || size_mm > options_.point_spacing_mm) return visit(given);
    Patch own;
    visit(&own);
    AddPoint(own);
  }

  // Searches both halves of a node or triangle of this size, large ones in parallel. The result is the same
  // as if one were searched after the other.
  template <typename First, typename Second>
  void VisitBoth(double size_mm, const First& first, const Second& second) {
    if (size_mm <= kSpacingsAlone * options_.point_spacing_mm) {
      first(this);
      return second(this);
    }
    ContactSearch beside(hull_, part_, world_from_part_, options_, resolution_mm_, rp_obj_);
    tbb::parallel_invoke([&] { first(this); }, [&] { second(&beside); });
    points_.insert(points_.end(), beside.points_.begin(), beside.points_.end());
    Reach(beside.farthest_);
    count_.queries += beside.count_.queries;
    count_.skipped += beside.count_.skipped;
  }

  void AddPoint(const Patch& patch) {
    if (patch.largest_mm2 >= 0.0) points_.push_back({patch.position, 0.0, patch.area_mm2});
  }

  void VisitNode(std::uint32_t index, recon::UndecidedCameras open, Patch* given) {
    const core::TriangleTree::Node& node = part_.nodes()[index];
    const BallAnswer answer = Ask({world_from_part_ * node.ball.center, node.ball.radius_mm}, &open);
    if (answer != BallAnswer::kMixed) count_.skipped += node.end - node.begin;
    if (answer == BallAnswer::kOutside) return;
    if (answer == BallAnswer::kInside) return AddNodeInside(index, given);
    const double size_mm = 2.0 * node.ball.radius_mm;
    InPatch(size_mm, given, [&](Patch* patch) {
      if (node.left != 0) {
        return VisitBoth(
            size_mm, [&](ContactSearch* search) { search->VisitNode(node.left, open, patch); },
            [&](ContactSearch* search) { search->VisitNode(node.left + 1, open, patch); });
      }
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        VisitTriangle(TriangleAt(part_.order()[i]), open, patch);
    });
  }

  void VisitTriangle(const Corners& triangle, recon::UndecidedCameras open, Patch* given) {
    const core::Ball ball = core::BallOf(triangle.a, triangle.b, triangle.c);
    const double size_mm = 2.0 * ball.radius_mm;
    InPatch(size_mm, given, [&](Patch* patch) {
      const double sides = std::max(std::ceil(size_mm / resolution_mm_), 1.0);
      if (sides > kSidesWithoutBall && AskTriangle(triangle, ball, &open, patch)) return;
      if (sides == 1.0 || (patch != nullptr && sides <= recon::CutTriangle::kMostSides))
        return Cut({triangle.a, triangle.b, triangle.c, static_cast<int>(sides)}, AreaMm2(triangle), open,
                   patch);
      const auto halves = Bisect(triangle);
      VisitBoth(
          size_mm, [&](ContactSearch* search) { search->VisitTriangle(halves.first, open, patch); },
          [&](ContactSearch* search) { search->VisitTriangle(halves.second, open, patch); });
    });
  }

  // True if the query of the triangle's ball, or of the triangle itself, settles it.
  bool AskTriangle(const Corners& triangle, const core::Ball& ball, recon::UndecidedCameras* open,
                   Patch* patch) {
    BallAnswer answer = Ask(ball, open);
    if (answer == BallAnswer::kMixed &&
        2.0 * ball.radius_mm > recon::CutTriangle::kMostSides * resolution_mm_) {
      ++count_.queries;
      answer = hull_.Classify(recon::WorldShape::Triangle(triangle.a, triangle.b, triangle.c), open);
    }
    if (answer == BallAnswer::kInside) AddTriangleInside(triangle, patch);
    return answer != BallAnswer::kMixed;
  }

  // Cuts a triangle into pieces of the resolution's size, which their centres decide. The middle one of those
  // in the hull stands for their place.
  void Cut(const recon::CutTriangle& triangle, double area_mm2, const recon::UndecidedCameras& open,
           Patch* patch) {
    count_.queries += triangle.pieces();
    const std::uint64_t inside = triangle.sides > 1 ? recon::PiecesInHull(hull_, triangle, open)
                                 : hull_.Contains(triangle.CentreOf(0), open) ? 1
                                                                              : 0;
    if (inside == 0) return;
    const int count = std::popcount(inside);
    const bool may_reach = Reaches(triangle.a) || Reaches(triangle.b) || Reaches(triangle.c);
    int middle = 0, passed = 0;
    for (std::uint64_t left = inside; left != 0; left &= left - 1) {
      const int piece = std::countr_zero(left);
      if (2 * passed++ <= count) middle = piece;
      if (may_reach) Reach(triangle.CentreOf(piece));
    }
    InPatch(0.0, patch, [&](Patch* whole) {
      whole->Add(area_mm2 * count / triangle.pieces(), triangle.CentreOf(middle));
    });
  }

  void AddNodeInside(std::uint32_t index, Patch* given) {
    const core::TriangleTree::Node& node = part_.nodes()[index];
    InPatch(2.0 * node.ball.radius_mm, given, [&](Patch* patch) {
      if (patch != nullptr) {
        ReachNode(index);
        patch->Add(node.area_mm2, Centroid(TriangleAt(part_.order()[node.begin])));
      } else if (node.left != 0) {
        AddNodeInside(node.left, nullptr);
        AddNodeInside(node.left + 1, nullptr);
      } else {
        for (std::uint32_t i = node.begin; i < node.end; ++i)
          AddTriangleInside(TriangleAt(part_.order()[i]), nullptr);
      }
    });
  }

  void AddTriangleInside(const Corners& triangle, Patch* patch) {
    for (const Vector3d& vertex : {triangle.a, triangle.b, triangle.c}) Reach(vertex);
    AddInside(triangle, patch);
  }

  void AddInside(const Corners& triangle, Patch* given) {
    InPatch(2.0 * core::BallOf(triangle.a, triangle.b, triangle.c).radius_mm, given, [&](Patch* patch) {
      if (patch != nullptr) return patch->Add(AreaMm2(triangle), Centroid(triangle));
      const auto [first, second] = Bisect(triangle);
      AddInside(first, nullptr);
      AddInside(second, nullptr);
    });
  }

  // Whether x is farther from RP_obj than all points before it.
  [[nodiscard]] bool Reaches(const Vector3d& x) const {
    return (x - rp_obj_).squaredNorm() > (farthest_ - rp_obj_).squaredNorm();
  }
  void Reach(const Vector3d& x) {
    if (Reaches(x)) farthest_ = x;
  }

  // Offers all vertices of a node wholly inside as CP_obj, unless its ball shows that none is farther.
  void ReachNode(std::uint32_t index) {
    const core::TriangleTree::Node& node = part_.nodes()[index];
    const double most_mm = (world_from_part_ * node.ball.center - rp_obj_).norm() + node.ball.radius_mm;
    if (most_mm <= (farthest_ - rp_obj_).norm()) return;
    if (node.left != 0) {
      ReachNode(node.left);
      ReachNode(node.left + 1);
      return;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const Corners triangle = TriangleAt(part_.order()[i]);
      for (const Vector3d& vertex : {triangle.a, triangle.b, triangle.c}) Reach(vertex);
    }
  }

  const recon::VisualHull& hull_;
  const core::TriangleTree& part_;
  const core::RigidTransform& world_from_part_;
  const ContactOptions& options_;
  double resolution_mm_;
  Vector3d rp_obj_;
  Vector3d farthest_;
  std::vector<core::ContactPoint> points_;
  core::QueryCount count_;
};

// The deepest point; the first of several.
core::ContactPoint Deepest(const recon::VisualHull& hull, const std::vector<core::ContactPoint>& points) {
  core::ContactPoint deepest;
  core::CameraIndex likely = 0;
  for (const core::ContactPoint& point : points) {
    const bool is_first = &point == points.data();
    if (!is_first && !hull.MayBeDeeper(point.position_in_world_mm, deepest.depth_mm, &likely)) continue;
    const double depth_mm = hull.Probe(point.position_in_world_mm).radius_mm;
    if (!is_first && !(depth_mm > deepest.depth_mm)) continue;
    deepest = point;
    deepest.depth_mm = depth_mm;
  }
  return deepest;
}

}  // namespace

void ContactOptions::Validate() const {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw core::Error(core::ErrorKind::kRange, "contacts: " + what);
  };
  require(resolution_mm >= 0.0 && std::isfinite(resolution_mm),
          fmt::format("resolution must be positive, not {} mm", resolution_mm));
  require(point_spacing_mm > 0.0, fmt::format("point spacing must be positive, not {} mm", point_spacing_mm));
  const auto broken = recovery.BrokenRule();
  require(!broken, fmt::format("recovery: {}", broken.value_or("")));
  require(max_points > 0, fmt::format("at least one contact point must be kept, not {}", max_points));
}

std::optional<double> PixelFootprintMm(const core::Rig& rig, const Vector3d& x_in_world) {
  std::optional<double> smallest_mm;
  for (const core::CameraModel& camera : rig.cameras) {
    const Vector3d x_in_cam = camera.cam_from_world() * x_in_world;
    if (!(x_in_cam.z() > 0.0)) continue;
    const double footprint_mm = x_in_cam.z() / camera.PixelStretch(0.0);
    if (!smallest_mm || footprint_mm < *smallest_mm) smallest_mm = footprint_mm;
  }
  return smallest_mm;
}

core::PartContact FindContacts(const recon::VisualHull& hull, const core::TriangleTree& part,
                               const core::RigidTransform& world_from_part, core::PartIndex part_index,
                               const ContactOptions& options, InsideCells* inside) {
  options.Validate();
  core::PartContact contact;
  contact.part = part_index;
  contact.count.triangles = static_cast<std::int64_t>(part.mesh().triangles.size());
  contact.count.skipped = contact.count.triangles;
  if (part.nodes().empty() || hull.IsEmpty()) return contact;

  const Vector3d center_in_world = world_from_part * part.nodes()[0].ball.center;
  constexpr double kFallbackResolutionMm = 1.0;  // if no camera has the part in front of it
  contact.resolution_mm =
      options.resolution_mm > 0.0
          ? options.resolution_mm
          : 0.5 * PixelFootprintMm(hull.rig(), center_in_world).value_or(2.0 * kFallbackResolutionMm);
  const RecoveryWay way = WayOf(options.recovery, part, world_from_part);
  ContactSearch search(hull, part, world_from_part, options, contact.resolution_mm, way.rp_obj);
  search.Run();
  contact.count.queries = search.count().queries;
  contact.count.skipped = search.count().skipped;

  std::vector<core::ContactPoint> points = search.TakePoints();
  if (points.empty()) {
    if (contact.count.queries == 1) return contact;  // the ball around the whole part is outside the hull
    InsideCells own_cells(part);
    contact.contained_in_world_mm =
        FindHullInside(hull, world_from_part, kContainmentCell * contact.resolution_mm,
                       inside != nullptr ? inside : &own_cells, &contact.count.queries);
    if (!contact.contained_in_world_mm) return contact;
    contact.verdict = core::Verdict::kContact;
    contact.recovery_status = core::RecoveryStatus::kHullInsidePart;
    return contact;
  }
  contact.verdict = core::Verdict::kContact;
  contact.contact_point_count = static_cast<std::int64_t>(points.size());
  for (const core::ContactPoint& point : points) contact.contact_area_mm2 += point.area_mm2;
  contact.count.queries += contact.contact_point_count;
  tbb::parallel_invoke(
      [&] {
        RecoveryAnswer answer = Recover(hull, search.farthest(), way);
        contact.recovery_status = answer.status;
        contact.recovery = std::move(answer.recovery);
        contact.deepest = Deepest(hull, points);
      },
      [&] {
        contact.points = SpreadEvenly(points, static_cast<std::size_t>(options.max_points));
        for (core::ContactPoint& point : contact.points)
          point.depth_mm = hull.Probe(point.position_in_world_mm).radius_mm;
      });
  return contact;
}

}  // namespace elbowroom::review
