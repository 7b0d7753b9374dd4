#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace kingpin {

/// A function with a stack of its own that can stop in the middle and be taken up again, all on the
/// thread that calls Resume(). It turns a library that calls back (and would hold its thread until
/// it is done) into one that can be asked for its next question. Switching takes well below a
/// microsecond and no lock, because nothing ever runs at the same time.
///
/// Rules: call Yield() only inside the body; never inside a catch block (the C++ run time keeps the
/// exceptions being handled per thread, not per stack); resume on one thread only; run the body to
/// its end before the fibre is destroyed, otherwise what lives on its stack is not destroyed.
class Fibre {
 public:
  static constexpr std::size_t kDefaultStack = std::size_t{1} << 20;

  /// Makes the stack (memory is committed as it is touched, with a guard page below); runs nothing.
  /// Throws std::bad_alloc when there is no address space left.
  explicit Fibre(std::function<void()> body, std::size_t stack_bytes = kDefaultStack);
  ~Fibre();
  Fibre(const Fibre&) = delete;
  Fibre& operator=(const Fibre&) = delete;

  /// Runs the body until it yields or ends. An exception that leaves the body is thrown here, and
  /// the fibre is done. Does nothing when done.
  void Resume();

  /// Stops the body and goes back to Resume().
  void Yield();

  bool done() const;

 private:
  struct State;
  static void Enter(unsigned high, unsigned low);
  std::unique_ptr<State> state_;
};

}  // namespace kingpin
