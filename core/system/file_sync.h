// What is written stays written when the power fails: files and folders brought to the disk.
#pragma once

#include <filesystem>

namespace elbowroom::core {

// The folder's entries are on the disk: files that were made, renamed or removed in it. A file system that
// can't do this for folders is left as it is. Thread: any.
void SyncFolder(const std::filesystem::path& folder) noexcept;

// The folder that holds `path`: "." for a bare name.
[[nodiscard]] std::filesystem::path FolderOf(const std::filesystem::path& path);

// Makes `folder` and the folders above it that are missing, and brings their entries to the disk. Throws:
// Error{kFile} naming it when it can't be made or is no folder.
void MakeFolder(const std::filesystem::path& folder);

}  // namespace elbowroom::core
