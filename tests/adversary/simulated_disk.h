// A disk that remembers in which order it was written and synced, so that a power failure can be played at
// any moment, as often as one likes; and that can fail on demand.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <vector>

namespace elbowroom::adversary {

// What a program asked of the disk, in order.
struct DiskOperation {
  enum class Kind { kCreate, kWrite, kTruncate, kSync, kDelete, kAcknowledge };
  Kind kind = Kind::kWrite;
  std::string file;         // its name without the folder
  std::int64_t offset = 0;  // kWrite; the new size of kTruncate; the frames of kAcknowledge
  std::string bytes = {};   // kWrite
  bool is_durable = false;  // kDelete: the folder was synced with it
};

// While one lives, every SQLite database that this program opens goes through it to real files: SQLite's own
// file layer does the work, this one writes down what is asked. Thread: any.
class SimulatedDisk {
 public:
  SimulatedDisk();
  ~SimulatedDisk();
  SimulatedDisk(const SimulatedDisk&) = delete;
  SimulatedDisk& operator=(const SimulatedDisk&) = delete;

  // What is acknowledged now has to survive every power failure from here on.
  void Acknowledge(std::int64_t frames);

  // From now on writes, syncs or both fail with this SQLite code; 0: they work again.
  void FailWrites(int sqlite_code);
  void FailSyncs(int sqlite_code);

  [[nodiscard]] std::vector<DiskOperation> operations() const;

  // Called by the file layer.
  void Log(DiskOperation operation);
  [[nodiscard]] int write_failure() const;
  [[nodiscard]] int sync_failure() const;

 private:
  mutable std::mutex mutex_;
  std::vector<DiskOperation> operations_;
  int write_failure_ = 0, sync_failure_ = 0;
};

// What a disk holds after the power failed right after the first `count` operations: everything synced, and
// of the rest a random part: written or not, torn, in any order. Folders: a new file is there for certain
// once it was synced; one deleted without syncing the folder may be back.
struct DiskImage {
  std::map<std::string, std::string> files;  // by name
  std::int64_t acknowledged_frames = 0;
};
[[nodiscard]] DiskImage AfterPowerFailure(const std::vector<DiskOperation>& operations, std::size_t count,
                                          const std::string& session_file, std::mt19937_64& random);

void WriteImage(const DiskImage& image, const std::filesystem::path& folder);

}  // namespace elbowroom::adversary
