// The SQLite connection of one session file, and what its failures say.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
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

  // True for what the world around the file may mend (a lock, a full disk, a file that is gone); false for
  // what this program did wrong.
  [[nodiscard]] bool MayPass() const;

 private:
  int sqlite_code_;
};

// Every member throws DatabaseError that names the file, what SQLite said and what to do.
// Thread: one at a time; may be handed over between threads.
class Database {
 public:
  // A new, empty database. What is committed to it is on the disk: it survives the death of the program and
  // of the machine (a write-ahead log that is synced with each commit). Throws: Error{kFile} when `path`
  // exists (nothing is ever overwritten), when a journal of another database lies beside it, or when its
  // folder doesn't exist or can't be written.
  [[nodiscard]] static Database Create(const std::filesystem::path& path);

  // The same for one that is there: what a crash left half done is put right as SQLite does it.
  [[nodiscard]] static Database OpenToWrite(const std::filesystem::path& path);

  // Sees what other connections commit. What a crash left half done is first put right (a hot journal, a log
  // without its index): in the file where it may be written, else in a copy for the time of the connection.
  // Throws: Error{kFile} when there is no such file.
  [[nodiscard]] static Database OpenReadOnly(const std::filesystem::path& path);

  // Reads the copy; messages name what it is a copy of.
  [[nodiscard]] static Database OpenReadOnly(std::shared_ptr<const PrivateCopy> copy);

  // A copy of the open `database` at `path`, which must not exist, also where its file has lost its name.
  [[nodiscard]] static Database CopyTo(const std::filesystem::path& path, Database& database);

  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;
  ~Database();

  void Execute(const std::string& sql);
  [[nodiscard]] std::int64_t ReadInteger(const std::string& sql);  // first column of the first row

  // A private copy in memory, which can be migrated without touching the file. Throws: Error{kCancelled},
  // too.
  [[nodiscard]] Database CopyInMemory(const std::stop_token& stop = {});

  // The same in a temporary file, which SQLite removes: of a file that may be larger than memory.
  [[nodiscard]] Database CopyAside(const std::stop_token& stop = {});

  // An empty one, which errors call by that name.
  [[nodiscard]] static Database InMemory(const std::filesystem::path& name);

  // Moves the log into the file and takes it away, so that the session is a single file. Where another
  // program is reading, the log stays until that program closes; nothing is lost either way.
  void FoldLogIntoFile();

  // Whether the database, and its log if it has one, are still the files of these names.
  [[nodiscard]] bool IsInPlace() const;

  // Whether `path` names the file that is open here.
  [[nodiscard]] bool IsTheFile(const std::filesystem::path& path) const { return IdOf(path) == file_; }

  // Notes which files are this connection's, with those that SQLite has made since the last call.
  void RememberPlace();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] SQLite::Database& connection() { return *connection_; }

 private:
  // A file by what doesn't change when it is renamed; all 0: there is none.
  struct FileId {
    std::uint64_t device = 0;
    std::uint64_t inode = 0;
    bool operator==(const FileId&) const = default;
  };
  Database(std::filesystem::path path, std::unique_ptr<SQLite::Database> connection);
  // A name that SQLite knows for a database that is nobody else's.
  [[nodiscard]] Database CopyUnder(const char* sqlite_name, const std::stop_token& stop);
  [[nodiscard]] static FileId IdOf(const std::filesystem::path& path);

  std::filesystem::path path_;
  std::shared_ptr<const PrivateCopy>
      copy_;  // of which this is the connection, and which outlives it; or null
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

// The file that is being handled by SQLite in this catch block failed: throws DatabaseError in its words;
// anything that didn't come from SQLite passes through.
[[noreturn]] void RethrowAsError(const std::filesystem::path& path);

// Removes the database and the journals beside it, as far as they exist; true if nothing is left of them.
bool RemoveDatabaseFiles(const std::filesystem::path& path) noexcept;

// Whether a connection to this database, of any program, is open that follows its log: its writer's, or a
// reader's. Asked before this program opens one. False where the system doesn't tell.
[[nodiscard]] bool IsInUse(const std::filesystem::path& path);

}  // namespace elbowroom::sessions
