// BCF 2.1 files: the BIM Collaboration Format of buildingSMART, a zip of XML files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "sessions/bcf/bcf_topic.h"

namespace elbowroom::sessions {

// The bytes of the file; the same for the same topics. Lengths are in metres there, as BCF wants them.
// Characters that XML can't have become U+FFFD; a time that isn't ISO 8601 becomes 1970-01-01T00:00:00Z.
// Throws: PreconditionError for an id that isn't 32 hex digits; Error{kFile} where it can't be packed.
[[nodiscard]] std::string PackBcf(std::span<const BcfTopic> topics);

// Ids, statuses, times, names and comments of the topics of a file of BCF 2.0 or 2.1; nothing else of it.
// Throws: Error{kFile} when there is no such file; Error{kFormat} where it isn't a BCF file, is one of
// another version, or holds more than any review does.
[[nodiscard]] std::vector<BcfTopic> ReadBcfFile(const std::filesystem::path& path);

}  // namespace elbowroom::sessions
