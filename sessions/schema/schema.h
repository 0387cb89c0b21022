// The tables of a session file and how an older file gets them.
#pragma once

#include <cstdint>
#include <string>

#include "sessions/database/database.h"

namespace elbowroom::sessions {

inline constexpr std::int64_t kApplicationId = 0x456C6277;        // "Elbw" in the file's header
inline constexpr std::int64_t kMergedApplicationId = 0x456C6273;  // "Elbs": several sessions in one file
inline constexpr std::int64_t kSchemaVersion = 11;

// The SQL that leads from schema 0, an empty file, to schema 1.
[[nodiscard]] std::string Schema1Sql();

// From schema 1 to schema 2: where a silhouette's boundary lies between pixel centres.
[[nodiscard]] std::string Schema2Sql();

// From schema 2 to schema 3: the parts' recovery rules, more outcomes of a recovery; clearance and near
// misses; where on a part a touch was, and with which tools; heat maps; the uncertainty.
[[nodiscard]] std::string Schema3Sql();

// From schema 3 to schema 4: cloths, pushed parts, streams, and how parts were moved; pairs that are ignored.
[[nodiscard]] std::string Schema4Sql();

// From schema 4 to schema 5: how far a mesh may deviate through tessellation; parts whose unit is that of
// their file.
[[nodiscard]] std::string Schema5Sql();

// From schema 5 to schema 6: groups of parts, and spacings between groups.
[[nodiscard]] std::string Schema6Sql();

// From schema 6 to schema 7: how exact the rig is, and what each clearance's verdict allows for.
[[nodiscard]] std::string Schema7Sql();

// From schema 7 to schema 8: the stamps of each frame's pictures, and what the trial itself allows for.
[[nodiscard]] std::string Schema8Sql();

// From schema 8 to schema 9: replays and what they were made from; names of touches and near misses that
// outlive a replay; what reviewers said; the files of the footage.
[[nodiscard]] std::string Schema9Sql();

// From schema 9 to schema 10: condition and order of a trial; the steps of its procedure, bookmarks,
// estimates and answers of the participant.
[[nodiscard]] std::string Schema10Sql();

// From schema 10 to schema 11: a trial's block; questionnaires with their questions, scores and answers.
[[nodiscard]] std::string Schema11Sql();

// Brings the open transaction's database to kSchemaVersion by the migrations that it lacks, in order.
void Migrate(Database& database);

// The same up to an earlier schema, with which a file of that schema is compared.
void MigrateTo(Database& database, std::int64_t schema);

// Throws: Error{kFormat} when the file is no session, or one of a newer schema than this program knows.
void RequireReadableSession(Database& database);

}  // namespace elbowroom::sessions
