// Made-up sessions, the same for the same seed, for the tests of this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/session.h"
#include "sessions/session_closing.h"

namespace elbowroom::tests {

// Two cameras of different lenses, three parts (two share a mesh), two spacings (one of a group), pair rules,
// odd doubles, and texts that need escaping in SQL and HTML.
[[nodiscard]] core::SessionHeader SampleHeader();

// What the header's rig and layout would give: blobs for silhouettes, the first with levels, contacts with
// every optional field set and unset. Frame `frame` is the same whatever was made before it.
[[nodiscard]] core::FrameRecord SampleFrame(const core::SessionHeader& header, core::FrameIndex frame,
                                            std::uint32_t seed);

// As a file of that schema keeps them.
[[nodiscard]] core::FrameRecord AsOfSchema(int schema, core::FrameRecord record);
[[nodiscard]] core::SessionHeader AsOfSchema(int schema, core::SessionHeader header);

// A spacing change, a tool taken and put away, a note; two steps, the second of which isn't ended; two
// bookmarks; estimates, and answers to the survey and to questionnaires, some of which are given twice, some
// not at all.
[[nodiscard]] std::vector<core::SessionEvent> SampleEvents();

// One of part 0 and one of part 1 within frames first..last.
[[nodiscard]] std::vector<core::ContactEpisode> SampleEpisodes(core::FrameIndex first, core::FrameIndex last);

// The episodes, with places and tools; a near miss of part 2 and a heat map of part 0.
[[nodiscard]] core::SessionOutcome SampleOutcome(core::FrameIndex first, core::FrameIndex last);

// A finding that is gone, with remarks; one that wasn't checked; a footage file.
[[nodiscard]] sessions::SessionClosing SampleClosing();

// Writes `frames` frames from 0 on, the sample events and outcome, and finishes the session.
void WriteSampleSession(const std::filesystem::path& path, core::FrameIndex frames);

// Fails the running test where the two differ in anything, doubles compared exactly.
void ExpectEqual(const core::PartContact& actual, const core::PartContact& expected);
void ExpectEqual(const core::FrameRecord& actual, const core::FrameRecord& expected);
void ExpectEqual(const core::ContactEpisode& actual, const core::ContactEpisode& expected);
void ExpectEqual(const core::NearMiss& actual, const core::NearMiss& expected);
void ExpectEqual(const core::SessionHeader& actual, const core::SessionHeader& expected);

}  // namespace elbowroom::tests
