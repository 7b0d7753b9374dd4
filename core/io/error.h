#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace kingpin::io {

/// One thing that is wrong with what a user gave us. Empty fields are left out of the message.
struct InputProblem {
  std::string file{};        ///< as the user named it; `command line` for an option
  int line = 0;              ///< counted from 1; 0 when a line makes no sense
  std::string key{};         ///< path of the key, e.g. `tie_rod.length`
  std::string found{};       ///< what stands there
  std::string expected{};    ///< what should stand there, with the unit
  std::string suggestion{};  ///< the next step, e.g. `did you mean 'mass'?`
};

/// `file:line: key: found ..., expected ...; suggestion`
std::string FormatProblem(const InputProblem& problem);

/// Unusable input: a file, a number, a unit, a topology, an option. The program ends with status 2.
/// A reader may collect what is wrong with a file; the text then has one line for each problem.
class InputError : public std::runtime_error {
 public:
  explicit InputError(InputProblem problem);
  explicit InputError(std::vector<InputProblem> problems);  ///< at least one
  const InputProblem& problem() const { return problems_.front(); }
  const std::vector<InputProblem>& problems() const { return problems_; }

 private:
  std::vector<InputProblem> problems_;
};

/// A run that started from usable input and failed. The program ends with status 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kingpin::io
