#include "review/contact_search.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "recon/hull/triangle_pieces.h"
#include "recon/hull/visual_hull.h"
#include "review/point_chain.h"
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
// A contact point that is deeper than this many point spacings is amid surface that is wholly in the hull, as
// far as a point spacing goes. Ball queries show that even where certified radii are half of the true ones.
constexpr double kDeepSpacings = 1.5;

double AreaMm2(const Corners& t) { return 0.5 * (t.b - t.a).cross(t.c - t.a).norm(); }
core::Ball BallOf(const Corners& t) { return core::BallOf(t.a, t.b, t.c); }
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
                const core::RigidTransform& world_from_part, const ContactSearchRule& rule,
                const ContactStretches* stretches, PointChunks* chunks)
      : hull_(hull),
        part_(part),
        world_from_part_(world_from_part),
        rule_(rule),
        stretches_(stretches),
        chunks_(chunks),
        points_(chunks) {
    found_.farthest = rule.rp_obj;
  }

  // The points are in the memory of `points`.
  [[nodiscard]] FoundContacts Run(std::vector<core::ContactPoint> points, std::vector<TakenPlaces>* taken) {
    found_.points = std::move(points);
    if (stretches_ == nullptr) {
      VisitNode(0, {}, nullptr);
      points_.CopyTo(&found_.points);
    } else {
      VisitPart();
      points_.CopyByPlace(stretches_->size(), taken, &found_.points);
    }
    return std::move(found_);
  }

 private:
  [[nodiscard]] Corners TriangleAt(std::uint32_t index) const {
    const auto& [a, b, c] = part_.mesh().triangles[index];
    const auto vertex = [&](std::int32_t i) {
      return world_from_part_ * part_.mesh().vertices_mm[static_cast<std::size_t>(i)];
    };
    return {vertex(a), vertex(b), vertex(c)};
  }

  [[nodiscard]] core::Ball BallAt(std::uint32_t node) const { return InWorld(part_.nodes()[node].ball); }
  [[nodiscard]] core::Ball InWorld(const core::Ball& ball) const {
    return {world_from_part_ * ball.center, ball.radius_mm};
  }
  [[nodiscard]] Corners InWorld(const Corners& t) const {
    return {world_from_part_ * t.a, world_from_part_ * t.b, world_from_part_ * t.c};
  }

  BallAnswer Ask(const core::Ball& ball, recon::UndecidedCameras* open) {
    ++found_.count.queries;
    return hull_.Classify(ball.center, ball.radius_mm, open);
  }

  // Calls visit(patch) with the patch to which a stretch of this size belongs: the given one, or a new one;
  // null for a stretch that is too large to be one contact point.
  template <typename Visit>
  void InPatch(double size_mm, Patch* given, const Visit& visit) {
    if (given != nullptr || size_mm > rule_.point_spacing_mm) return visit(given);
    Patch own;
    visit(&own);
    AddPoint(own);
  }

  // Whether a stretch of this size holds wanted points only in parts that are wholly inside, down to the size
  // of a contact point. So it needn't be asked as a whole.
  [[nodiscard]] bool IsAskedLater(double size_mm) const {
    return size_mm > rule_.point_spacing_mm && rule_.resolution_mm <= rule_.point_spacing_mm &&
           rule_.deeper_than_mm.value_or(0.0) >= kDeepSpacings * rule_.point_spacing_mm;
  }

  // Whether the rule wants nothing more of a stretch of surface. Only whole patches may hold too little
  // depth, so that a contact point is the same whatever depth is wanted.
  [[nodiscard]] bool IsUnwanted(const core::Ball& ball, const Patch* given) {
    if (rule_.ends_with_first) return !points_.is_empty() || (given != nullptr && given->largest_mm2 >= 0.0);
    if (!rule_.deeper_than_mm || given != nullptr) return false;
    ++found_.count.queries;
    return !hull_.MayHoldDeeper(ball.center, ball.radius_mm, *rule_.deeper_than_mm, &likely_);
  }

  [[nodiscard]] bool IsForAll() const { return !rule_.ends_with_first && !rule_.deeper_than_mm; }

  // Searches both halves of a node or triangle of this size, large ones in parallel. The result is the same
  // as if one were searched after the other. If not all points are wanted, what the first half shows spares
  // work in the second.
  template <typename First, typename Second>
  void VisitBoth(double size_mm, const First& first, const Second& second) {
    if (size_mm <= kSpacingsAlone * rule_.point_spacing_mm || !IsForAll()) {
      first(this);
      return second(this);
    }
    ContactSearch beside(hull_, part_, world_from_part_, rule_, stretches_, chunks_);
    tbb::parallel_invoke([&] { first(this); }, [&] { second(&beside); });
    const FoundContacts& others = beside.found_;
    points_.Append(beside.points_);
    Reach(others.farthest);
    found_.count.queries += others.count.queries;
    found_.count.skipped += others.count.skipped;
  }

  void AddPoint(const Patch& patch) {
    if (patch.largest_mm2 < 0.0) return;
    core::ContactPoint point{patch.position, 0.0, patch.area_mm2};
    if (rule_.deeper_than_mm) {
      ++found_.count.queries;
      if (!hull_.MayBeDeeper(patch.position, *rule_.deeper_than_mm, &likely_)) return;
      point.depth_mm = hull_.Probe(patch.position).radius_mm;
      if (!(point.depth_mm > *rule_.deeper_than_mm)) return;
      rule_.deeper_than_mm = point.depth_mm;
    }
    points_.Add(point, place_);
  }

  void VisitNode(std::uint32_t index, recon::UndecidedCameras open, Patch* given) {
    const core::TriangleTree::Node& node = part_.nodes()[index];
    const core::Ball ball = BallAt(index);
    if (IsUnwanted(ball, given)) return;
    const double size_mm = 2.0 * node.ball.radius_mm;
    const BallAnswer answer = IsAskedLater(size_mm) ? BallAnswer::kMixed : Ask(ball, &open);
    if (answer != BallAnswer::kMixed) found_.count.skipped += node.end - node.begin;
    if (answer == BallAnswer::kOutside) return;
    if (answer == BallAnswer::kInside) return AddNodeInside(index, given);
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

  // The ball around the whole part is asked first, as without stretches.
  void VisitPart() {
    recon::UndecidedCameras open;
    const ContactStretches::Node& root = stretches_->nodes()[0];
    const BallAnswer answer = Ask(BallAt(0), &open);
    if (answer != BallAnswer::kMixed) found_.count.skipped += root.triangles;
    if (answer == BallAnswer::kInside) AddStretchesInside(root);
    if (answer == BallAnswer::kMixed) VisitStretches(0, open);
  }

  void VisitStretches(std::uint32_t index, recon::UndecidedCameras open) {
    const ContactStretches::Node& node = stretches_->nodes()[index];
    const double size_mm = 2.0 * node.ball.radius_mm;
    const BallAnswer answer = AskStretches(node, &open);
    if (answer != BallAnswer::kMixed) found_.count.skipped += node.triangles;
    if (answer == BallAnswer::kOutside) return;
    if (answer == BallAnswer::kInside) return AddStretchesInside(node);
    if (node.left != 0) {
      return VisitBoth(
          size_mm, [&](ContactSearch* search) { search->VisitStretches(node.left, open); },
          [&](ContactSearch* search) { search->VisitStretches(node.left + 1, open); });
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const ContactStretch& stretch = stretches_->at(i);
      place_ = stretches_->place(i);
      if (stretch.node) {
        VisitNode(*stretch.node, open, nullptr);
      } else {
        VisitStretch(InWorld(stretch.corners), 2.0 * stretch.ball.radius_mm, open);
      }
    }
  }

  // Stretches that are far apart: by the ball around them, which often excludes them; others by their box,
  // which lies in the ball, and is flat where the surface is. A box can't show that some camera sees all of
  // it, a ball can.
  BallAnswer AskStretches(const ContactStretches::Node& node, recon::UndecidedCameras* open) {
    const bool asks_sight = recon::ExteriorIsObject(hull_.rig()) && open->asks_visibility;
    if (asks_sight || 2.0 * node.ball.radius_mm > kSpacingsAlone * rule_.point_spacing_mm) {
      const BallAnswer answer = Ask(InWorld(node.ball), open);
      if (answer != BallAnswer::kMixed) return answer;
    }
    ++found_.count.queries;
    const Eigen::Matrix3d half_edges =
        world_from_part_.rotation * (0.5 * node.box.sizes()).asDiagonal().toDenseMatrix();
    return hull_.Classify(recon::WorldShape::Box(world_from_part_ * node.box.center(), half_edges), open);
  }

  void AddStretchesInside(const ContactStretches::Node& node) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const ContactStretch& stretch = stretches_->at(i);
      place_ = stretches_->place(i);
      if (stretch.node) {
        AddNodeInside(*stretch.node, nullptr);
        continue;
      }
      Patch own;
      AddTriangleInside(InWorld(stretch.corners), &own);
      AddPoint(own);
    }
  }

  // A stretch of a mixed node. Its ball would seldom settle what the node's box didn't, so it isn't asked.
  void VisitStretch(const Corners& triangle, double size_mm, recon::UndecidedCameras open) {
    Patch own;
    const bool is_settled =
        SidesOf(size_mm) > recon::CutTriangle::kMostSides && AskShape(triangle, &open, &own);
    if (!is_settled) CutOrHalve(triangle, size_mm, open, &own);
    AddPoint(own);
  }

  void VisitTriangle(const Corners& triangle, recon::UndecidedCameras open, Patch* given) {
    const core::Ball ball = BallOf(triangle);
    if (IsUnwanted(ball, given)) return;
    const double size_mm = 2.0 * ball.radius_mm;
    InPatch(size_mm, given, [&](Patch* patch) {
      if (SidesOf(size_mm) > kSidesWithoutBall && !IsAskedLater(size_mm) &&
          AskTriangle(triangle, ball, &open, patch))
        return;
      CutOrHalve(triangle, size_mm, open, patch);
    });
  }

  // How many pieces of the resolution's size are along a triangle of this size.
  [[nodiscard]] double SidesOf(double size_mm) const {
    return std::max(std::ceil(size_mm / rule_.resolution_mm), 1.0);
  }

  void CutOrHalve(const Corners& triangle, double size_mm, const recon::UndecidedCameras& open,
                  Patch* patch) {
    const double sides = SidesOf(size_mm);
    if (sides == 1.0 || (patch != nullptr && sides <= recon::CutTriangle::kMostSides))
      return Cut({triangle.a, triangle.b, triangle.c, static_cast<int>(sides)}, AreaMm2(triangle), open,
                 patch);
    const auto halves = Bisect(triangle);
    VisitBoth(
        size_mm, [&](ContactSearch* search) { search->VisitTriangle(halves.first, open, patch); },
        [&](ContactSearch* search) { search->VisitTriangle(halves.second, open, patch); });
  }

  // True if the query of the triangle itself settles it.
  bool AskShape(const Corners& triangle, recon::UndecidedCameras* open, Patch* patch) {
    ++found_.count.queries;
    const BallAnswer answer =
        hull_.Classify(recon::WorldShape::Triangle(triangle.a, triangle.b, triangle.c), open);
    if (answer == BallAnswer::kInside) AddTriangleInside(triangle, patch);
    return answer != BallAnswer::kMixed;
  }

  // True if the query of the triangle's ball, or of the triangle itself, settles it.
  bool AskTriangle(const Corners& triangle, const core::Ball& ball, recon::UndecidedCameras* open,
                   Patch* patch) {
    const BallAnswer answer = Ask(ball, open);
    if (answer == BallAnswer::kInside) AddTriangleInside(triangle, patch);
    if (answer != BallAnswer::kMixed) return true;
    return SidesOf(2.0 * ball.radius_mm) > recon::CutTriangle::kMostSides && AskShape(triangle, open, patch);
  }

  // Cuts a triangle into pieces of the resolution's size, which their centres decide. The middle one of those
  // in the hull stands for their place; a triangle that is wholly inside has the same place here as
  // elsewhere.
  void Cut(const recon::CutTriangle& triangle, double area_mm2, const recon::UndecidedCameras& open,
           Patch* patch) {
    found_.count.queries += triangle.pieces();
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
    const Vector3d place = count == triangle.pieces() ? Centroid({triangle.a, triangle.b, triangle.c})
                                                      : triangle.CentreOf(middle);
    InPatch(0.0, patch, [&](Patch* whole) { whole->Add(area_mm2 * count / triangle.pieces(), place); });
  }

  void AddNodeInside(std::uint32_t index, Patch* given) {
    const core::TriangleTree::Node& node = part_.nodes()[index];
    InPatch(2.0 * node.ball.radius_mm, given, [&](Patch* patch) {
      if (patch != nullptr) {
        ReachNode(index);
        patch->Add(node.area_mm2, Centroid(TriangleAt(part_.order()[node.begin])));
      } else if (node.left != 0) {
        for (const std::uint32_t child : {node.left, node.left + 1})
          if (!IsUnwanted(BallAt(child), nullptr)) AddNodeInside(child, nullptr);
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
    InPatch(2.0 * BallOf(triangle).radius_mm, given, [&](Patch* patch) {
      if (patch != nullptr) return patch->Add(AreaMm2(triangle), Centroid(triangle));
      const auto halves = Bisect(triangle);
      for (const Corners& half : {halves.first, halves.second})
        if (!IsUnwanted(BallOf(half), nullptr)) AddInside(half, nullptr);
    });
  }

  // Whether x is farther from RP_obj than all points before it.
  [[nodiscard]] bool Reaches(const Vector3d& x) const {
    return (x - rule_.rp_obj).squaredNorm() > (found_.farthest - rule_.rp_obj).squaredNorm();
  }
  void Reach(const Vector3d& x) {
    if (Reaches(x)) found_.farthest = x;
  }

  // Offers all vertices of a node wholly inside as CP_obj, unless its ball shows that none is farther.
  void ReachNode(std::uint32_t index) {
    const core::TriangleTree::Node& node = part_.nodes()[index];
    const double most_mm = (world_from_part_ * node.ball.center - rule_.rp_obj).norm() + node.ball.radius_mm;
    if (most_mm <= (found_.farthest - rule_.rp_obj).norm()) return;
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
  ContactSearchRule rule_;             // deeper_than_mm grows with the points found
  core::CameraIndex likely_ = 0;       // showed last that a ball holds nothing deep enough
  const ContactStretches* stretches_;  // null: the part's tree is searched
  std::uint32_t place_ = 0;            // of the stretch that is searched
  PointChunks* chunks_;
  PointChain points_;
  FoundContacts found_;  // but for the points
};

}  // namespace

FoundContacts SearchContacts(const recon::VisualHull& hull, const core::TriangleTree& part,
                             const core::RigidTransform& world_from_part, const ContactSearchRule& rule,
                             ContactSearchScratch* scratch, const ContactStretches* stretches) {
  scratch->chunks.Reset();
  if (rule.ends_with_first || rule.deeper_than_mm) stretches = nullptr;
  ContactSearch search(hull, part, world_from_part, rule, stretches, &scratch->chunks);
  return search.Run(std::move(scratch->points), &scratch->taken);
}

}  // namespace elbowroom::review
