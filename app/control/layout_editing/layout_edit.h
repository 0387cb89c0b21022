// What the console and `elbowroom layout` do to the text of a LAYOUT.toml.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cad_import/layout/layout_text.h"
#include "core/layout.h"
#include "core/units.h"

namespace elbowroom::control {

// A member that is nothing or empty isn't written; an entry that is there already keeps its value.
struct PartEdit {
  std::filesystem::path file;
  std::string name;  // empty: the file's, with a number where that is taken
  std::string node;
  std::optional<core::LengthUnit> unit;
  std::optional<Eigen::Vector3d> position_mm;
  std::optional<Eigen::Vector3d> rotation_rpy_deg;
};
struct SpacingEdit {
  std::string name;
  std::optional<std::string> moving;
  std::optional<std::string> reference;
  std::optional<std::string> axis;
  std::optional<double> min_mm;
  std::optional<double> max_mm;
  std::optional<double> initial_mm;
};
struct PairEdit {
  std::string a;
  std::string b;
  std::optional<double> required_clearance_mm;
  std::optional<bool> authorised_contact;
  std::optional<bool> ignore;
};

// `wanted`, with a number where a part or group has that name.
[[nodiscard]] std::string FreePartName(const cad_import::LayoutText& text, const std::string& wanted);

// The path of the file relative to the layout's folder.
[[nodiscard]] std::string FileBeside(const std::filesystem::path& layout, const std::filesystem::path& file);

// Adds a part and returns its name. Its file is written relative to the layout's folder.
std::string AddPart(cad_import::LayoutText& text, const PartEdit& edit);

// Change the entry of that name (a pair: of the two, in either order), or add it. PutSpacing throws
// core::Error{kRange} for a new spacing that lacks a value.
void PutSpacing(cad_import::LayoutText& text, const SpacingEdit& edit);
void PutGroup(cad_import::LayoutText& text, const core::Group& group);
void PutPair(cad_import::LayoutText& text, const PairEdit& edit);

// All throw core::Error{kRange}, which names the layout's file, for a name or pair that it doesn't have;
// MovePart and RemoveNamed also name the nearest that it has. RemoveNamed throws too while other entries name
// the part or group, with the lines of these.
void MovePart(cad_import::LayoutText& text, const PartEdit& edit);
void RemoveNamed(cad_import::LayoutText& text, const std::string& name);
void RemovePair(cad_import::LayoutText& text, const PairEdit& edit);

// Gives a part another name, also where spacings, pairs and groups name it. Throws: Error{kRange} for a part
// that the layout doesn't have, or a name that a part or group has.
void RenamePart(cad_import::LayoutText& text, const std::string& from, const std::string& to);

// Removes a part or group together with the spacings and pairs that name it, and takes it out of groups; a
// group that has no part left goes likewise. Throws: as RemoveNamed for an unknown name.
void RemoveWithUsers(cad_import::LayoutText& text, const std::string& name);

}  // namespace elbowroom::control
