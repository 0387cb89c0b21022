// A part searched by its stretches, against the same part searched by its own tree.
#include "review/contact_stretches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "recon/hull/visual_hull.h"
#include "review/contacts.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/box_hull.h"
#include "tests/support/panel_mesh.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using recon::Random;

// Stretches are cut in the part's frame, triangles of the tree in the world's: coordinates of some hundred mm
// round differently.
constexpr double kRoundingMm = 1e-9;

// A disc of long strips that meet in its middle.
core::SharedMesh Fan(int strips, double radius_mm) {
  core::TriangleMesh mesh;
  mesh.vertices_mm.push_back(Vector3d::Zero());
  for (int i = 0; i < strips; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / strips;
    mesh.vertices_mm.emplace_back(radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad), 0.0);
  }
  for (int i = 0; i < strips; ++i) mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % strips});
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

// Triangles smaller than a point spacing, so that nodes of the tree are stretches.
core::SharedMesh FinePanel() {
  return std::make_shared<const core::TriangleMesh>(
      test_support::PanelMesh(60, 50, {-100.0, -80.0, 0.0}, {200.0, 0.0, 0.0}, {0.0, 160.0, 0.0}));
}

core::SharedMesh Cube() {
  return std::make_shared<const core::TriangleMesh>(core::testing::Box(Vector3d(150.0, 170.0, 190.0)));
}

TEST(ContactStretches, CoverThePart) {
  for (const core::SharedMesh& mesh : {Fan(64, 160.0), FinePanel(), Cube()}) {
    const core::TriangleTree part(mesh);
    const auto stretches = ContactStretches::Make(part, 10.0);
    ASSERT_NE(stretches, nullptr);
    std::vector<bool> is_taken(stretches->size(), false);
    double area_mm2 = 0.0;
    for (std::uint32_t i = 0; i < stretches->size(); ++i) {
      const ContactStretch& stretch = stretches->at(i);
      EXPECT_LE(2.0 * stretch.ball.radius_mm, 10.0);
      EXPECT_FALSE(is_taken[stretches->place(i)]);
      is_taken[stretches->place(i)] = true;
      const Corners& t = stretch.corners;
      area_mm2 +=
          stretch.node ? part.nodes()[*stretch.node].area_mm2 : 0.5 * (t.b - t.a).cross(t.c - t.a).norm();
    }
    EXPECT_NEAR(area_mm2, part.nodes()[0].area_mm2, 1e-9 * area_mm2);
    EXPECT_EQ(stretches->nodes()[0].triangles, mesh->triangles.size());
  }
}

TEST(ContactStretches, NodesEncloseTheirStretches) {
  for (const core::SharedMesh& mesh : {Fan(64, 160.0), FinePanel(), Cube()}) {
    const core::TriangleTree part(mesh);
    const auto stretches = ContactStretches::Make(part, 10.0);
    for (const ContactStretches::Node& node : stretches->nodes()) {
      const auto expect_in = [&](const Vector3d& x) {
        EXPECT_LE((x - node.ball.center).norm(), node.ball.radius_mm);
        EXPECT_TRUE(node.box.contains(x));
      };
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const ContactStretch& stretch = stretches->at(i);
        if (!stretch.node) {
          for (const Vector3d& corner : {stretch.corners.a, stretch.corners.b, stretch.corners.c})
            expect_in(corner);
          continue;
        }
        const core::TriangleTree::Node& covered = part.nodes()[*stretch.node];
        for (std::uint32_t k = covered.begin; k < covered.end; ++k)
          for (const std::int32_t vertex : mesh->triangles[part.order()[k]])
            expect_in(mesh->vertices_mm[static_cast<std::size_t>(vertex)]);
      }
    }
  }
}

TEST(ContactStretches, ThereAreNoneOfAPartThatNeedsTooMany) {
  const core::TriangleTree part(Cube()), nothing(std::make_shared<const core::TriangleMesh>());
  EXPECT_EQ(ContactStretches::Make(part, 0.1), nullptr);
  EXPECT_EQ(ContactStretches::Make(nothing, 10.0), nullptr);
}

TEST(ContactStretches, GiveTheContactsOfTheWholeSearch) {
  Random random(6200);
  int touches = 0;
  for (const core::SharedMesh& mesh : {Fan(64, 160.0), FinePanel(), Cube()}) {
    const core::TriangleTree part(mesh);
    ContactOptions options;
    // Stretches of no more than 8 pieces a side: the place of a point doesn't hang on the query that settles
    // it.
    options.resolution_mm = 2.0;
    options.max_points = 1000000;  // all: which ones are kept of many may hang on rounding
    ReviewScratch with_stretches;
    with_stretches.stretches = ContactStretches::Make(part, options.point_spacing_mm);
    // Where a stretch has several triangles, any of them may give the point's place.
    const bool is_fine = with_stretches.stretches->at(0).node.has_value();
    const double apart_mm = is_fine ? options.point_spacing_mm : kRoundingMm;
    for (int trial = 0; trial < 30; ++trial) {
      const core::RigidTransform world_from_part{random.Rotation(),
                                                 random.Uniform(0.0, 150.0) * random.Direction()};
      const core::PartContact whole = FindContacts(BoxHull(), part, world_from_part, 0, options);
      const core::PartContact found =
          FindContacts(BoxHull(), part, world_from_part, 0, options, nullptr, &with_stretches);
      ASSERT_EQ(found.verdict, whole.verdict);
      EXPECT_EQ(found.contact_point_count, whole.contact_point_count);
      EXPECT_NEAR(found.contact_area_mm2, whole.contact_area_mm2, 1e-9 * whole.contact_area_mm2);
      EXPECT_EQ(found.contained_in_world_mm.has_value(), whole.contained_in_world_mm.has_value());
      if (!whole.deepest) continue;
      ++touches;
      EXPECT_NEAR(found.deepest->depth_mm, whole.deepest->depth_mm, apart_mm);
      ASSERT_EQ(found.points.size(), whole.points.size());
      for (std::size_t i = 0; i < found.points.size(); ++i) {
        const Vector3d apart = found.points[i].position_in_world_mm - whole.points[i].position_in_world_mm;
        EXPECT_LE(apart.norm(), apart_mm);
      }
    }
  }
  EXPECT_GT(touches, 30);
}

// What was made for another part, or another spacing, isn't used.
TEST(ContactStretches, OfAnotherPartAreLeftAlone) {
  const core::TriangleTree part(Cube()), other(FinePanel());
  ReviewScratch scratch;
  scratch.stretches = ContactStretches::Make(other, 10.0);
  const core::PartContact whole = FindContacts(BoxHull(), part, {}, 0);
  const core::PartContact found = FindContacts(BoxHull(), part, {}, 0, {}, nullptr, &scratch);
  ASSERT_GT(whole.contact_point_count, 0);
  EXPECT_EQ(found.contact_point_count, whole.contact_point_count);
  EXPECT_EQ(found.count.queries, whole.count.queries);
}

}  // namespace
}  // namespace elbowroom::review
