#include "tests/adversary/disk_mount.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "tests/support/run_program.h"
#include "tests/support/text_file.h"

namespace elbowroom::adversary {
namespace {

namespace fs = std::filesystem;

bool Succeeds(const char* program, const std::vector<std::string>& words, std::string* out = nullptr) {
  if (!fs::exists(program)) return false;
  const test_support::ProgramRun run = test_support::RunProgram(program, words);
  if (out != nullptr) *out = run.out;
  return run.exit_status == 0;
}

}  // namespace

std::optional<DiskMount> DiskMount::InMemory(const fs::path& at, int size_mb) {
  fs::create_directories(at);
  const std::string options = "size=" + std::to_string(size_mb) + "m";
  if (::mount("tmpfs", at.c_str(), "tmpfs", 0, options.c_str()) != 0) return std::nullopt;
  return DiskMount(at);
}

std::optional<DiskMount> DiskMount::Ext4(const fs::path& image, const fs::path& at) {
  constexpr std::uintmax_t kImageBytes = 128U << 20U;
  fs::create_directories(at);
  if (!fs::exists(image)) {
    test_support::WriteText(image, "");
    fs::resize_file(image, kImageBytes);
    if (!Succeeds("/sbin/mkfs.ext4", {"-q", image.string()})) return std::nullopt;
  }
  // Not ext4's own five seconds: what a program doesn't sync is lost for certain.
  if (!Succeeds("/bin/mount", {"-o", "loop,commit=300,errors=remount-ro", image.string(), at.string()}))
    return std::nullopt;
  DiskMount mount(at);
  std::string source;
  if (Succeeds("/bin/findmnt", {"-no", "SOURCE", at.string()}, &source))
    mount.device_ = fs::path(source.substr(0, source.find('\n'))).filename().string();
  return mount;
}

DiskMount::DiskMount(DiskMount&& other) noexcept
    : at_(std::exchange(other.at_, {})), device_(std::move(other.device_)) {}

DiskMount::~DiskMount() {
  if (!at_.empty()) ::umount2(at_.c_str(), MNT_DETACH);
}

bool DiskMount::CutPower() const {
  constexpr auto kShutdown = _IOR('X', 125, std::uint32_t);  // EXT4_IOC_SHUTDOWN
  std::uint32_t without_the_log = 2;                         // EXT4_GOING_FLAGS_NOLOGFLUSH
  const int folder = ::open(at_.c_str(), O_RDONLY | O_DIRECTORY);
  const bool is_off = folder >= 0 && ::ioctl(folder, kShutdown, &without_the_log) == 0;
  if (folder >= 0) ::close(folder);
  return is_off;
}

bool DiskMount::RemountReadOnly() const {
  return ::mount(nullptr, at_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) == 0;
}

bool DiskMount::MakeReadOnly() const {
  const fs::path trigger = fs::path("/sys/fs/ext4") / device_ / "trigger_fs_error";
  std::FILE* file = device_.empty() ? nullptr : std::fopen(trigger.c_str(), "w");
  if (file == nullptr) return false;
  const bool is_written = std::fputs("test", file) >= 0;
  return std::fclose(file) == 0 && is_written;
}

}  // namespace elbowroom::adversary
