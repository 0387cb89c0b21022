#include "sessions/tables/contacts_csv.h"

#include <fmt/format.h>

#include "sessions/tables/csv_text.h"

namespace elbowroom::sessions {
namespace {

std::string ContactHeader(const core::Layout& layout) {
  std::string line =
      "frame,time_s,part,contact_area_mm2,contact_points,depth_mm,deepest_x_mm,deepest_y_mm,deepest_z_mm,"
      "recovery_status,d_rec_mm,v_rec_x,v_rec_y,v_rec_z,cp_obj_x_mm,cp_obj_y_mm,cp_obj_z_mm,"
      "cp_hull_x_mm,cp_hull_y_mm,cp_hull_z_mm,n_hull_x,n_hull_y,n_hull_z";
  for (const core::Spacing& spacing : layout.spacings)
    line += ',' + Quoted("spacing " + spacing.name + " mm");
  return line + '\n';
}

}  // namespace

std::string ContactLine(const core::Layout& layout, const ContactRow& row) {
  using Point = std::optional<Eigen::Vector3d>;
  const core::PartContact& contact = row.contact;
  std::string line =
      fmt::format("{},{},{},{},{},", row.frame, row.time_s, Quoted(layout.parts[contact.part].name),
                  contact.contact_area_mm2, contact.contact_point_count);
  if (contact.deepest) line += fmt::format("{}", contact.deepest->depth_mm);
  AppendVector(line, contact.deepest ? Point(contact.deepest->position_in_world_mm) : Point());
  line += fmt::format(",{},", core::ToString(contact.recovery_status));
  if (contact.recovery) line += fmt::format("{}", contact.recovery->d_rec_mm);
  AppendVector(line, contact.recovery ? Point(contact.recovery->v_rec_in_world) : Point());
  AppendVector(line, contact.recovery ? Point(contact.recovery->cp_obj_in_world_mm) : Point());
  AppendVector(line, contact.recovery ? Point(contact.recovery->cp_hull_in_world_mm) : Point());
  AppendVector(line, contact.recovery ? contact.recovery->n_hull_in_world : Point());
  for (const double spacing_mm : row.spacing_mm) line += fmt::format(",{}", spacing_mm);
  return line + '\n';
}

std::string ContactsCsv(const core::Layout& layout, std::span<const ContactRow> rows) {
  std::string csv = ContactHeader(layout);
  for (const ContactRow& row : rows) csv += ContactLine(layout, row);
  return csv;
}

}  // namespace elbowroom::sessions
