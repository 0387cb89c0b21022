// The SQLite connection of one session file, and its errors.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "core/error.h"

namespace SQLite {
class Database;
}

namespace elbowroom::sessions {

class PrivateCopy;

// SQLite failed at a session file.
class DatabaseError : public core::Error {
 public:
  DatabaseError(const std::string& message, int sqlite_code)
      : core::Error(core::ErrorKind::kDatabase, message), sqlite_code_(sqlite_code) {}

  // True where the statement may succeed later, because the cause lies outside of this program (a lock, a
  // full disk, a file that is gone or damaged). False where this program did something wrong.
  [[nodiscard]] bool MayPass() const;

 private:
  int sqlite_code_;
};

// A member that fails throws DatabaseError, which names the file, what SQLite said and what to do.
// Thread: one at a time; may be handed over between threads.
class Database {
 public:
  // A new, empty database. What is committed to it is on the disk: it survives the death of the program and
  // of the machine (a write-ahead log that is synced with each commit). Throws: Error{kFile} when `path`
  // exists (nothing is ever overwritten), when a journal of another database lies beside it, or when its
  // folder doesn't exist or can't be written.
  [[nodiscard]] static Database Create(const std::filesystem::path& path);

  // Opens an existing database in the same way. After a crash SQLite recovers it first.
  [[nodiscard]] static Database OpenToWrite(const std::filesystem::path& path);

  // Sees what other connections commit. After a crash SQLite recovers the database first (a hot journal, a
  // log without its index): in the file where it may be written, else in a copy for the time of the
  // connection.
  // Throws: Error{kFile} when there is no such file.
  [[nodiscard]] static Database OpenReadOnly(const std::filesystem::path& path);

  // Reads the copy; messages name the original.
  [[nodiscard]] static Database OpenReadOnly(std::shared_ptr<const PrivateCopy> copy);

  // A copy of the open `database` at `path`, which must not exist. Works also after the file of `database`
  // was removed or renamed.
  [[nodiscard]] static Database CopyTo(const std::filesystem::path& path, Database& database);

  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;
  ~Database();

  void Execute(const std::string& sql);
  [[nodiscard]] std::int64_t ReadInteger(const std::string& sql);  // first column of the first row

  // A private copy in memory, which can be migrated without touching the file. Throws also Error{kCancelled},
  // and Error{kFile} where there is no room for it.
  [[nodiscard]] Database CopyInMemory(const std::stop_token& stop = {});

  // A second connection to the same file, for another thread. SQLite takes it for one that writes, as the
  // checks of a table need, but it is not allowed to. Nothing where the file can't be written.
  [[nodiscard]] std::optional<Database> OpenBeside();

  // A private copy in a temporary file, which SQLite removes: for a file that may be larger than memory.
  [[nodiscard]] Database CopyAside(const std::stop_token& stop = {});

  // An empty database in memory; errors call it `name`.
  [[nodiscard]] static Database InMemory(const std::filesystem::path& name);

  // Moves the content of the log into the file and removes the log, so that the session is a single file.
  // While another program is reading, the log stays until that program closes; nothing is lost either way.
  void FoldLogIntoFile();

  // Whether the database, its log and the log's index, as far as they exist, are still the files at their
  // paths.
  [[nodiscard]] bool IsInPlace() const;

  // Whether `path` names the file that is open here.
  [[nodiscard]] bool IsTheFile(const std::filesystem::path& path) const { return IdOf(path) == file_; }

  // Notes the identity of the database, its log and the log's index, as far as it isn't known yet: SQLite
  // makes the latter two later.
  void RememberPlace();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] SQLite::Database& connection() { return *connection_; }

 private:
  // Identifies a file independently of its name. All 0: there is no file.
  struct FileId {
    std::uint64_t device = 0;
    std::uint64_t inode = 0;
    bool operator==(const FileId&) const = default;
  };
  Database(std::filesystem::path path, std::unique_ptr<SQLite::Database> connection);
  // sqlite_name: SQLite's name for a private database, ":memory:" or "" (a temporary file).
  [[nodiscard]] Database CopyUnder(const char* sqlite_name, const std::stop_token& stop);
  [[nodiscard]] static FileId IdOf(const std::filesystem::path& path);

  std::filesystem::path path_;
  std::shared_ptr<const PrivateCopy> copy_;  // read by the connection, which it outlives; null: none
  std::unique_ptr<SQLite::Database> connection_;
  FileId file_, log_, index_;
};

// Rolls back unless committed.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  void Commit();

 private:
  Database& database_;
  bool is_open_ = true;
};

// For a catch block: throws an exception of SQLite again as a DatabaseError about `path`. Any other exception
// passes through.
[[noreturn]] void RethrowAsError(const std::filesystem::path& path);

// Removes the database and the journals beside it, as far as they exist; true if nothing is left of them.
bool RemoveDatabaseFiles(const std::filesystem::path& path) noexcept;

// Whether any program has a connection to this database open that uses its log: the writer, or a reader. To
// be called before this program opens one. False where /proc/locks can't be read.
[[nodiscard]] bool IsInUse(const std::filesystem::path& path);

}  // namespace elbowroom::sessions
