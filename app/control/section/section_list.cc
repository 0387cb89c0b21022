#include "app/control/section/section_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/units.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

// A cosine or sine that is this small is one of a right angle, rounded.
constexpr double kRightAngle = 1e-15;
constexpr double kBesideFaceMm = 1e-3;

double Clean(double value) { return std::abs(value) < kRightAngle ? 0.0 : value; }

}  // namespace

recon::HalfSpace HalfSpaceOf(const Section& section) {
  return {section.normal.normalized(), section.offset_mm};
}

SectionCut CutOf(std::span<const Section> sections) {
  SectionCut cut;
  for (const Section& section : sections)
    if (section.is_on) cut.kept.push_back(HalfSpaceOf(section));
  return cut;
}

PlaneAngles AnglesOf(const Vector3d& normal) {
  const double across = normal.head<2>().norm();
  PlaneAngles angles;
  if (across > 1e-12 * normal.norm())
    angles.azimuth_deg = core::DegreesFromRadians(std::atan2(normal.y(), normal.x()));
  if (angles.azimuth_deg == -180.0) angles.azimuth_deg = 180.0;
  angles.elevation_deg = core::DegreesFromRadians(std::atan2(normal.z(), across));
  return angles;
}

Vector3d NormalAt(const PlaneAngles& angles) {
  const double azimuth = core::RadiansFromDegrees(angles.azimuth_deg);
  const double elevation = core::RadiansFromDegrees(angles.elevation_deg);
  const double across = Clean(std::cos(elevation));
  return Vector3d(across * Clean(std::cos(azimuth)), across * Clean(std::sin(azimuth)),
                  Clean(std::sin(elevation)))
      .normalized();
}

Section Flipped(Section section) {
  section.normal = Vector3d::Zero() - section.normal;  // no -0
  section.offset_mm = 0.0 - section.offset_mm;
  return section;
}

Section TurnedThrough(Section section, const Vector3d& normal, const Vector3d& x_in_world) {
  section.normal = normal.normalized();
  section.offset_mm = section.normal.dot(x_in_world);
  return section;
}

Section AlignedTo(Section section, const Vector3d& face_normal, const Vector3d& x_in_world) {
  section = TurnedThrough(std::move(section), face_normal, x_in_world);
  for (double& coordinate : section.normal) coordinate = std::abs(coordinate) < 1e-9 ? 0.0 : coordinate;
  section.normal.normalize();
  section.offset_mm = std::ceil(section.offset_mm / kBesideFaceMm - 1e-6) * kBesideFaceMm;
  return section;
}

std::vector<Vector3d> OutlineIn(const recon::HalfSpace& half_space, const Eigen::AlignedBox3d& box_in_world) {
  std::vector<Vector3d> corners;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 8; ++i) {
      if ((i >> axis & 1) != 0) continue;
      const Vector3d a = box_in_world.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
      const Vector3d b = box_in_world.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i | 1 << axis));
      const double at_a = half_space.BeyondMm(a), at_b = half_space.BeyondMm(b);
      if ((at_a > 0.0) == (at_b > 0.0)) continue;
      corners.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
  }
  if (corners.size() < 3) return {};
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& corner : corners) middle += corner / static_cast<double>(corners.size());
  const Vector3d u = half_space.outward.unitOrthogonal(), v = half_space.outward.cross(u);
  std::ranges::sort(corners, {}, [&](const Vector3d& corner) {
    return std::atan2(v.dot(corner - middle), u.dot(corner - middle));
  });
  return corners;
}

std::string FreeSectionName(std::span<const Section> sections, const std::string& wanted) {
  std::string name = wanted;
  for (int i = 2; std::ranges::find(sections, name, &Section::name) != sections.end(); ++i)
    name = fmt::format("{} {}", wanted, i);
  return name;
}

std::string TextOf(const std::vector<Section>& sections) {
  cad_import::LayoutText text;
  cad_import::ChangeSections(text, sections);
  return text.text();
}

std::vector<Section> SectionsFrom(const std::string& text) {
  try {
    return cad_import::SectionsOf(cad_import::LayoutText(text));
  } catch (const core::Error&) {  // of another version
    return {};
  }
}

SectionList::SectionList(std::vector<Section> first) : history_(State{std::move(first), {}}) {}

void SectionList::Change(std::vector<Section> next, const std::string& merge_key) {
  const bool is_merged =
      may_merge_ && !merge_key.empty() && history_.CanUndo() && history_.now().merge_key == merge_key;
  history_ = (is_merged ? history_.Undone() : history_).Changed({std::move(next), merge_key});
  may_merge_ = true;
}

void SectionList::Undo() {
  history_ = history_.Undone();
  may_merge_ = false;
}

void SectionList::Redo() {
  history_ = history_.Redone();
  may_merge_ = false;
}

}  // namespace elbowroom::control
