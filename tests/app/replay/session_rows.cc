#include "tests/app/replay/session_rows.h"

#include <SQLiteCpp/SQLiteCpp.h>

namespace elbowroom::control {
namespace {

// Masks have numbers of their own in each file.
std::string RowsOf(const std::string& schema, const std::string& table) {
  if (table != "silhouette") return "SELECT * FROM " + schema + "." + table;
  return "SELECT s.frame_index, s.camera_index, m.content_hash FROM " + schema + ".silhouette s JOIN " +
         schema + ".mask m USING (mask_id)";
}

}  // namespace

std::int64_t RowsThatDiffer(const std::filesystem::path& recorded, const std::filesystem::path& replayed,
                            const std::string& where) {
  SQLite::Database database(recorded.string(), SQLite::OPEN_READWRITE);
  database.exec("ATTACH '" + replayed.string() + "' AS other");
  std::int64_t differing = 0;
  for (const std::string table : {"frame", "frame_spacing", "part_frame", "contact", "contact_point",
                                  "clearance", "part_motion", "camera_stamp", "silhouette"}) {
    const std::string of_first = RowsOf("main", table) + " WHERE " + where;
    const std::string of_other = RowsOf("other", table);
    for (const std::string& query : {of_first + " EXCEPT " + of_other, of_other + " EXCEPT " + of_first}) {
      SQLite::Statement rows(database, "SELECT count(*) FROM (" + query + ")");
      if (rows.executeStep()) differing += rows.getColumn(0).getInt64();
    }
  }
  return differing;
}

}  // namespace elbowroom::control
