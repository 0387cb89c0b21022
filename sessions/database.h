// The SQLite connection of one session file, and what its failures say.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace SQLite {
class Database;
}

namespace elbowroom::sessions {

// Every member throws core::Error{kDatabase} that names the file, what SQLite said and what to do.
// Thread: one at a time; may be handed over between threads.
class Database {
 public:
  // A new, empty database, ready for transactions that survive the death of the program (write-ahead log).
  // Throws: Error{kFile} when `path` exists (nothing is ever overwritten), when a journal of another database
  // lies beside it, or when its folder doesn't exist or can't be written.
  [[nodiscard]] static Database Create(const std::filesystem::path& path);

  // Read only; sees what other connections commit. Throws: Error{kFile} when there is no such file.
  [[nodiscard]] static Database OpenReadOnly(const std::filesystem::path& path);

  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;
  ~Database();

  void Execute(const std::string& sql);
  [[nodiscard]] std::int64_t ReadInteger(const std::string& sql);  // first column of the first row

  // A private copy in memory, which can be migrated without touching the file.
  [[nodiscard]] Database CopyInMemory();

  // The same in a temporary file, which SQLite removes: of a file that may be larger than memory.
  [[nodiscard]] Database CopyAside();

  // An empty one, which errors call by that name.
  [[nodiscard]] static Database InMemory(const std::filesystem::path& name);

  // Moves the log into the file and takes it away, so that the session is a single file. Where another
  // program is reading, the log stays until that program closes; nothing is lost either way.
  void FoldLogIntoFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] SQLite::Database& connection() { return *connection_; }

 private:
  Database(std::filesystem::path path, std::unique_ptr<SQLite::Database> connection);

  std::filesystem::path path_;
  std::unique_ptr<SQLite::Database> connection_;
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

// The file that is being handled by SQLite in this catch block failed: throws core::Error in its words.
// Throws: Error{kDatabase}; anything that didn't come from SQLite passes through.
[[noreturn]] void RethrowAsError(const std::filesystem::path& path);

// Removes the database and the journals beside it, as far as they exist; true if nothing is left of them.
bool RemoveDatabaseFiles(const std::filesystem::path& path) noexcept;

}  // namespace elbowroom::sessions
