#include "sessions/recorded_contacts.h"

#include <fmt/format.h>

#include <array>
#include <limits>

#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

// The columns that ReadContact reads, in its order; `contact` and `clearance` may be missing (outer joins).
constexpr const char* kContactColumns =
    "pf.part_index, pf.verdict, pf.resolution_mm, pf.triangles, pf.queries, pf.skipped, "
    "c.recovery_status, c.contact_area_mm2, c.contact_point_count, "
    "c.deepest_depth_mm, c.deepest_area_mm2, c.deepest_x_mm, c.deepest_y_mm, c.deepest_z_mm, "
    "c.d_rec_mm, c.cp_obj_x_mm, c.cp_obj_y_mm, c.cp_obj_z_mm, c.cp_hull_x_mm, c.cp_hull_y_mm, "
    "c.cp_hull_z_mm, "
    "c.v_rec_x, c.v_rec_y, c.v_rec_z, c.n_hull_x, c.n_hull_y, c.n_hull_z, c.recovery_angle_rad, "
    "cl.queries, cl.lower_mm, cl.upper_mm, cl.part_x_mm, cl.part_y_mm, cl.part_z_mm, "
    "cl.hull_x_mm, cl.hull_y_mm, cl.hull_z_mm, "
    "cl.calibration_mm, cl.footprint_mm, cl.segmentation_mm, cl.skew_mm, cl.given_mm";
constexpr int kContactColumnCount = 42;
constexpr const char* kContactTables =
    "part_frame pf LEFT JOIN contact c USING (frame_index, part_index) "
    "LEFT JOIN clearance cl USING (frame_index, part_index)";

std::string FrameOf(const Database& database, core::FrameIndex frame) {
  return fmt::format("session '{}', frame {}", database.path().string(), frame);
}

[[noreturn]] void FailAsUnknown(const std::string& where, const char* what, const std::string& text) {
  FailAsDamaged(where, fmt::format("no {} is called '{}'", what, Quotable(text)));
}

core::Recovery ReadRecovery(const Statement& row, const std::string& where) {
  core::Recovery recovery;
  recovery.d_rec_mm = Magnitude(row.Real(14), where, "a recovery's length");
  recovery.cp_obj_in_world_mm = Position(row.Vector(15), where, "CP_obj");
  recovery.cp_hull_in_world_mm = Position(row.Vector(18), where, "CP_hull");
  recovery.v_rec_in_world = row.Vector(21);
  if (!row.IsNull(24)) recovery.n_hull_in_world = row.Vector(24);
  if (!row.IsNull(27)) recovery.angle_rad = row.Real(27);
  return recovery;
}

core::ErrorBudget ReadBudget(const Statement& row, int first_column, const std::string& where) {
  const auto sigma_mm = [&](int column) {
    return Magnitude(row.Real(first_column + column), where, "what a verdict allows for");
  };
  // Files of schema 7 have no fifth.
  return {sigma_mm(0), sigma_mm(1), sigma_mm(2), sigma_mm(3),
          row.IsNull(first_column + 4) ? 0.0 : sigma_mm(4)};
}

core::PartClearance ReadClearance(const Statement& row, const std::string& where) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  core::PartClearance clearance;
  clearance.queries = row.Integer(28);
  const auto bound_mm = [&](int column) {
    return row.IsNull(column) ? kInfinity : Magnitude(row.Real(column), where, "a clearance");
  };
  clearance.interval.lower_mm = bound_mm(29);
  clearance.interval.upper_mm = bound_mm(30);
  clearance.has_witnesses = !row.IsNull(31);
  if (clearance.has_witnesses) {
    clearance.interval.witness_part_in_world_mm = Position(row.Vector(31), where, "a witness point");
    clearance.interval.witness_hull_in_world_mm = Position(row.Vector(34), where, "a witness point");
  }
  if (!row.IsNull(37)) {
    clearance.budget = ReadBudget(row, 37, where);
  }
  return clearance;
}

// Reads everything but the index of the part.
core::PartContact ReadContact(const Statement& row, const std::string& where) {
  core::PartContact contact;
  const auto verdict = core::ParseVerdict(row.Text(1));
  if (!verdict) FailAsUnknown(where, "verdict", row.Text(1));
  contact.verdict = *verdict;
  contact.resolution_mm = row.Real(2);
  contact.count = {row.Integer(3), row.Integer(4), row.Integer(5)};
  if (!row.IsNull(28)) contact.clearance = ReadClearance(row, where);
  if (row.IsNull(6)) {
    if (contact.verdict == core::Verdict::kContact)
      FailAsDamaged(where, "the evidence of a contact is missing");
    return contact;
  }
  const auto recovery_status = core::ParseRecoveryStatus(row.Text(6));
  if (!recovery_status) FailAsUnknown(where, "recovery status", row.Text(6));
  contact.recovery_status = *recovery_status;
  contact.contact_area_mm2 = Magnitude(row.Real(7), where, "a contact's area");
  contact.contact_point_count = CountFrom(0, row.Integer(8), where, "a number of points");
  if (!row.IsNull(9)) {
    contact.deepest = core::ContactPoint{Position(row.Vector(11), where, "a contact"),
                                         Magnitude(row.Real(9), where, "a contact's depth"),
                                         Magnitude(row.Real(10), where, "a contact's area")};
  }
  if (!row.IsNull(14)) contact.recovery = ReadRecovery(row, where);
  return contact;
}

