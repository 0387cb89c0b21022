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
  std::string name;                // unique in its layout
  std::string file;                // as written in LAYOUT.toml; empty for a part made by the program
  std::optional<LengthUnit> unit = {};  // that its file is to be read in; nothing: as the file or the layout says
  SharedMesh mesh;                 // in millimetres
  RigidTransform world_from_part;  // as authored, before spacings
  RecoveryRule recovery = {};      // which way it gives way to the hull
  GivesWay gives_way = {};         // whether and how it does; by default not at all
};

enum class Axis { kX, kY, kZ };

[[nodiscard]] std::optional<Axis> ParseAxis(std::string_view text);  // "x", "y", "z"
[[nodiscard]] std::string_view ToString(Axis axis);

// The gap along a world axis from the upper extent of `reference` to the lower extent of `moving`:
// "top of the PMT box to bottom of payload A". Negative gaps overlap.
struct Spacing {
  std::string name;       // unique in its layout
  std::string moving;     // part name
  std::string reference;  // part name
  Axis axis = Axis::kZ;
  double min_mm = 0.0;
  double max_mm = 0.0;
  double initial_mm = 0.0;
};

struct PairRule {
  std::string a;  // part name
  std::string b;  // part name
  double required_clearance_mm = 0.0;
  bool authorised_contact = false;
  bool ignore = false;  // the pair is never asked about
};

struct Layout {
  LengthUnit unit = LengthUnit::kMillimetre;  // default for parts that name none
  std::vector<Part> parts;
  std::vector<Spacing> spacings;
  std::vector<PairRule> pair_rules;
  std::vector<Stream> streams;

  // Throws: Error{kRange} naming the part, spacing, pair or stream: duplicate or unknown names, a part
  // without a mesh or with a recovery that can't be used, limits not in order, a spacing whose moving part is
  // its own reference, circular spacings, a figure of what gives way or of a stream out of range.
  void Validate() const;

  [[nodiscard]] std::optional<PartIndex> FindPart(std::string_view name) const;
  [[nodiscard]] std::optional<SpacingIndex> FindSpacing(std::string_view name) const;
  [[nodiscard]] std::vector<double> InitialSpacings() const;
};

// world_from_part of every part (same order) with spacing i at spacing_mm[i]. A function of the values alone:
// moving a gap out and back gives bit-equal poses. References are placed before the parts that move against
// them. Throws: PreconditionError when the count differs from the layout's spacings.
[[nodiscard]] std::vector<RigidTransform> PosesAt(const Layout& layout, std::span<const double> spacing_mm);

// Those poses with parts moved from there, each in its own frame; rest_from_parts empty: none.
[[nodiscard]] std::vector<RigidTransform> WithMotions(std::span<const RigidTransform> world_from_rests,
                                                      std::span<const RigidTransform> rest_from_parts);

}  // namespace elbowroom::core
