// CAP.toml, read and written.
#include <fmt/format.h>

#include <cmath>

#include "app/control/head/head_settings.h"
#include "cad_import/layout/toml_entry.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

using cad_import::TomlEntry;
using Eigen::Vector3d;

constexpr std::string_view kMarkerKeys[] = {"id", "side_mm", "position_mm", "normal", "up"};

Vector3d VectorOf(const TomlEntry& entry, std::string_view key) {
  const auto value = entry.Vector(key);
  if (!value) entry.Fail(key, "is missing; it must be [x, y, z]");
  return *value;
}

// Throws where a frame's two directions don't make one.
void NeedDirections(const TomlEntry& entry, std::string_view key, const Vector3d& a, const Vector3d& b) {
  if (!(a.cross(b).norm() > 1e-3 * a.norm() * b.norm()))
    entry.Fail(key, "must be a direction, and another one than the other direction there");
}

recon::CapMarker MarkerOf(const TomlEntry& entry) {
  const double id = entry.Number("id");
  if (!(id >= 0.0 && id < 1e6 && id == std::floor(id)))
    entry.Fail("id", "must be a whole number, the marker's in its dictionary");
  const Vector3d normal = VectorOf(entry, "normal"), up = VectorOf(entry, "up");
  NeedDirections(entry, "up", normal, up);
  return {static_cast<int>(id), entry.Number("side_mm"),
          recon::CapFromMarker(VectorOf(entry, "position_mm"), normal, up)};
}

std::string Triple(const Vector3d& v) {
  const auto shown = [](double value) { return std::abs(value) < 5e-6 ? 0.0 : value; };
  return fmt::format("[{:.5f}, {:.5f}, {:.5f}]", shown(v.x()), shown(v.y()), shown(v.z()));
}

}  // namespace

recon::Cap ReadCapFile(const std::filesystem::path& path) {
  const toml::table root = cad_import::ParseTomlFile(path, "cap file");
  const TomlEntry entry(root, path.string(), "",
                        {"name", "dictionary", "eyes_mm", "forward", "up", "place_sigma_mm", "marker"});
  recon::Cap cap;
  cap.name = entry.TextOr("name", path.stem().string());
  cap.dictionary = entry.Text("dictionary");
  cap.place_sigma_mm = entry.NumberOr("place_sigma_mm", cap.place_sigma_mm);
  if (!(cap.place_sigma_mm >= 0.0 && cap.place_sigma_mm <= 10.0))
    entry.Fail("place_sigma_mm", "must lie within [0, 10]");
  for (const TomlEntry& marker : entry.Entries("marker", kMarkerKeys))
    cap.markers.push_back(MarkerOf(marker));
  const Vector3d forward = entry.Vector("forward").value_or(Vector3d::UnitY());
  const Vector3d up = entry.Vector("up").value_or(Vector3d::UnitZ());
  NeedDirections(entry, "forward", forward, up);
  cap.cap_from_head = recon::CapFromHead(VectorOf(entry, "eyes_mm"), forward, up);
  try {
    cap.Validate();
  } catch (const core::Error& error) {
    throw core::Error(error.kind(), fmt::format("{}: {}", path.string(), error.what()));
  }
  return cap;
}

std::string CapFileText(const recon::Cap& cap) {
  const Eigen::Matrix3d& head = cap.cap_from_head.rotation;
  std::string text = fmt::format(
      "# The markers of a participant's cap (docs/head_pose.md). Lengths in mm, in the cap's own frame.\n"
      "name = \"{}\"\ndictionary = \"{}\"\n"
      "eyes_mm = {}  # the middle between the eyes\n"
      "forward = {}  # where the face looks\n"
      "up = {}       # where the crown of the head is\n"
      "place_sigma_mm = {}  # how exactly the markers are where this file says: a standard deviation\n",
      cap.name, cap.dictionary, Triple(cap.cap_from_head.translation_mm), Triple(head.col(2)),
      Triple(-head.col(1)), cap.place_sigma_mm);
  for (const recon::CapMarker& marker : cap.markers)
    text += fmt::format("\n[[marker]]\nid = {}\nside_mm = {}\nposition_mm = {}\nnormal = {}\nup = {}\n",
                        marker.id, marker.side_mm, Triple(marker.cap_from_marker.translation_mm),
                        Triple(marker.cap_from_marker.rotation.col(2)),
                        Triple(marker.cap_from_marker.rotation.col(1)));
  return text;
}

}  // namespace elbowroom::control
