#include "app/cli/standard_streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "core/error.h"

namespace elbowroom::cli {
namespace {

// Writes all of the text. Returns 0, or the errno of what prevented it.
int WriteAll(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t size = ::write(descriptor, text.data(), text.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(size));
  }
  return 0;
}

}  // namespace

void GuardStandardStreams() {
  // open() gives the lowest free number, which is `stream`: those below it are open by then.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      (void)::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void WriteToStdout(std::string_view text) {
  const int error = WriteAll(STDOUT_FILENO, text);
  if (error == 0) return;
  throw core::Error(core::ErrorKind::kFile,
                    fmt::format("the result can't be written to the standard output ({}); check where it "
                                "goes; files that were asked for are there",
                                std::strerror(error)));
}

void WriteToStderr(std::string_view text) { (void)WriteAll(STDERR_FILENO, text); }

}  // namespace elbowroom::cli
