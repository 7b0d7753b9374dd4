#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kingpin::io {

/// A file that is written through checked system calls: a short write, a full disk and a failing
/// close all end in a message.
///
/// Throws InputError where the user's choice of place is at fault (it cannot be created, the disk
/// or quota is full) and RunError where the device fails.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);
  /// Messages name `shown` instead: the place the file will be moved to.
  OutputFile(const std::filesystem::path& path, std::filesystem::path shown);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void Write(std::string_view text);
  /// Writes what is buffered, forces it to the disk and closes. Without it the file is unfinished.
  void Close();

 private:
  void Flush();

  std::filesystem::path shown_;
  int descriptor_ = -1;
  std::string buffer_;
};

/// Writes one file whole or not at all: beside it under another name, then renamed over it. A
/// reader sees the old content or the new, never a part. Missing parent folders are made.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view text);

/// Prints to standard output, with the same checks: a result that was piped to a full disk must not
/// look like one that arrived. A pipe whose reader has left is no error.
void WriteStandardOutput(std::string_view text);

}  // namespace kingpin::io
