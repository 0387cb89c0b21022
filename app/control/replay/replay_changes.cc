#include "app/control/replay/replay_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/spelling.h"

namespace elbowroom::control {
namespace {

core::PartIndex RequirePart(const core::Layout& layout, const std::string& name) {
  if (const auto index = layout.FindPart(name)) return *index;
  std::vector<std::string_view> known;
  for (const core::Part& part : layout.parts) known.emplace_back(part.name);
  throw core::Error(core::ErrorKind::kRange,
                    fmt::format("no part is named '{}'; {}", name,
                                core::SpellingAdvice(name, known, "use the name of a [[part]]")));
}

bool HaveSameMesh(const core::Part& a, const core::Part& b) {
  return a.mesh == b.mesh || (a.mesh && b.mesh && *a.mesh == *b.mesh);
}

// In words what differs between two parts of one name; empty: nothing that is judged.
std::string DifferenceOf(const core::Part& recorded, const core::Part& now) {
  std::string what;
  const auto add = [&](const std::string& difference) { what += (what.empty() ? "" : ", ") + difference; };
  if (!HaveSameMesh(recorded, now))
    add(fmt::format("another shape ({} triangles, {} before)", now.mesh->triangles.size(),
                    recorded.mesh->triangles.size()));
  if (now.world_from_part != recorded.world_from_part) {
    const Eigen::Vector3d way = now.world_from_part.translation_mm - recorded.world_from_part.translation_mm;
    const bool is_turned = now.world_from_part.rotation != recorded.world_from_part.rotation;
    add(fmt::format("moved by ({:.2f}, {:.2f}, {:.2f}) mm{}", way.x(), way.y(), way.z(),
                    is_turned ? " and turned" : ""));
  }
  if (!(now.recovery == recorded.recovery)) add("another recovery rule");
  if (!(now.gives_way == recorded.gives_way)) add("gives way in another manner");
  return what;
}

}  // namespace

ReplayLayout::ReplayLayout(const core::Layout& recorded, const ReplayChanges& changes)
    : layout_(changes.layout.value_or(recorded)) {
  for (const core::Spacing& spacing : layout_.spacings)
    spacings_.push_back({recorded.FindSpacing(spacing.name), 0.0, std::nullopt});
  Revise(changes.parts);
  layout_.Validate();
  for (core::Part& part : layout_.parts) {
    const auto index = recorded.FindPart(part.name);
    if (!index) {
      recorded_parts_.emplace_back();
      continue;
    }
    const bool has_same_mesh = HaveSameMesh(recorded.parts[*index], part);
    recorded_parts_.push_back(RecordedPart{*index, has_same_mesh});
  }
  if (changes.layout) TellDifferences(recorded);
  Hold(changes.held_mm);
}

void ReplayLayout::Revise(const std::vector<PartRevision>& parts) {
  const std::vector<double> initial_mm = layout_.InitialSpacings();
  const std::vector<core::RigidTransform> world_from_parts = core::PosesAt(layout_, initial_mm);
  for (const PartRevision& revision : parts) {
    core::Part& part = layout_.parts[RequirePart(layout_, revision.part)];
    if (*part.mesh == *revision.mesh) continue;
    changes_.push_back(fmt::format("part '{}': its shape is that of '{}' ({} triangles, {} before)",
                                   part.name, revision.file, revision.mesh->triangles.size(),
                                   part.mesh->triangles.size()));
    part.mesh = revision.mesh;
    part.file = revision.file;
    part.unit.reset();
    part.node.clear();
  }
  for (core::SpacingIndex i = 0; i < layout_.spacings.size(); ++i) {
    core::Spacing& spacing = layout_.spacings[i];
    const double shift_mm = core::GapMm(layout_, spacing, world_from_parts) - initial_mm[i];
    // Rounding of the extents' sums isn't a change.
    if (changes_.empty() || std::abs(shift_mm) < 1e-9) continue;
    spacings_[i].shift_mm = shift_mm;
    spacing.min_mm += shift_mm;
    spacing.max_mm += shift_mm;
    spacing.initial_mm = std::clamp(spacing.initial_mm + shift_mm, spacing.min_mm, spacing.max_mm);
    changes_.push_back(
        fmt::format("spacing '{}': {:+.3f} mm with the parts where they were, by their new extent",
                    spacing.name, shift_mm));
  }
}

void ReplayLayout::Hold(const std::map<std::string, double>& held_mm) {
  for (const auto& [name, value_mm] : held_mm) {
    const core::SpacingIndex index = core::RequireSpacing(layout_, name);
    const core::Spacing& spacing = layout_.spacings[index];
    if (!(value_mm >= spacing.min_mm && value_mm <= spacing.max_mm)) {
      throw core::Error(core::ErrorKind::kRange,
                        fmt::format("--spacing {}={}: its limits are {} to {} mm; choose a value within them",
                                    name, value_mm, spacing.min_mm, spacing.max_mm));
    }
    spacings_[index].held_mm = value_mm;
    changes_.push_back(fmt::format("spacing '{}': {} mm in all frames", name, value_mm));
  }
}

void ReplayLayout::TellDifferences(const core::Layout& recorded) {
  for (core::PartIndex i = 0; i < layout_.parts.size(); ++i) {
    const core::Part& part = layout_.parts[i];
    if (!recorded_parts_[i]) {
      changes_.push_back(fmt::format("part '{}': new", part.name));
      continue;
    }
    const std::string difference = DifferenceOf(recorded.parts[recorded_parts_[i]->part], part);
    if (!difference.empty()) changes_.push_back(fmt::format("part '{}': {}", part.name, difference));
  }
  for (const core::Part& part : recorded.parts)
    if (!layout_.FindPart(part.name)) changes_.push_back(fmt::format("part '{}': taken out", part.name));
  for (core::SpacingIndex i = 0; i < layout_.spacings.size(); ++i) {
    const core::Spacing& spacing = layout_.spacings[i];
    if (!spacings_[i].recorded) {
      changes_.push_back(
          fmt::format("spacing '{}': new, {} mm in all frames", spacing.name, spacing.initial_mm));
      continue;
    }
    const core::Spacing& before = recorded.spacings[*spacings_[i].recorded];
    if (spacing.moving != before.moving || spacing.reference != before.reference ||
        spacing.axis != before.axis)
      changes_.push_back(
          fmt::format("spacing '{}': between other parts, or along another axis", spacing.name));
    if (spacing.min_mm > before.min_mm || spacing.max_mm < before.max_mm)
      changes_.push_back(
          fmt::format("spacing '{}': narrower limits, {} to {} mm; values beyond them become these",
                      spacing.name, spacing.min_mm, spacing.max_mm));
  }
  for (const core::Spacing& spacing : recorded.spacings)
    if (!layout_.FindSpacing(spacing.name))
      changes_.push_back(fmt::format("spacing '{}': taken out", spacing.name));
  if (!(layout_.streams == recorded.streams)) changes_.emplace_back("other streams");
}

std::vector<double> ReplayLayout::SpacingsFrom(const std::vector<double>& recorded_mm) const {
  std::vector<double> spacing_mm;
  for (core::SpacingIndex i = 0; i < spacings_.size(); ++i) {
    const SpacingSource& source = spacings_[i];
    const core::Spacing& spacing = layout_.spacings[i];
    if (source.held_mm) {
      spacing_mm.push_back(*source.held_mm);
    } else if (source.recorded) {
      spacing_mm.push_back(
          std::clamp(recorded_mm[*source.recorded] + source.shift_mm, spacing.min_mm, spacing.max_mm));
    } else {
      spacing_mm.push_back(spacing.initial_mm);
    }
  }
  return spacing_mm;
}

core::SessionEvent ReplayLayout::EventFrom(const core::SessionEvent& recorded) const {
  const auto* change = std::get_if<core::SpacingChanged>(&recorded.what);
  if (change == nullptr) return recorded;
  core::SessionEvent event = recorded;
  const auto index = layout_.FindSpacing(change->spacing);
  if (!index || spacings_[*index].held_mm) {
    event.what = core::Note{fmt::format("in the session that was replayed: '{}' from {} to {} mm",
                                        change->spacing, change->from_mm, change->to_mm)};
    return event;
  }
  const core::Spacing& spacing = layout_.spacings[*index];
  const auto here = [&](double value_mm) {
    return std::clamp(value_mm + spacings_[*index].shift_mm, spacing.min_mm, spacing.max_mm);
  };
  event.what = core::SpacingChanged{change->spacing, here(change->from_mm), here(change->to_mm)};
  return event;
}

}  // namespace elbowroom::control
