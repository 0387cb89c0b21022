// What a replay changes: the layout that it judges against, and the spacings in each frame.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/layout.h"
#include "core/session.h"

namespace elbowroom::control {

// Another revision of a part's CAD.
struct PartRevision {
  std::string part;  // its name in the layout
  std::string file;  // as given
  core::SharedMesh mesh;
};

struct ReplayChanges {
  std::optional<core::Layout> layout = {};  // nothing: the recorded one
  std::vector<PartRevision> parts = {};
  std::map<std::string, double> held_mm = {};  // spacings, by name, that have one value in all frames
};

// Immutable. Thread: any.
class ReplayLayout {
 public:
  // Parts and spacings of both layouts are matched by name. A revised part keeps its poses, so that spacings
  // against it shift by what its extent changed, limits included. Throws: core::Error{kRange}: a name that
  // the layout doesn't have, a value beyond its spacing's limits; what Layout::Validate throws.
  ReplayLayout(const core::Layout& recorded, const ReplayChanges& changes);

  [[nodiscard]] const core::Layout& layout() const { return layout_; }
  // In words, a line each; empty: everything is as it was recorded.
  [[nodiscard]] const std::vector<std::string>& changes() const { return changes_; }

  // What spacings of the layout have in a frame with these recorded values: in the layouts' orders. A
  // recorded value beyond the new limits becomes the nearest one within them.
  [[nodiscard]] std::vector<double> SpacingsFrom(const std::vector<double>& recorded_mm) const;

  // The event in terms of the layout; a change of a spacing that is held, or that the layout doesn't have,
  // becomes a note.
  [[nodiscard]] core::SessionEvent EventFrom(const core::SessionEvent& recorded) const;

  // The recorded part of that name. `has_same_mesh`: what was found of it holds for this one, too.
  struct RecordedPart {
    core::PartIndex part = 0;
    bool has_same_mesh = false;
  };
  [[nodiscard]] const std::optional<RecordedPart>& RecordedOf(core::PartIndex part) const {
    return recorded_parts_[part];
  }

 private:
  struct SpacingSource {
    std::optional<core::SpacingIndex> recorded;  // by name; nothing: the layout's initial value
    double shift_mm = 0.0;                       // from the recorded value
    std::optional<double> held_mm;
  };

  void Revise(const std::vector<PartRevision>& parts);
  void Hold(const std::map<std::string, double>& held_mm);
  void TellDifferences(const core::Layout& recorded);

  core::Layout layout_;
  std::vector<SpacingSource> spacings_;                      // the layout's order
  std::vector<std::optional<RecordedPart>> recorded_parts_;  // likewise
  std::vector<std::string> changes_;
};

}  // namespace elbowroom::control
