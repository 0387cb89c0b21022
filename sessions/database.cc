#include "sessions/database.h"

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "sessions/damage.h"

namespace elbowroom::sessions {
namespace {

using core::Error;
using core::ErrorKind;
namespace fs = std::filesystem;

// How long a statement waits for another program's lock before it fails.
constexpr int kBusyTimeoutMs = 3000;
constexpr std::array<std::string_view, 3> kJournalSuffixes = {"-wal", "-shm", "-journal"};

fs::path WithSuffix(fs::path path, std::string_view suffix) {
  path += suffix;
  return path;
}

std::string_view AdviceFor(int sqlite_code) {
  switch (sqlite_code & 0xFF) {
    case SQLITE_FULL:
      return "free some space on this disk or choose another";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program holds the session locked; close it and try again";
    case SQLITE_CORRUPT:
      return "the file is damaged: restore it from a copy, or salvage it (docs/session_database.md)";
    case SQLITE_NOTADB:
      return "this is not a session file; check the path";
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return "make the file and its folder writable";
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
      return "check that the disk works, has room and lets you read and write here";
    default:
      return "the file doesn't hold what this version of elbowroom writes; restore it from a copy";
  }
}

// Makes the empty file itself, in one step with the test that there is none.
void CreateFileExclusively(const fs::path& path) {
  for (const std::string_view suffix : kJournalSuffixes) {
    if (fs::exists(fs::symlink_status(WithSuffix(path, suffix)))) {
      throw Error(ErrorKind::kFile,
                  fmt::format("'{}{}' is left from another session; move it away or choose another "
                              "session path",
                              path.string(), suffix));
    }
  }
  if (std::FILE* file = std::fopen(path.c_str(), "wbx")) {
    std::fclose(file);
    return;
  }
  const int reason = errno;
  if (reason == EEXIST) {
    throw Error(ErrorKind::kFile,
                fmt::format("session '{}' exists already; choose another path or move it away "
                            "(sessions are never overwritten)",
                            path.string()));
  }
  throw Error(ErrorKind::kFile,
              fmt::format("can't create session '{}': {}; choose a path in a folder that exists and "
                          "can be written",
                          path.string(), std::strerror(reason)));
}

}  // namespace

void RethrowAsError(const fs::path& path) {
  try {
    throw;
  } catch (const SQLite::Exception& exception) {
    throw Error(ErrorKind::kDatabase,
                fmt::format("session '{}': {}; {}", path.string(), Quotable(exception.what()),
                            AdviceFor(exception.getErrorCode())));
  }
}

bool RemoveDatabaseFiles(const fs::path& path) noexcept {
  std::error_code failure;
  bool all_gone = true;
  for (const std::string_view suffix : kJournalSuffixes) {
    fs::remove(WithSuffix(path, suffix), failure);
    all_gone = all_gone && !failure;
  }
  fs::remove(path, failure);
  return all_gone && !failure;
}

Database::Database(fs::path path, std::unique_ptr<SQLite::Database> connection)
    : path_(std::move(path)), connection_(std::move(connection)) {}
Database::Database(Database&&) noexcept = default;
Database& Database::operator=(Database&&) noexcept = default;
Database::~Database() = default;

Database Database::Create(const fs::path& path) {
  CreateFileExclusively(path);
  try {
    Database database(
        path, std::make_unique<SQLite::Database>(path.string(), SQLite::OPEN_READWRITE, kBusyTimeoutMs));
    database.Execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; PRAGMA foreign_keys = ON");
    return database;
  } catch (...) {
    RemoveDatabaseFiles(path);
    RethrowAsError(path);
  }
}

Database Database::OpenReadOnly(const fs::path& path) {
  if (!fs::is_regular_file(path)) {
    throw Error(ErrorKind::kFile,
                fmt::format("there is no session file '{}'; check the path", path.string()));
  }
  try {
    return {path, std::make_unique<SQLite::Database>(path.string(), SQLite::OPEN_READONLY, kBusyTimeoutMs)};
  } catch (...) {
    RethrowAsError(path);
  }
}

void Database::Execute(const std::string& sql) {
  try {
    connection_->exec(sql);
  } catch (...) {
    RethrowAsError(path_);
  }
}

std::int64_t Database::ReadInteger(const std::string& sql) {
  try {
    return connection_->execAndGet(sql).getInt64();
  } catch (...) {
    RethrowAsError(path_);
  }
}

Database Database::CopyInMemory() {
  try {
    auto copy = std::make_unique<SQLite::Database>(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    SQLite::Backup backup(*copy, *connection_);
    backup.executeStep();
    return {path_, std::move(copy)};
  } catch (...) {
    RethrowAsError(path_);
  }
}

Database Database::CopyAside() {
  try {
    auto copy = std::make_unique<SQLite::Database>("", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    SQLite::Backup backup(*copy, *connection_);
    backup.executeStep();
    return {path_, std::move(copy)};
  } catch (...) {
    RethrowAsError(path_);
  }
}

Database Database::InMemory(const fs::path& name) {
  try {
    return {name,
            std::make_unique<SQLite::Database>(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)};
  } catch (...) {
    RethrowAsError(name);
  }
}

void Database::FoldLogIntoFile() {
  Execute("PRAGMA wal_checkpoint(TRUNCATE)");
  try {
    connection_->exec("PRAGMA journal_mode = DELETE");
  } catch (const SQLite::Exception& exception) {
    if (exception.getErrorCode() != SQLITE_BUSY) RethrowAsError(path_);
  }
}

Transaction::Transaction(Database& database) : database_(database) { database_.Execute("BEGIN IMMEDIATE"); }

Transaction::~Transaction() {
  if (is_open_) database_.connection().tryExec("ROLLBACK");
}

void Transaction::Commit() {
  database_.Execute("COMMIT");
  is_open_ = false;
}

}  // namespace elbowroom::sessions
