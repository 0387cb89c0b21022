// Results and messages: a stream that is closed, full or broken gives an error of one line, never a signal,
// and its number never belongs to another file.
#pragma once

#include <string_view>

namespace elbowroom::cli {

// The first call of a program. Each of the streams 0, 1 and 2 that is closed is replaced by /dev/null, opened
// in the wrong direction: no file that is opened later gets its number, and using the stream still fails.
// From here on a broken pipe and a file beyond `ulimit -f` raise no signal: writing fails.
void GuardStandardStreams();

// Throws: Error{kFile} unless all of it went out.
void WriteToStdout(std::string_view text);

// What can't be written is lost: there is no other place for it.
void WriteToStderr(std::string_view text);

}  // namespace elbowroom::cli
