#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

namespace kingpin::io {

/// One line on standard error that says what is going on and how long it will take:
///
///     step 1: 1200/4000, 30 %, 2.1 s, about 4.9 s left, best 0.8211
///
/// Only on a terminal, and not with --quiet; silent in a pipe. Every function may be called from
/// any thread; the line is redrawn at most ten times a second, and erased at the end.
class Progress {
 public:
  /// `is_shown` as IsProgressWanted() says; tests give their own descriptor.
  Progress(bool is_shown, int descriptor);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Begins a stage of `total` steps; 0 when the number is not known.
  void Start(std::string_view stage, std::uint64_t total);
  void Advance(std::uint64_t steps = 1);
  /// A short remark at the end of the line, e.g. the best value so far.
  void Note(std::string_view note);
  /// Erases the line.
  void Finish();
  /// Prints a line of its own above the progress (nothing when it is not shown).
  void Print(std::string_view line);

  bool is_shown() const { return is_shown_; }

 private:
  void Draw(bool is_forced);
  void Erase();
  void WriteOut(std::string_view text) const;

  const bool is_shown_;
  const int descriptor_;
  std::mutex mutex_;
  std::string stage_;
  std::string note_;
  std::uint64_t total_ = 0;
  std::uint64_t done_ = 0;
  bool is_drawn_ = false;
  bool is_running_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_draw_;
};

/// Whether to show progress: standard error is a terminal and the user did not ask for quiet.
bool IsProgressWanted(bool is_quiet);

/// `2.1 s`, `3 min 05 s`, `1 h 02 min`.
std::string FormatDuration(double seconds);

}  // namespace kingpin::io
