#include "core/system/configuration_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace elbowroom::core {
namespace {

constexpr std::size_t kMibBytes = std::size_t{1} << 20U;

struct Subject {
  const std::string& who;
  std::string_view what;

  [[noreturn]] void Fail(const std::string& why) const {
    throw Error(ErrorKind::kFile, fmt::format("{}: {}", who, why));
  }
  [[noreturn]] void FailToRead(int error) const {
    if (error == ENOENT || error == ENOTDIR) Fail(fmt::format("no such {}; check the path", what));
    Fail(fmt::format("can't be read ({}); check the path and who may read it", std::strerror(error)));
  }
  void RequireSmallFile(const struct stat& status) const {
    if (!S_ISREG(status.st_mode)) Fail(fmt::format("isn't a file; name a {}", what));
    if (static_cast<std::size_t>(status.st_size) > kLargestConfigurationBytes) FailAsTooLarge();
  }
  [[noreturn]] void FailAsTooLarge() const {
    Fail(fmt::format("is larger than {} MiB, which no {} is; check that it is the right file",
                     kLargestConfigurationBytes / kMibBytes, what));
  }
};

class OpenedFile {
 public:
  // O_NONBLOCK: a pipe to which nobody writes opens at once, so that its kind can be checked.
  explicit OpenedFile(const std::filesystem::path& path)
      : number_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {}
  ~OpenedFile() {
    if (number_ >= 0) ::close(number_);
  }
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

}  // namespace

std::string ReadConfiguration(const std::filesystem::path& path, const std::string& who,
                              std::string_view what) {
  const Subject subject{who, what};
  struct stat status {};
  // The kind is checked before opening, because opening a device may have effects, and again after it,
  // because the name may by then be that of another file.
  if (::stat(path.c_str(), &status) != 0) subject.FailToRead(errno);
  subject.RequireSmallFile(status);
  const OpenedFile file(path);
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0) subject.FailToRead(errno);
  subject.RequireSmallFile(status);
  std::string bytes;
  std::array<char, 65'536> chunk;
  while (true) {
    const ssize_t size = ::read(file.number(), chunk.data(), chunk.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) subject.FailToRead(errno);
    if (size == 0) return bytes;
    bytes.append(chunk.data(), static_cast<std::size_t>(size));
    if (bytes.size() > kLargestConfigurationBytes) subject.FailAsTooLarge();  // it grew
  }
}

}  // namespace elbowroom::core
