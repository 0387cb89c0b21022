#include "tests/adversary/simulated_disk.h"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "tests/support/text_file.h"

namespace elbowroom::adversary {
namespace {

using Kind = DiskOperation::Kind;

constexpr const char* kName = "elbowroom-simulated-disk";
SimulatedDisk* the_disk = nullptr;
sqlite3_vfs* the_real_layer = nullptr;

// An open file of this layer: SQLite's own one lies right behind it in memory.
struct LayerFile {
  sqlite3_file base;
  const char* name;  // SQLite keeps it alive
  bool is_logged;
};
LayerFile& Own(sqlite3_file* file) { return *reinterpret_cast<LayerFile*>(file); }
sqlite3_file* Real(sqlite3_file* file) {
  return reinterpret_cast<sqlite3_file*>(reinterpret_cast<char*>(file) + sizeof(LayerFile));
}
const sqlite3_io_methods* Methods(sqlite3_file* file) { return Real(file)->pMethods; }
std::string NameOf(const char* path) { return std::filesystem::path(path).filename().string(); }

int Close(sqlite3_file* file) { return Methods(file)->xClose(Real(file)); }
int Read(sqlite3_file* file, void* to, int size, sqlite3_int64 offset) {
  return Methods(file)->xRead(Real(file), to, size, offset);
}
int Write(sqlite3_file* file, const void* from, int size, sqlite3_int64 offset) {
  if (const int failure = the_disk->write_failure(); failure != SQLITE_OK) return failure;
  const int code = Methods(file)->xWrite(Real(file), from, size, offset);
  if (code == SQLITE_OK && Own(file).is_logged) {
    the_disk->Log({Kind::kWrite, NameOf(Own(file).name), offset,
                   std::string(static_cast<const char*>(from), static_cast<std::size_t>(size))});
  }
  return code;
}
int Truncate(sqlite3_file* file, sqlite3_int64 size) {
  if (const int failure = the_disk->write_failure(); failure != SQLITE_OK) return failure;
  const int code = Methods(file)->xTruncate(Real(file), size);
  if (code == SQLITE_OK && Own(file).is_logged)
    the_disk->Log({Kind::kTruncate, NameOf(Own(file).name), size});
  return code;
}
int Sync(sqlite3_file* file, int flags) {
  if (const int failure = the_disk->sync_failure(); failure != SQLITE_OK) return failure;
  const int code = Methods(file)->xSync(Real(file), flags);
  if (code == SQLITE_OK && Own(file).is_logged) the_disk->Log({Kind::kSync, NameOf(Own(file).name)});
  return code;
}
int FileSize(sqlite3_file* file, sqlite3_int64* size) { return Methods(file)->xFileSize(Real(file), size); }
int Lock(sqlite3_file* file, int level) { return Methods(file)->xLock(Real(file), level); }
int Unlock(sqlite3_file* file, int level) { return Methods(file)->xUnlock(Real(file), level); }
int CheckReserved(sqlite3_file* file, int* result) {
  return Methods(file)->xCheckReservedLock(Real(file), result);
}
int FileControl(sqlite3_file* file, int op, void* argument) {
  return Methods(file)->xFileControl(Real(file), op, argument);
}
int SectorSize(sqlite3_file* file) { return Methods(file)->xSectorSize(Real(file)); }
int Characteristics(sqlite3_file* file) { return Methods(file)->xDeviceCharacteristics(Real(file)); }
int ShmMap(sqlite3_file* file, int page, int size, int extend, void volatile** memory) {
  return Methods(file)->xShmMap(Real(file), page, size, extend, memory);
}
int ShmLock(sqlite3_file* file, int offset, int n, int flags) {
  return Methods(file)->xShmLock(Real(file), offset, n, flags);
}
void ShmBarrier(sqlite3_file* file) { Methods(file)->xShmBarrier(Real(file)); }
int ShmUnmap(sqlite3_file* file, int is_delete) { return Methods(file)->xShmUnmap(Real(file), is_delete); }

constexpr sqlite3_io_methods kMethods = {
    2,        Close,         Read,        Write,      Truncate,        Sync,   FileSize, Lock,
    Unlock,   CheckReserved, FileControl, SectorSize, Characteristics, ShmMap, ShmLock,  ShmBarrier,
    ShmUnmap, nullptr,       nullptr};

int Open(sqlite3_vfs* /*layer*/, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  constexpr int kLogged = SQLITE_OPEN_MAIN_DB | SQLITE_OPEN_MAIN_JOURNAL | SQLITE_OPEN_WAL;
  LayerFile& own = Own(file);
  own = {{nullptr}, name, name != nullptr && (flags & kLogged) != 0};
  const bool is_new = name != nullptr && !std::filesystem::exists(name);
  const int code = the_real_layer->xOpen(the_real_layer, name, Real(file), flags, out_flags);
  if (Real(file)->pMethods != nullptr) own.base.pMethods = &kMethods;
  if (code == SQLITE_OK && own.is_logged && is_new) the_disk->Log({Kind::kCreate, NameOf(name)});
  return code;
}
int Delete(sqlite3_vfs* /*layer*/, const char* name, int sync_folder) {
  if (const int failure = the_disk->write_failure(); failure != SQLITE_OK) return SQLITE_IOERR_DELETE;
  const int code = the_real_layer->xDelete(the_real_layer, name, sync_folder);
  if (code == SQLITE_OK) the_disk->Log({Kind::kDelete, NameOf(name), 0, "", sync_folder != 0});
  return code;
}

sqlite3_vfs MakeLayer() {
  sqlite3_vfs layer = *the_real_layer;
  layer.szOsFile = static_cast<int>(sizeof(LayerFile)) + the_real_layer->szOsFile;
  layer.zName = kName;
  layer.pNext = nullptr;
  layer.xOpen = Open;
  layer.xDelete = Delete;
  return layer;
}
sqlite3_vfs the_layer;

// --- what is left of one file ---

// Content that is on the disk, and what was asked since and may be.
struct FileState {
  bool is_there = false;      // for certain
  bool may_be_there = false;  // created or deleted, and the folder not synced
  std::string durable;
  std::vector<const DiskOperation*> pending;
};

void Put(std::string& content, std::size_t at, std::string_view bytes) {
  if (content.size() < at + bytes.size()) content.resize(at + bytes.size(), '\0');
  content.replace(at, bytes.size(), bytes);
}

void Apply(std::string& content, const DiskOperation& operation) {
  if (operation.kind == Kind::kTruncate) {
    content.resize(static_cast<std::size_t>(operation.offset), '\0');
  } else {
    Put(content, static_cast<std::size_t>(operation.offset), operation.bytes);
  }
}

// How much of what wasn't synced reaches the disk.
enum class Fate { kNothing, kSome, kAll };

// Sector by sector, each for itself; a sector may be torn anywhere.
void ApplyInPart(std::string& content, const DiskOperation& operation, std::mt19937_64& random) {
  constexpr std::size_t kSectorBytes = 512;
  if (operation.kind == Kind::kTruncate) {
    if (random() % 2 == 0) Apply(content, operation);
    return;
  }
  for (std::size_t at = 0; at < operation.bytes.size(); at += kSectorBytes) {
    std::string_view sector = std::string_view(operation.bytes).substr(at, kSectorBytes);
    if (random() % 2 == 0) continue;
    if (random() % 16 == 0) sector = sector.substr(0, random() % sector.size());
    Put(content, static_cast<std::size_t>(operation.offset) + at, sector);
  }
}

std::string ContentAfter(const FileState& state, Fate fate, std::mt19937_64& random) {
  std::string content = state.durable;
  std::vector<const DiskOperation*> pending = state.pending;
  if (fate == Fate::kSome) std::ranges::shuffle(pending, random);
  for (const DiskOperation* operation : pending) {
    if (fate == Fate::kAll) Apply(content, *operation);
    if (fate == Fate::kSome) ApplyInPart(content, *operation, random);
  }
  return content;
}

void Follow(const DiskOperation& operation, std::map<std::string, FileState>& files) {
  FileState& file = files[operation.file];
  switch (operation.kind) {
    case Kind::kCreate:
      file.may_be_there = true;
      break;
    case Kind::kWrite:
    case Kind::kTruncate:
      file.pending.push_back(&operation);
      break;
    case Kind::kSync:
      for (const DiskOperation* pending : file.pending) Apply(file.durable, *pending);
      file.pending.clear();
      file.is_there = true;  // SQLite syncs the folder with a new file's first sync
      break;
    case Kind::kDelete:
      if (operation.is_durable) {
        file = {};
      } else {
        file.may_be_there = file.is_there || file.may_be_there;
        file.is_there = false;
      }
      break;
    case Kind::kAcknowledge:
      break;
  }
}

}  // namespace

SimulatedDisk::SimulatedDisk() {
  if (the_disk != nullptr) throw std::logic_error("one simulated disk at a time");
  the_disk = this;
  the_real_layer = sqlite3_vfs_find("unix");
  the_layer = MakeLayer();
  sqlite3_vfs_register(&the_layer, 1);
}

SimulatedDisk::~SimulatedDisk() {
  sqlite3_vfs_unregister(&the_layer);
  sqlite3_vfs_register(the_real_layer, 1);
  the_disk = nullptr;
}

void SimulatedDisk::Acknowledge(std::int64_t frames) { Log({Kind::kAcknowledge, "", frames}); }

void SimulatedDisk::FailWrites(int sqlite_code) {
  const std::lock_guard lock(mutex_);
  write_failure_ = sqlite_code;
}
void SimulatedDisk::FailSyncs(int sqlite_code) {
  const std::lock_guard lock(mutex_);
  sync_failure_ = sqlite_code;
}

std::vector<DiskOperation> SimulatedDisk::operations() const {
  const std::lock_guard lock(mutex_);
  return operations_;
}

void SimulatedDisk::Log(DiskOperation operation) {
  const std::lock_guard lock(mutex_);
  operations_.push_back(std::move(operation));
}
int SimulatedDisk::write_failure() const {
  const std::lock_guard lock(mutex_);
  return write_failure_;
}
int SimulatedDisk::sync_failure() const {
  const std::lock_guard lock(mutex_);
  return sync_failure_;
}

DiskImage AfterPowerFailure(const std::vector<DiskOperation>& operations, std::size_t count,
                            const std::string& session_file, std::mt19937_64& random) {
  std::map<std::string, FileState> files;
  files[session_file].is_there = true;  // the program syncs the folder right after it has made the file
  DiskImage image;
  for (std::size_t i = 0; i < count; ++i) {
    Follow(operations[i], files);
    if (operations[i].kind == Kind::kAcknowledge) image.acknowledged_frames = operations[i].offset;
  }
  const auto fate = static_cast<Fate>(random() % 3);
  files.erase("");
  for (const auto& [name, file] : files) {
    if (file.is_there || (file.may_be_there && random() % 2 == 0))
      image.files[name] = ContentAfter(file, fate, random);
  }
  return image;
}

void WriteImage(const DiskImage& image, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const auto& [name, content] : image.files) test_support::WriteText(folder / name, content);
}

}  // namespace elbowroom::adversary
