// Where results and messages go: a stream that is closed, full or broken is an error of one line, never a
// signal, and never another file.
#pragma once

#include <string_view>

namespace elbowroom::cli {

// The first thing that a program does. What is closed of the streams 0, 1 and 2 is taken by /dev/null, opened
// the wrong way round: no file that is opened later gets a stream's number, and writing still fails. A broken
// pipe and a file beyond `ulimit -f` are no signals from here on: writing fails.
void GuardStandardStreams();

// Throws: Error{kFile} unless all of it went out.
void WriteToStdout(std::string_view text);

// What can't be written is lost: there is nobody to tell.
void WriteToStderr(std::string_view text);

}  // namespace elbowroom::cli
