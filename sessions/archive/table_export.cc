#include "sessions/archive/table_export.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "core/error.h"
#include "core/spelling.h"
#include "core/system/file_sync.h"
#include "core/system/whole_file.h"
#include "sessions/archive/table_rows.h"
#include "sessions/database/damage.h"
#include "sessions/report/markup.h"
#include "sessions/sound_session.h"
#include "sessions/tables/csv_text.h"

namespace elbowroom::sessions {
namespace {

std::string TextAt(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return AsUtf8(std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, column))));
}

std::string BytesAt(sqlite3_stmt* row, int column) {
  const auto* bytes = static_cast<const unsigned char*>(sqlite3_column_blob(row, column));
  return Base64(std::span(bytes, static_cast<std::size_t>(sqlite3_column_bytes(row, column))));
}

std::string JsonText(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string CsvField(sqlite3_stmt* row, int column) {
  switch (sqlite3_column_type(row, column)) {
    case SQLITE_INTEGER:
      return fmt::format("{}", sqlite3_column_int64(row, column));
    case SQLITE_FLOAT:
      return fmt::format("{}", sqlite3_column_double(row, column));
    case SQLITE_TEXT:
      return Quoted(TextAt(row, column));
    case SQLITE_BLOB:
      return BytesAt(row, column);
    default:
      return "";
  }
}

std::string JsonValue(sqlite3_stmt* row, int column) {
  switch (sqlite3_column_type(row, column)) {
    case SQLITE_INTEGER:
      return fmt::format("{}", sqlite3_column_int64(row, column));
    case SQLITE_FLOAT: {
      const double number = sqlite3_column_double(row, column);
      return std::isfinite(number) ? fmt::format("{}", number) : "null";
    }
    case SQLITE_TEXT:
      return JsonText(TextAt(row, column));
    case SQLITE_BLOB:
      return fmt::format("\"{}\"", BytesAt(row, column));
    default:
      return "null";
  }
}

// One table's two files.
class TableFiles {
 public:
  TableFiles(Database& database, const std::string& table, const std::filesystem::path& folder,
             core::PendingFiles* files)
      : columns_(ColumnsOf(database, table)),
        csv_(files->Begin(folder / (table + ".csv"))),
        json_(files->Begin(folder / (table + ".json"))) {
    std::string header;
    for (const std::string& column : columns_) {
      header += (header.empty() ? "" : ",") + column;
      keys_.push_back(JsonText(column) + ": ");
    }
    csv_.Append(header + "\n");
    json_.Append("[");
  }

  void Add(sqlite3_stmt* row) {
    std::string line, object = rows_++ == 0 ? "\n{" : ",\n{";
    for (int i = 0; i < static_cast<int>(columns_.size()); ++i) {
      if (i > 0) line += ',';
      if (i > 0) object += ", ";
      line += CsvField(row, i);
      object += keys_[static_cast<std::size_t>(i)] + JsonValue(row, i);
    }
    csv_.Append(line + "\n");
    json_.Append(object + "}");
  }

  void Close() {
    json_.Append("\n]\n");
    csv_.Close();
    json_.Close();
  }

  [[nodiscard]] std::int64_t rows() const { return rows_; }

 private:
  std::vector<std::string> columns_, keys_;
  core::PendingFile& csv_;
  core::PendingFile& json_;
  std::int64_t rows_ = 0;
};

void RequireKnown(const std::vector<std::string>& tables) {
  const std::vector<std::string> known = TablesAndViews();
  for (const std::string& table : tables) {
    if (std::ranges::find(known, table) != known.end()) continue;
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("--tables: a session has no table or view '{}'; {}", table,
                                  core::SpellingAdvice(table, known, "docs/session_database.md lists them")));
  }
}

}  // namespace

std::vector<ExportedTable> ExportTables(const std::filesystem::path& session, std::vector<std::string> tables,
                                        const std::filesystem::path& folder, const core::Progress& progress,
                                        const std::stop_token& stop) {
  RequireKnown(tables);
  if (tables.empty()) tables = TablesAndViews();
  SoundSession file(session, stop);
  core::MakeFolder(folder);
  core::PendingFiles files;
  std::vector<ExportedTable> exported;
  file.limit().Guarded([&] {
    file.database().Execute("BEGIN");  // all tables as they are at one moment
    for (const std::string& table : tables) {
      TableFiles out(file.database(), table, folder, &files);
      VisitRows(file.database(), table, [&](sqlite3_stmt* row) {
        out.Add(row);
        if (out.rows() % kRowsAReport != 0) return;
        core::ThrowIfStopped(stop, "the export");
        progress.Report(out.rows(), 0, "rows of " + table);
      });
      out.Close();
      exported.push_back({table, out.rows()});
    }
  });
  files.RenameAll();
  return exported;
}

}  // namespace elbowroom::sessions
