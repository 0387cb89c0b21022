#include "sessions/contact_rows.h"

#include <fmt/format.h>

#include <array>
#include <limits>

#include "core/error.h"
#include "sessions/statement.h"

namespace elbowroom::sessions {
namespace {

using core::Error;
using core::ErrorKind;

// The columns that ReadContact reads, in its order; `contact` and `clearance` may be missing (outer joins).
constexpr const char* kContactColumns =
    "pf.part_index, pf.verdict, pf.resolution_mm, pf.triangles, pf.queries, pf.skipped, "
    "c.recovery_status, c.contact_area_mm2, c.contact_point_count, "
    "c.deepest_depth_mm, c.deepest_area_mm2, c.deepest_x_mm, c.deepest_y_mm, c.deepest_z_mm, "
    "c.d_rec_mm, c.cp_obj_x_mm, c.cp_obj_y_mm, c.cp_obj_z_mm, c.cp_hull_x_mm, c.cp_hull_y_mm, "
    "c.cp_hull_z_mm, "
    "c.v_rec_x, c.v_rec_y, c.v_rec_z, c.n_hull_x, c.n_hull_y, c.n_hull_z, c.recovery_angle_rad, "
    "cl.queries, cl.lower_mm, cl.upper_mm, cl.part_x_mm, cl.part_y_mm, cl.part_z_mm, "
    "cl.hull_x_mm, cl.hull_y_mm, cl.hull_z_mm";
constexpr int kContactColumnCount = 37;
constexpr const char* kContactTables =
    "part_frame pf LEFT JOIN contact c USING (frame_index, part_index) "
    "LEFT JOIN clearance cl USING (frame_index, part_index)";

[[noreturn]] void FailAsUnknown(const Database& database, const std::string& what, const std::string& text) {
  throw Error(ErrorKind::kFormat,
              fmt::format("session '{}': no {} is called '{}'; restore the file from a copy",
                          database.path().string(), what, text));
}

core::Recovery ReadRecovery(const Statement& row) {
  core::Recovery recovery;
  recovery.d_rec_mm = row.Real(14);
  recovery.cp_obj_in_world_mm = row.Vector(15);
  recovery.cp_hull_in_world_mm = row.Vector(18);
  recovery.v_rec_in_world = row.Vector(21);
  if (!row.IsNull(24)) recovery.n_hull_in_world = row.Vector(24);
  if (!row.IsNull(27)) recovery.angle_rad = row.Real(27);
  return recovery;
}

core::PartClearance ReadClearance(const Statement& row) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  core::PartClearance clearance;
  clearance.queries = row.Integer(28);
  clearance.interval.lower_mm = row.IsNull(29) ? kInfinity : row.Real(29);
  clearance.interval.upper_mm = row.IsNull(30) ? kInfinity : row.Real(30);
  clearance.has_witnesses = !row.IsNull(31);
  if (clearance.has_witnesses) {
    clearance.interval.witness_part_in_world_mm = row.Vector(31);
    clearance.interval.witness_hull_in_world_mm = row.Vector(34);
  }
  return clearance;
}

core::PartContact ReadContact(const Statement& row, const Database& database) {
  core::PartContact contact;
  contact.part = static_cast<core::PartIndex>(row.Integer(0));
  const auto verdict = core::ParseVerdict(row.Text(1));
  if (!verdict) FailAsUnknown(database, "verdict", row.Text(1));
  contact.verdict = *verdict;
  contact.resolution_mm = row.Real(2);
  contact.count = {row.Integer(3), row.Integer(4), row.Integer(5)};
  if (!row.IsNull(28)) contact.clearance = ReadClearance(row);
  if (row.IsNull(6)) return contact;
  const auto recovery_status = core::ParseRecoveryStatus(row.Text(6));
  if (!recovery_status) FailAsUnknown(database, "recovery status", row.Text(6));
  contact.recovery_status = *recovery_status;
  contact.contact_area_mm2 = row.Real(7);
  contact.contact_point_count = row.Integer(8);
  if (!row.IsNull(9)) contact.deepest = core::ContactPoint{row.Vector(11), row.Real(9), row.Real(10)};
  if (!row.IsNull(14)) contact.recovery = ReadRecovery(row);
  return contact;
}

void ReadPoints(Database& database, core::FrameIndex frame, core::PartContact& contact) {
  Statement rows(database,
                 "SELECT depth_mm, area_mm2, x_mm, y_mm, z_mm FROM contact_point "
                 "WHERE frame_index = ? AND part_index = ? ORDER BY point_index");
  for (rows.With(frame, contact.part); rows.Next();) {
    contact.points.push_back({rows.Vector(2), rows.Real(0), rows.Real(1)});
  }
}

std::vector<ContactRow> ReadRowsWhere(Database& database, const char* condition) {
  Statement rows(database,
                 fmt::format("SELECT {}, f.frame_index, f.time_s FROM {} JOIN frame f USING (frame_index) "
                             "WHERE {} ORDER BY f.frame_index, pf.part_index",
                             kContactColumns, kContactTables, condition));
  Statement spacings(database,
                     "SELECT spacing_mm FROM frame_spacing WHERE frame_index = ? ORDER BY spacing_index");
  std::vector<ContactRow> result;
  while (rows.Next()) {
    ContactRow row;
    row.frame = rows.Integer(kContactColumnCount);
    row.time_s = rows.Real(kContactColumnCount + 1);
    for (spacings.With(row.frame); spacings.Next();) row.spacing_mm.push_back(spacings.Real(0));
    row.contact = ReadContact(rows, database);
    result.push_back(std::move(row));
  }
  return result;
}

}  // namespace

std::vector<core::PartContact> ReadContacts(Database& database, core::FrameIndex frame) {
  Statement rows(database, fmt::format("SELECT {} FROM {} WHERE pf.frame_index = ? ORDER BY pf.part_index",
                                       kContactColumns, kContactTables));
  std::vector<core::PartContact> contacts;
  for (rows.With(frame); rows.Next();) contacts.push_back(ReadContact(rows, database));
  for (core::PartContact& contact : contacts) ReadPoints(database, frame, contact);
  return contacts;
}

std::vector<ContactRow> ReadContactRows(Database& database) {
  return ReadRowsWhere(database, "pf.verdict = 'contact'");
}
std::vector<ContactRow> ReadClearanceRows(Database& database) {
  return ReadRowsWhere(database, "cl.queries IS NOT NULL");
}

std::vector<PartTotals> ReadPartTotals(Database& database) {
  Statement rows(
      database,
      "SELECT part_index, frames_in_contact, frames_near, frames_undecided, frames_clear FROM v_part "
      "ORDER BY part_index");
  std::vector<PartTotals> totals;
  while (rows.Next()) {
    totals.push_back({static_cast<core::PartIndex>(rows.Integer(0)), rows.Integer(1), rows.Integer(2),
                      rows.Integer(3), rows.Integer(4)});
  }
  return totals;
}

}  // namespace elbowroom::sessions
