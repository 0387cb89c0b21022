// Named section planes while somebody changes them, with every step back.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "app/control/section/section_cut.h"
#include "cad_import/layout/layout_sections.h"
#include "core/history.h"

namespace elbowroom::control {

using Section = cad_import::LayoutSection;
inline constexpr std::size_t kMostSections = cad_import::kMostSections;

[[nodiscard]] recon::HalfSpace HalfSpaceOf(const Section& section);
// By those that are on.
[[nodiscard]] SectionCut CutOf(std::span<const Section> sections);

// Where a plane's normal points: about world z from world x, and above the table's plane.
struct PlaneAngles {
  double azimuth_deg = 0.0;    // (-180, 180]; 0 where the normal is upright
  double elevation_deg = 0.0;  // [-90, 90]
};
[[nodiscard]] PlaneAngles AnglesOf(const Eigen::Vector3d& normal);
[[nodiscard]] Eigen::Vector3d NormalAt(const PlaneAngles& angles);  // unit; exact along world's axes

// The same plane, and what lies on its other side.
[[nodiscard]] Section Flipped(Section section);
// With that normal, through that point.
[[nodiscard]] Section TurnedThrough(Section section, const Eigen::Vector3d& normal,
                                    const Eigen::Vector3d& x_in_world);
// On a face whose corners are rounded: up to a micrometre outside of it, so that it cuts nothing off.
[[nodiscard]] Section AlignedTo(Section section, const Eigen::Vector3d& face_normal,
                                const Eigen::Vector3d& x_in_world);

// Where the plane meets the box: a convex polygon, counter-clockwise seen against the normal. Empty where it
// doesn't.
[[nodiscard]] std::vector<Eigen::Vector3d> OutlineIn(const recon::HalfSpace& half_space,
                                                     const Eigen::AlignedBox3d& box_in_world);

// `wanted`, or that with the first number that no section has.
[[nodiscard]] std::string FreeSectionName(std::span<const Section> sections, const std::string& wanted);

// As the text of a layout file has them, for settings. A text that can't be read has none.
[[nodiscard]] std::string TextOf(const std::vector<Section>& sections);
[[nodiscard]] std::vector<Section> SectionsFrom(const std::string& text);

class SectionList {
 public:
  explicit SectionList(std::vector<Section> first = {});

  [[nodiscard]] const std::vector<Section>& now() const { return history_.now().sections; }
  // Changes with the same `merge_key`, one after the other, are one step back, up to EndStep(); an empty key
  // is never merged.
  void Change(std::vector<Section> next, const std::string& merge_key = {});
  void EndStep() { may_merge_ = false; }

  [[nodiscard]] bool CanUndo() const { return history_.CanUndo(); }
  [[nodiscard]] bool CanRedo() const { return history_.CanRedo(); }
  void Undo();
  void Redo();

 private:
  struct State {
    std::vector<Section> sections;
    std::string merge_key;
    [[nodiscard]] bool operator==(const State& other) const { return sections == other.sections; }
  };
  core::History<State> history_;
  bool may_merge_ = false;
};

}  // namespace elbowroom::control
