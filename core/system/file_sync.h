// Brings folders to the disk, so that their entries survive a power failure.
#pragma once

#include <filesystem>

namespace elbowroom::core {

// Brings the folder's entries (files that were made, renamed or removed in it) to the disk. Nothing is
// reported if the file system can't sync folders. Thread: any.
void SyncFolder(const std::filesystem::path& folder) noexcept;

// The folder that holds `path`: "." for a bare name.
[[nodiscard]] std::filesystem::path FolderOf(const std::filesystem::path& path);

// Makes `folder` and the folders above it that are missing, and brings their entries to the disk. Throws:
// Error{kFile} naming it when it can't be made or is no folder.
void MakeFolder(const std::filesystem::path& folder);

}  // namespace elbowroom::core
