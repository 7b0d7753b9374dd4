#pragma once

#include <filesystem>
#include <string_view>

/// What the writers of files and of result folders share.
namespace kingpin::io {

/// Throws RunError for a device that fails and InputError for a place that cannot be used: no
/// permission, read-only, full, a file where a folder is due. `reason` is an errno.
[[noreturn]] void FailOutput(const std::filesystem::path& path, std::string_view doing, int reason);

/// Makes a folder and those above it. Throws InputError, which names `shown`.
void MakeDirectories(const std::filesystem::path& path);
void MakeDirectories(const std::filesystem::path& path, const std::filesystem::path& shown);

/// Forces a folder's entries to the disk, where the system can.
void SyncDirectory(const std::filesystem::path& path);

}  // namespace kingpin::io
