#include "sessions/schema/schema_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "core/error.h"
#include "core/spelling.h"
#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/schema/schema.h"

namespace elbowroom::sessions {
namespace {

struct Entry {
  std::string type;
  std::string name;
  std::string table;
  std::optional<std::string> sql;
};

// Entries that SQLite makes itself, such as the index of a primary key, have names of its own and no SQL.
bool IsOfSqlite(const Entry& entry) { return entry.name.starts_with("sqlite_"); }

std::vector<Entry> EntriesOf(Database& database) {
  Statement rows(database, "SELECT type, name, tbl_name, sql FROM sqlite_schema ORDER BY rowid");
  std::vector<Entry> entries;
  while (rows.Next()) {
    entries.push_back({rows.Text(0), rows.Text(1), rows.Text(2),
                       rows.IsNull(3) ? std::nullopt : std::optional(rows.Text(3))});
  }
  return entries;
}

std::vector<Entry> EntriesOfSchema(std::int64_t schema) {
  Database fresh = Database::InMemory("the schema");
  MigrateTo(fresh, schema);
  return EntriesOf(fresh);
}

std::vector<std::string> NamesOfSchema(std::int64_t schema, std::string_view type) {
  std::vector<std::string> names;
  for (const Entry& entry : EntriesOfSchema(schema))
    if (entry.type == type && !IsOfSqlite(entry)) names.push_back(entry.name);
  return names;
}

// The SQL in a form that is the same for all versions of SQLite, and after a dump was read back.
std::string Essence(const std::string& sql) {
  std::string essence;
  for (const char c : sql) {
    if (c == '"') continue;
    const bool is_space = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (is_space && (essence.empty() || essence.back() == ' ')) continue;
    essence += is_space ? ' ' : c;
  }
  constexpr std::string_view kIfMissing = "CREATE TABLE IF NOT EXISTS ";
  if (essence.starts_with(kIfMissing)) essence = "CREATE TABLE " + essence.substr(kIfMissing.size());
  return essence;
}

// Whether it is an index of columns alone. Checking an index evaluates its expressions, which may take for
// ever.
bool IsPlainIndex(const Entry& entry) {
  const std::string essence = Essence(entry.sql.value_or(""));
  return std::ranges::count(essence, '(') == 1 && essence.ends_with(')');
}

std::string Quoted(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

}  // namespace

std::vector<std::string> TablesOfSchema(std::int64_t schema) { return NamesOfSchema(schema, "table"); }
std::vector<std::string> ViewsOfSchema(std::int64_t schema) { return NamesOfSchema(schema, "view"); }

void RequireTablesOfSchema(Database& database, std::int64_t schema) {
  const std::string where = fmt::format("session '{}'", database.path().string());
  std::map<std::string, Entry> found;
  // SQLite doesn't distinguish upper and lower case in names.
  for (Entry& entry : EntriesOf(database)) found.emplace(core::LowerCase(entry.name), std::move(entry));
  std::set<std::string> tables;
  for (const Entry& wanted : EntriesOfSchema(schema)) {
    if (IsOfSqlite(wanted)) continue;
    tables.insert(wanted.name);
    const auto entry = found.find(wanted.name);
    if (entry == found.end())
      FailAsDamaged(where, fmt::format("its {} '{}' is missing", wanted.type, wanted.name));
    if (entry->second.type != wanted.type || !entry->second.sql ||
        Essence(*entry->second.sql) != Essence(wanted.sql.value_or(""))) {
      FailAsDamaged(where, fmt::format("its {} '{}' isn't the {} that schema {} has", entry->second.type,
                                       wanted.name, wanted.type, schema));
    }
  }
  for (const auto& [name, entry] : found) {
    if (entry.type == "index" && !IsOfSqlite(entry) && !IsPlainIndex(entry))
      throw core::Error(
          core::ErrorKind::kFormat,
          fmt::format("{}: its index '{}' is one of expressions, which may take for ever to check; "
                      "drop it with DROP INDEX in the sqlite3 shell",
                      where, Quotable(entry.name)));
    if (entry.type == "trigger" && tables.contains(core::LowerCase(entry.table)))
      FailAsDamaged(where, fmt::format("it has a trigger, '{}', which no schema has", Quotable(entry.name)));
  }
}

void DropAllButTablesOfSchema(Database& copy, std::int64_t schema) {
  std::set<std::string> wanted;
  for (const Entry& entry : EntriesOfSchema(schema)) wanted.insert(core::LowerCase(entry.name));
  // Views and indices first: they may refer to tables.
  for (const char* type : {"trigger", "view", "index", "table"}) {
    for (const Entry& entry : EntriesOf(copy)) {
      if (entry.type != type || IsOfSqlite(entry) || wanted.contains(core::LowerCase(entry.name))) continue;
      copy.Execute(fmt::format("DROP {} IF EXISTS {}", type, Quoted(entry.name)));
    }
  }
}

}  // namespace elbowroom::sessions
