// Session files made worse, each time the same for the same seed.
#pragma once

#include <filesystem>
#include <random>
#include <span>
#include <string>

namespace elbowroom::tests {

// Damages the session at `path` in one of many ways: bits, pages, cuts, rows, values of any type in any
// column, tables, views and indices, packed data with wrong and right checksums. Returns what it did, for
// whoever must find out; nothing may have come of it where SQLite itself refused.
std::string Spoil(const std::filesystem::path& path, std::mt19937& random);

// Runs SQL with everything off that keeps a file sound: references, checks, types, the schema's defence.
// Throws: SQLite::Exception.
void SpoilBySql(const std::filesystem::path& path, const std::string& sql);

struct Reproducer {
  const char* what;
  const char* sql;
};
// What once took the program down, kept it for ever, or passed unseen.
[[nodiscard]] std::span<const Reproducer> KnownReproducers();

// What SQLite's own integrity check says; "ok" for a sound file.
[[nodiscard]] std::string IntegrityOf(const std::filesystem::path& path);

}  // namespace elbowroom::tests