void ReadPoints(Database& database, core::FrameIndex frame, const std::string& where,
                core::PartContact& contact) {
  Statement rows(database,
                 "SELECT depth_mm, area_mm2, x_mm, y_mm, z_mm FROM contact_point "
                 "WHERE frame_index = ? AND part_index = ? ORDER BY point_index");
  for (rows.With(frame, contact.part); rows.Next();) {
    contact.points.push_back({Position(rows.Vector(2), where, "a contact"),
                              Magnitude(rows.Real(0), where, "a contact's depth"),
                              Magnitude(rows.Real(1), where, "a contact's area")});
  }
}

void Add(std::int64_t count, const std::string& where, std::int64_t* sum) {
  if (__builtin_add_overflow(*sum, count, sum)) FailAsDamaged(where, "its counts are too large");
}

std::vector<double> ReadSpacings(Statement& rows, const core::Layout& layout, core::FrameIndex frame,
                                 const std::string& where) {
  std::vector<double> spacing_mm;
  for (rows.With(frame); rows.Next();) {
    RequireInTurn(rows.Integer(0), spacing_mm.size(), where, "spacing");
    spacing_mm.push_back(GapMm(rows.Real(1), where, "a spacing"));
  }
  if (spacing_mm.size() != layout.spacings.size()) FailAsDamaged(where, "rows of spacings are missing");
  return spacing_mm;
}

}  // namespace

void VisitRows(Database& database, const core::Layout& layout, const RowVisitor& on_contact,
               const RowVisitor& on_clearance) {
  const char* condition = !on_clearance ? "pf.verdict = 'contact'"
                          : !on_contact ? "cl.queries IS NOT NULL"
                                        : "(pf.verdict = 'contact' OR cl.queries IS NOT NULL)";
  Statement rows(database,
                 fmt::format("SELECT {}, f.frame_index, f.time_s FROM {} JOIN frame f USING (frame_index) "
                             "WHERE {} ORDER BY pf.frame_index, pf.part_index",
                             kContactColumns, kContactTables, condition));
  Statement spacings(
      database,
      "SELECT spacing_index, spacing_mm FROM frame_spacing WHERE frame_index = ? ORDER BY spacing_index");
  ContactRow row;
  row.frame = -1;
  std::string where;
  while (rows.Next()) {
    if (const core::FrameIndex frame = rows.Integer(kContactColumnCount); frame != row.frame) {
      row.frame = frame;
      where = FrameOf(database, frame);
      row.spacing_mm = ReadSpacings(spacings, layout, frame, where);
    }
    row.time_s = Time_s(rows.Real(kContactColumnCount + 1), where, "its time");
    row.contact = ReadContact(rows, where);
    row.contact.part = IndexBelow(rows.Integer(0), layout.parts.size(), where, "part");
    if (on_contact && row.contact.verdict == core::Verdict::kContact) on_contact(row);
    if (on_clearance && row.contact.clearance) on_clearance(row);
  }
}

std::vector<core::PartContact> ReadContacts(Database& database, std::size_t parts, core::FrameIndex frame) {
  const std::string where = FrameOf(database, frame);
  Statement rows(database, fmt::format("SELECT {} FROM {} WHERE pf.frame_index = ? ORDER BY pf.part_index",
                                       kContactColumns, kContactTables));
  std::vector<core::PartContact> contacts;
  for (rows.With(frame); rows.Next();) {
    RequireInTurn(rows.Integer(0), contacts.size(), where, "part");
    contacts.push_back(ReadContact(rows, where));
    contacts.back().part = IndexBelow(rows.Integer(0), parts, where, "part");
  }
  for (core::PartContact& contact : contacts) ReadPoints(database, frame, where, contact);
  return contacts;
}

std::vector<PartTotals> ReadPartTotals(Database& database, const core::Layout& layout) {
  // Counts as the view v_part does, but reads the table: a table holds only what the file's pages hold.
  // Grouped by SQLite, the rows would be sorted first, on disk.
  Statement rows(database,
                 "SELECT part_index, verdict = 'contact', verdict = 'near', verdict = 'undecided', "
                 "verdict = 'clear', triangles, queries, skipped FROM part_frame");
  const std::string where = fmt::format("session '{}'", database.path().string());
  std::vector<PartTotals> totals(layout.parts.size());
  for (core::PartIndex i = 0; i < totals.size(); ++i) totals[i].part = i;
  while (rows.Next()) {
    PartTotals& part = totals[IndexBelow(rows.Integer(0), totals.size(), where, "part")];
    part.frames_in_contact += rows.Integer(1);
    part.frames_near += rows.Integer(2);
    part.frames_undecided += rows.Integer(3);
    part.frames_clear += rows.Integer(4);
    Add(rows.Integer(5), where, &part.count.triangles);
    Add(rows.Integer(6), where, &part.count.queries);
    Add(rows.Integer(7), where, &part.count.skipped);
  }
  return totals;
}

std::vector<PartBudget> ReadPartBudgets(Database& database, const core::Layout& layout) {
  // SQLite takes the columns beside max() from the row in which the largest is.
  Statement rows(
      database,
      "SELECT part_index, calibration_mm, footprint_mm, segmentation_mm, skew_mm, given_mm, "
      "max(calibration_mm * calibration_mm + footprint_mm * footprint_mm "
      "+ segmentation_mm * segmentation_mm + skew_mm * skew_mm + coalesce(given_mm * given_mm, 0)) "
      "FROM clearance WHERE calibration_mm IS NOT NULL GROUP BY part_index");
  const std::string where = fmt::format("session '{}'", database.path().string());
  std::vector<PartBudget> budgets;
  while (rows.Next())
    budgets.push_back(
        {IndexBelow(rows.Integer(0), layout.parts.size(), where, "part"), ReadBudget(rows, 1, where)});
  return budgets;
}

}  // namespace elbowroom::sessions
