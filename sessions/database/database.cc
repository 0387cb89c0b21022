#include "sessions/database/database.h"

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "core/progress.h"
#include "core/system/file_sync.h"
#include "sessions/database/damage.h"
#include "sessions/database/private_copy.h"
#include "sessions/database/session_files.h"

namespace elbowroom::sessions {
namespace {

using core::Error;
using core::ErrorKind;
namespace fs = std::filesystem;

// How long a statement waits for another program's lock before it fails. A writer waits less, because its
// frames are kept in memory meanwhile.
constexpr int kReaderWaitsMs = 3000, kWriterWaitsMs = 100;
constexpr std::array kJournalSuffixes = {kLogSuffix, kLogIndexSuffix, kRollbackSuffix};

std::string_view AdviceFor(int sqlite_code) {
  switch (sqlite_code & 0xFF) {
    case SQLITE_FULL:
      return "free some space on this disk or choose another";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program holds the session locked; close that program";
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
    core::SyncFolder(core::FolderOf(path));
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

// SQLite opens the files of these names. Opening a pipe would wait until another program opens its other end.
void RequireFilesBeside(const fs::path& path) {
  for (const std::string_view suffix : kJournalSuffixes) {
    const fs::path beside = WithSuffix(path, suffix);
    std::error_code ignored;
    if (!fs::is_other(beside, ignored)) continue;
    throw Error(ErrorKind::kFile,
                fmt::format("'{}' is a pipe or a device, but lies where a session keeps its "
                            "log; move it away",
                            beside.string()));
  }
}

// SQLite gives some names a meaning of its own (":memory:", "file:..."). An absolute path is none of them.
std::unique_ptr<SQLite::Database> Connect(const fs::path& path, int flags, int wait_ms) {
  RequireFilesBeside(path);
  return std::make_unique<SQLite::Database>(fs::absolute(path).string(), flags, wait_ms);
}

// Reads once: SQLite recovers the database after a crash only at the first read.
std::unique_ptr<SQLite::Database> ConnectToRead(const fs::path& path, int flags) {
  auto connection = Connect(path, flags, kReaderWaitsMs);
  (void)connection->execAndGet("SELECT count(*) FROM sqlite_schema").getInt64();
  connection->exec("PRAGMA query_only = ON");
  return connection;
}

// EXTRA syncs the log with each commit and each checkpoint, and the folder when a rollback journal is
// removed. If such a journal came back after a power failure, it would undo the change to a log, and the
// frames in the log would be lost.
void MakeDurable(SQLite::Database& connection) {
  // Of a new file. Packed silhouettes have about 1.8 KiB: in pages of 4 KiB a third of the room stays empty.
  connection.exec("PRAGMA page_size = 8192");
  connection.exec("PRAGMA synchronous = EXTRA; PRAGMA journal_mode = WAL; PRAGMA foreign_keys = ON");
}

// `session`: its path, for messages.
void CopyPages(SQLite::Database& from, SQLite::Database& to, const fs::path& session,
               const std::stop_token& stop) {
  constexpr int kPagesAStep = 1000;
  SQLite::Backup backup(to, from);
  for (int code = SQLITE_OK; code != SQLITE_DONE;) {
    core::ThrowIfStopped(stop, fmt::format("reading session '{}'", session.string()));
    code = backup.executeStep(kPagesAStep);
    if (code != SQLITE_OK && code != SQLITE_DONE) throw SQLite::Exception(sqlite3_errstr(code), code);
  }
}

// Whether SQLite failed because it had to write: to roll back, or to make the index of the log.
bool WantsToWrite(const SQLite::Exception& exception) {
  const int code = exception.getErrorCode() & 0xFF;
  return code == SQLITE_READONLY || code == SQLITE_CANTOPEN || code == SQLITE_IOERR || code == SQLITE_PERM;
}

}  // namespace

bool DatabaseError::MayPass() const {
  switch (sqlite_code_ & 0xFF) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
    case SQLITE_PROTOCOL:
    case SQLITE_NOMEM:
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return true;
    default:
      return false;
  }
}

void RethrowAsError(const fs::path& path) {
  try {
    throw;
  } catch (const SQLite::Exception& exception) {
    throw DatabaseError(fmt::format("session '{}': {}; {}", path.string(), Quotable(exception.what()),
                                    AdviceFor(exception.getErrorCode())),
                        exception.getErrorCode());
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
Database& Database::operator=(Database&& other) noexcept {
  connection_ = std::move(other.connection_);  // before copy_, which it may read
  copy_ = std::move(other.copy_);
  path_ = std::move(other.path_);
  file_ = other.file_;
  log_ = other.log_;
  index_ = other.index_;
  return *this;
}
Database::~Database() = default;

Database Database::Create(const fs::path& path) {
  CreateFileExclusively(path);
  try {
    return OpenToWrite(path);
  } catch (...) {
    RemoveDatabaseFiles(path);
    throw;
  }
}

Database Database::OpenToWrite(const fs::path& path) {
  try {
    Database database(path, Connect(path, SQLite::OPEN_READWRITE, kWriterWaitsMs));
    MakeDurable(*database.connection_);
    database.RememberPlace();
    return database;
  } catch (...) {
    RethrowAsError(path);
  }
}

Database Database::OpenReadOnly(const fs::path& path) {
  if (!fs::is_regular_file(path)) {
    throw Error(ErrorKind::kFile,
                fmt::format("there is no session file '{}'; check the path", path.string()));
  }
  try {
    try {
      return {path, ConnectToRead(path, SQLite::OPEN_READONLY)};
    } catch (const SQLite::Exception& exception) {
      if (!WantsToWrite(exception)) throw;
    }
    try {
      return {path, ConnectToRead(path, SQLite::OPEN_READWRITE)};
    } catch (const SQLite::Exception& exception) {
      if (!WantsToWrite(exception)) throw;
    }
  } catch (...) {
    RethrowAsError(path);
  }
  return OpenReadOnly(std::make_shared<const PrivateCopy>(path));
}

Database Database::OpenReadOnly(std::shared_ptr<const PrivateCopy> copy) {
  try {
    Database database(copy->original(), ConnectToRead(copy->path(), SQLite::OPEN_READWRITE));
    database.copy_ = std::move(copy);
    return database;
  } catch (...) {
    RethrowAsError(copy->original());
  }
}

Database Database::CopyTo(const fs::path& path, Database& database) {
  CreateFileExclusively(path);
  try {
    {
      auto copy = Connect(path, SQLite::OPEN_READWRITE, kWriterWaitsMs);
      copy->exec("PRAGMA synchronous = EXTRA");
      CopyPages(*database.connection_, *copy, database.path_, {});
    }
    return OpenToWrite(path);
  } catch (...) {
    RemoveDatabaseFiles(path);
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

Database Database::CopyInMemory(const std::stop_token& stop) { return CopyUnder(":memory:", stop); }
Database Database::CopyAside(const std::stop_token& stop) { return CopyUnder("", stop); }

std::optional<Database> Database::OpenBeside() {
  const char* file = sqlite3_db_filename(connection_->getHandle(), "main");
  if (file == nullptr || *file == '\0') return std::nullopt;
  try {
    Database beside(path_, ConnectToRead(file, SQLite::OPEN_READWRITE));
    sqlite3* connection = beside.connection_->getHandle();
    // Closing it must not fold a log into the file.
    sqlite3_db_config(connection, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    if (sqlite3_db_readonly(connection, "main") != 0) return std::nullopt;
    beside.copy_ = copy_;
    return beside;
  } catch (const SQLite::Exception& exception) {
    if (WantsToWrite(exception)) return std::nullopt;
    RethrowAsError(path_);
  }
}

Database Database::CopyUnder(const char* sqlite_name, const std::stop_token& stop) {
  try {
    auto copy = std::make_unique<SQLite::Database>(sqlite_name, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    CopyPages(*connection_, *copy, path_, stop);
    return {path_, std::move(copy)};
  } catch (const SQLite::Exception& exception) {
    // Only the copy grows, so it is the copy that has no room.
    const int code = exception.getErrorCode();
    if ((code & 0xFF) == SQLITE_FULL || code == SQLITE_IOERR_WRITE) {
      throw Error(ErrorKind::kFile,
                  fmt::format("session '{}': the temporary copy that it is checked in can't be "
                              "written; free some space for temporary files, or set TMPDIR",
                              path_.string()));
    }
    RethrowAsError(path_);
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
  core::SyncFolder(core::FolderOf(path_));
}

Database::FileId Database::IdOf(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino};
}

void Database::RememberPlace() {
  const auto remember = [](FileId& id, const fs::path& path) {
    if (id == FileId{}) id = IdOf(path);
  };
  remember(file_, path_);
  remember(log_, WithSuffix(path_, kLogSuffix));
  remember(index_, WithSuffix(path_, kLogIndexSuffix));
}

bool Database::IsInPlace() const {
  const auto is_there = [](const FileId& id, const fs::path& path) {
    return id == FileId{} || id == IdOf(path);
  };
  return is_there(file_, path_) && is_there(log_, WithSuffix(path_, kLogSuffix)) &&
         is_there(index_, WithSuffix(path_, kLogIndexSuffix));
}

Transaction::Transaction(Database& database) : database_(database) { database_.Execute("BEGIN IMMEDIATE"); }

Transaction::~Transaction() {
  if (is_open_) database_.connection().tryExec("ROLLBACK");
}

void Transaction::Commit() {
  database_.Execute("COMMIT");
  is_open_ = false;
}

bool IsInUse(const fs::path& path) {
  // Each connection that follows a log holds this byte of the log's index (SQLite's UNIX_SHM_DMS).
  constexpr std::string_view kByte = " 128 128";
  struct stat index {};
  if (::stat(WithSuffix(path, kLogIndexSuffix).c_str(), &index) != 0) return false;
  // Asking for the locks of the index needs a descriptor, and closing that would drop this program's own
  // locks (POSIX). Hence /proc/locks.
  const std::string inode = fmt::format(":{} ", index.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    if (line.find(inode) != std::string::npos && line.ends_with(kByte)) return true;
  }
  return false;
}

}  // namespace elbowroom::sessions
