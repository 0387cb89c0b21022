// The virtual side of a trial: parts, where they stand, which gaps may change, which pairs must keep apart.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/gives_way.h"
#include "core/ids.h"
#include "core/recovery_rule.h"
#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"
#include "core/units.h"

namespace elbowroom::core {

struct Part {
  std::string name;                     // unique in its layout
  std::string file;                     // as written in LAYOUT.toml; empty for a part made by the program
  std::optional<LengthUnit> unit = {};  // of its file; nothing: as the file itself says
  SharedMesh mesh;                      // in millimetres
  RigidTransform world_from_part;       // as authored, before spacings
  RecoveryRule recovery = {};           // along which way it may leave the hull
  GivesWay gives_way = {};              // whether and how it moves when it is touched; by default it doesn't
  std::string node = {};                // instance in the assembly file; empty: all of the file

  [[nodiscard]] bool operator==(const Part&) const = default;  // meshes: the same object
};

// Parts that spacings and pairs may name together.
struct Group {
  std::string name;                // no part and no other group has it
  std::vector<std::string> parts;  // part names

  [[nodiscard]] bool operator==(const Group&) const = default;
};

enum class Axis { kX, kY, kZ };

[[nodiscard]] std::optional<Axis> ParseAxis(std::string_view text);  // "x", "y", "z"
[[nodiscard]] std::string_view ToString(Axis axis);

// The gap along a world axis from the upper extent of `reference` to the lower extent of `moving`:
// "top of the PMT box to bottom of payload A". Negative gaps overlap. A group's extent is that of all its
// parts together, and it moves as one.
struct Spacing {
  std::string name;       // unique in its layout
  std::string moving;     // part or group name
  std::string reference;  // part or group name
  Axis axis = Axis::kZ;
  double min_mm = 0.0;
  double max_mm = 0.0;
  double initial_mm = 0.0;

  [[nodiscard]] bool operator==(const Spacing&) const = default;
};

struct PairRule {
  std::string a;  // part or group name
  std::string b;  // part or group name
  double required_clearance_mm = 0.0;
  bool authorised_contact = false;
  bool ignore = false;  // the pair is never asked about

  [[nodiscard]] bool operator==(const PairRule&) const = default;
};

struct Layout {
  LengthUnit unit = LengthUnit::kMillimetre;  // default for parts that name none
  std::vector<Part> parts;
  std::vector<Spacing> spacings;
  std::vector<PairRule> pair_rules;
  std::vector<Stream> streams;
  std::vector<Group> groups = {};

  [[nodiscard]] bool operator==(const Layout&) const = default;

  // Throws: Error{kRange} with what FindLayoutFault (core/layout_fault.h) says.
  void Validate() const;

  [[nodiscard]] std::optional<PartIndex> FindPart(std::string_view name) const;
  [[nodiscard]] std::optional<GroupIndex> FindGroup(std::string_view name) const;
  // The part of that name, or the parts of the group of that name; none if it is neither. Names in a group
  // that no part has are left out.
  [[nodiscard]] std::vector<PartIndex> PartsNamed(std::string_view name) const;
  [[nodiscard]] bool SharePart(std::string_view a, std::string_view b) const;  // part or group names
  [[nodiscard]] std::optional<SpacingIndex> FindSpacing(std::string_view name) const;
  [[nodiscard]] std::vector<double> InitialSpacings() const;
};

// The spacing that `option` of a command names. Throws: Error{kRange}: none has that name; says which is like
// it.
[[nodiscard]] SpacingIndex RequireSpacing(const Layout& layout, const std::string& name,
                                          std::string_view option = "--spacing");

// Where the parts of a layout stand at any spacings. It goes over the meshes when it is made; asking it costs
// the same however large they are.
class SpacingPoses {
 public:
  explicit SpacingPoses(const Layout& layout);

  // world_from_part of every part (same order) with spacing i at spacing_mm[i]. A function of the values
  // alone: moving a gap out and back gives bit-equal poses. References are placed before the parts that move
  // against them. Throws: PreconditionError when the count differs from the layout's spacings.
  [[nodiscard]] std::vector<RigidTransform> At(std::span<const double> spacing_mm) const;

 private:
  // How far a part reaches along an axis of the world from its own origin.
  struct Reach {
    PartIndex part;
    double mm;
  };
  struct Placement {
    SpacingIndex spacing;
    Eigen::Index axis;
    std::vector<Reach> tops;     // of the reference's parts
    std::vector<Reach> bottoms;  // of the moving parts
  };

  std::size_t spacing_count_;
  std::vector<RigidTransform> world_from_parts_;  // as authored
  std::vector<Placement> placements_;             // in their order
};

// SpacingPoses, for one time.
[[nodiscard]] std::vector<RigidTransform> PosesAt(const Layout& layout, std::span<const double> spacing_mm);

// The gap of a spacing when the parts stand at these poses (one a part), by the exact extents of their
// meshes. Throws: PreconditionError when the number of poses isn't that of the parts.
[[nodiscard]] double GapMm(const Layout& layout, const Spacing& spacing,
                           std::span<const RigidTransform> world_from_parts);

// The spacings in an order that places every reference before the parts that move against it. Circular
// spacings, and those that depend on them, are left out.
[[nodiscard]] std::vector<SpacingIndex> OrderOfPlacement(const Layout& layout);

// The same layout, with each rule that names groups replaced by rules for pairs of parts. If several rules
// are for one pair, those stay that name the most of its two parts themselves instead of by a group.
[[nodiscard]] Layout WithPairsOfParts(Layout layout);

// The poses world_from_rest * rest_from_part, one a part. `rest_from_parts` is empty if no part was moved.
// Throws: PreconditionError when the counts differ.
[[nodiscard]] std::vector<RigidTransform> WithMotions(std::span<const RigidTransform> world_from_rests,
                                                      std::span<const RigidTransform> rest_from_parts);

}  // namespace elbowroom::core
