// File systems of their own for a test: small ones that fill up, ones that lose their power.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace elbowroom::adversary {

// Mounted while it lives. Needs root and leave to mount.
class DiskMount {
 public:
  // A file system in memory with room for so much. Nothing: may not be mounted here.
  [[nodiscard]] static std::optional<DiskMount> InMemory(const std::filesystem::path& at, int size_mb);
  // An ext4 in a file `image`, made if it isn't there.
  [[nodiscard]] static std::optional<DiskMount> Ext4(const std::filesystem::path& image,
                                                     const std::filesystem::path& at);

  DiskMount(DiskMount&& other) noexcept;
  DiskMount& operator=(DiskMount&&) = delete;
  ~DiskMount();

  // The file system stops at once, as when its power fails: what isn't on the disk is lost. Ext4 alone.
  [[nodiscard]] bool CutPower() const;
  // As a medium that can't be written. Nobody has a file open there to write.
  [[nodiscard]] bool RemountReadOnly() const;
  // It can't be written any more, as after an error of its disk. Ext4 alone.
  [[nodiscard]] bool MakeReadOnly() const;

 private:
  explicit DiskMount(std::filesystem::path at) : at_(std::move(at)) {}
  std::filesystem::path at_;
  std::string device_;  // "loop3"
};

}  // namespace elbowroom::adversary
