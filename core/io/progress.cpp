#include "core/io/progress.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace kingpin::io {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kRedrawTime(100);
constexpr int kUsualWidth = 80;

int GetWidth(int descriptor) {
  winsize size{};
  if (::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 10) return size.ws_col;
  return kUsualWidth;
}

}  // namespace

Progress::Progress(bool is_shown, int descriptor)
    : is_shown_(is_shown), descriptor_(descriptor), start_(Clock::now()) {}

Progress::~Progress() { Finish(); }

void Progress::Start(std::string_view stage, std::uint64_t total) {
  if (!is_shown_) return;
  const std::lock_guard lock(mutex_);
  stage_ = stage;
  note_.clear();
  total_ = total;
  done_ = 0;
  is_running_ = true;
  start_ = Clock::now();
  Draw(true);
}

void Progress::Advance(std::uint64_t steps) {
  if (!is_shown_) return;
  const std::lock_guard lock(mutex_);
  done_ += steps;
  Draw(false);
}

void Progress::Note(std::string_view note) {
  if (!is_shown_) return;
  const std::lock_guard lock(mutex_);
  note_ = note;
  Draw(false);
}

void Progress::Finish() {
  if (!is_shown_) return;
  const std::lock_guard lock(mutex_);
  is_running_ = false;
  Erase();
}

void Progress::Print(std::string_view line) {
  if (!is_shown_) return;
  const std::lock_guard lock(mutex_);
  Erase();
  WriteOut(fmt::format("{}\n", line));
  Draw(true);
}

void Progress::Draw(bool is_forced) {
  if (!is_running_) return;
  const auto now = Clock::now();
  if (!is_forced && now - last_draw_ < kRedrawTime) return;
  last_draw_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string line = stage_;
  if (total_ > 0) {
    const std::uint64_t done = std::min(done_, total_);
    line += fmt::format(": {}/{}, {} %", done, total_, 100 * done / total_);
  } else if (done_ > 0) {
    line += fmt::format(": {}", done_);
  }
  line += ", " + FormatDuration(elapsed);
  if (total_ > done_ && done_ > 0 && elapsed > 0.5) {
    const double left = elapsed * static_cast<double>(total_ - done_) / static_cast<double>(done_);
    line += fmt::format(", about {} left", FormatDuration(left));
  }
  if (!note_.empty()) line += ", " + note_;
  const auto width = static_cast<std::size_t>(GetWidth(descriptor_) - 1);
  if (line.size() > width) line.resize(width);
  WriteOut(fmt::format("\r\x1b[K{}", line));
  is_drawn_ = true;
}

void Progress::Erase() {
  if (is_drawn_) WriteOut("\r\x1b[K");
  is_drawn_ = false;
}

void Progress::WriteOut(std::string_view text) const {
  // A terminal that has gone must not stop the work.
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor_, text.data(), text.size());
    if (count <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

bool IsProgressWanted(bool is_quiet) { return !is_quiet && ::isatty(STDERR_FILENO) == 1; }

std::string FormatDuration(double seconds) {
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = std::llround(seconds);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace kingpin::io
