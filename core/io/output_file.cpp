#include "core/io/output_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/io/error.h"
#include "core/io/output_failure.h"

namespace kingpin::io {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 16;

}  // namespace

void FailOutput(const std::filesystem::path& path, std::string_view doing, int reason) {
  const char* why = std::strerror(reason);
  switch (reason) {
    case EIO:
    case EBADF:
    case EFAULT:
      throw RunError(fmt::format("{}: {} failed: {}", path.string(), doing, why));
    default:
      break;
  }
  std::string suggestion = "choose another place with -o";
  if (reason == ENOSPC || reason == EDQUOT) suggestion = "free some space, or " + suggestion;
  throw InputError(InputProblem{.file = path.string(),
                                .found = fmt::format("{} failed ({})", doing, why),
                                .expected = "a place that can be written to",
                                .suggestion = suggestion});
}

OutputFile::OutputFile(const std::filesystem::path& path) : OutputFile(path, path) {}

OutputFile::OutputFile(const std::filesystem::path& path, std::filesystem::path shown)
    : shown_(std::move(shown)) {
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) FailOutput(shown_, "creating the file", errno);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::Write(std::string_view text) {
  if (buffer_.size() + text.size() < kBufferSize) {
    buffer_ += text;
    return;
  }
  buffer_ += text;
  Flush();
}

void OutputFile::Flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) FailOutput(shown_, "writing", errno);
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

void OutputFile::Close() {
  Flush();
  // Some devices and file systems have no fsync; the data is as safe there as it can be.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP) {
    FailOutput(shown_, "writing", errno);
  }
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0 && errno != EINTR) FailOutput(shown_, "writing", errno);
}

void MakeDirectories(const std::filesystem::path& path) { MakeDirectories(path, path); }

void MakeDirectories(const std::filesystem::path& path, const std::filesystem::path& shown) {
  if (path.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) FailOutput(shown, "making the folder", error.value());
}

void SyncDirectory(const std::filesystem::path& path) {
  const int descriptor =
      ::open(path.empty() ? "." : path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // a folder that may be written but not read
  ::fsync(descriptor);
  ::close(descriptor);
}

void WriteStandardOutput(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) {
    return;
  }
  if (errno != EPIPE) FailOutput("standard output", "writing", errno);
}

void WriteFileAtomically(const std::filesystem::path& path, std::string_view text) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) FailOutput(path, "creating the file", EISDIR);
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    OutputFile file(path);  // a pipe or a device cannot be replaced, only written to
    file.Write(text);
    file.Close();
    return;
  }
  MakeDirectories(path.parent_path());
  const std::filesystem::path temporary =
      path.parent_path() /
      fmt::format(".{}.partial-{}", path.filename().string(), static_cast<long>(::getpid()));
  struct Remover {
    const std::filesystem::path& path;
    ~Remover() { ::unlink(path.c_str()); }
  } const remover{temporary};
  OutputFile file(temporary, path);
  file.Write(text);
  file.Close();
  if (::rename(temporary.c_str(), path.c_str()) != 0) FailOutput(path, "creating the file", errno);
  SyncDirectory(path.parent_path());
}

}  // namespace kingpin::io
